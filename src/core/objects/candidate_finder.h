// From connected echoes to segments that may move (algorithm: "Segments", "Trimming").
#pragma once

#include <vector>

#include "core/objects/candidate.h"
#include "core/objects/clusters.h"

namespace donex {

class CandidateFinder {
 public:
  /// A square of `reach` [m] around the sensor.
  CandidateFinder(double reach, const ObjectConfig& config);

  /// The scan's clusters, one thing each as far as can be told:
  ///  - what is `expected` and has run into something larger is cut out of it;
  ///  - a cluster that is new only in part (a pedestrian at a wall) is replaced by its parts that are not settled.
  void find(const JudgedScan& scan, const std::vector<Expected>& expected, Candidates& candidates);

  /// Takes from the dynamic candidates what only stands so close to a moving thing that both are one
  /// cluster: seen with a finer eye, a part without a new echo goes where it is settled, or larger than
  /// every part that is new (unless the whole was seen to move).
  void release(const JudgedScan& scan, Candidates& candidates);

  std::size_t memoryBytes() const;
  /// What memoryBytes will be, for scans of so many echoes [bytes], about.
  static double bytesFor(double reach, const ObjectConfig& config, double echoes);

 private:
  struct Part {
    std::size_t echoes = 0, settled = 0;
    bool is_new = false;
  };

  void append(const JudgedScan& scan, Candidates& candidates);
  static void cutOut(const JudgedScan& scan, const Expected& thing, std::size_t whole, Candidates& candidates);
  bool isMixed(const Candidate& candidate, const std::vector<Expected>& expected) const;
  bool isReleasable(const Candidate& candidate) const { return candidate.dynamic && candidate.new_echoes > 0; }
  void countParts(const JudgedScan& scan, const Candidates& candidates);
  void releaseFrom(Candidate& candidate) const;

  ObjectConfig config_;
  Clusters clusters_, fine_clusters_;
  std::vector<Standing> standing_;
  std::vector<Part> parts_;                ///< by fine cluster
  std::vector<std::size_t> candidate_of_;  ///< by cluster: its number
};

}  // namespace donex
