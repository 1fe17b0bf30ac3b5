// From connected echoes to things that may move (algorithm section 5, step 6).
#pragma once

#include <vector>

#include "donex/core/clusters.h"
#include "donex/core/config.h"
#include "donex/core/judged_scan.h"

namespace donex {

/// A thing of the present scan and what its echoes say.
struct Candidate {
  std::vector<std::uint32_t> echoes;  ///< indices into the scan
  int new_echoes = 0;
  int settled_echoes = 0;
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();  ///< odometry frame [m]
  bool dynamic = false;  ///< the verdict

  Eigen::Vector3d center() const { return 0.5 * (low + high); }
  Eigen::Vector3d extent() const { return high - low; }
};

/// Longer than any vehicle: a wall, a hedge, or things that touch.
bool isTooLong(const Candidate& candidate);

/// Enough of the candidate is new, by number and against what is settled.
bool isNew(const Candidate& candidate, const ObjectConfig& config);

class CandidateFinder {
 public:
  /// A square of `reach` [m] around the sensor.
  CandidateFinder(double reach, const ObjectConfig& config);

  /// The scan's clusters. One that is new only in part (a pedestrian at a wall) is replaced by its parts
  /// that are not settled.
  void find(const JudgedScan& scan, std::vector<Candidate>& candidates);

  /// Takes from the dynamic candidates what only stands so close to a moving thing that both are one
  /// cluster: seen with a finer eye, a part without a new echo goes where it is settled, or larger than
  /// every part that is new.
  void release(const JudgedScan& scan, std::vector<Candidate>& candidates);

  std::size_t memoryBytes() const;

 private:
  struct Part {
    std::size_t echoes = 0, settled = 0;
    bool is_new = false;
  };

  void append(const JudgedScan& scan, std::vector<Candidate>& candidates) const;
  bool isReleasable(const Candidate& candidate) const { return candidate.dynamic && candidate.new_echoes > 0; }
  void countParts(const JudgedScan& scan, const std::vector<Candidate>& candidates);
  void releaseFrom(Candidate& candidate) const;

  ObjectConfig config_;
  Clusters clusters_, fine_clusters_;
  std::vector<Standing> standing_;
  std::vector<Part> parts_;  ///< by fine cluster
};

}  // namespace donex
