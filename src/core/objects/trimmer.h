// Which echoes of a moving segment move with it (algorithm: "Objects").
#pragma once

#include <vector>

#include "core/objects/clusters.h"
#include "core/objects/segment.h"

namespace donex {

struct TrimmerOptions {
  double finer_cells = 0.5;  ///< against the segmenter's cells: what these still connect is close
};

/// Takes from the moving segments what only stands so close to a moving object that both are one cluster. Seen with
/// cells of half the edge, a part without a new echo goes where it is settled, or larger than every part that is new
/// (unless the whole was seen to move).
class Trimmer {
 public:
  /// A square of `reach` [m] around the sensor.
  Trimmer(double reach, const ObjectConfig& config, const TrimmerOptions& options = {});

  /// Writes the proof of every echo that moves with its segment, and kNone for all others; one entry per echo.
  void trim(const JudgedScan& scan, const Segments& segments, const Verdicts& verdicts, std::vector<Proof>& proofs,
            const Workers& workers = Workers::alone());

  std::size_t memoryBytes() const;
  /// What memoryBytes will be, for scans of so many echoes [bytes], about.
  static double bytesFor(double reach, const ObjectConfig& config, double echoes, const TrimmerOptions& options = {});

 private:
  struct Part {
    std::size_t echoes = 0, settled = 0;
    bool is_new = false;
  };

  static bool isTrimmed(const Segment& segment, const Verdict& verdict) {
    return verdict.moves() && segment.new_echoes > 0;
  }
  bool findParts(const JudgedScan& scan, const Segments& segments, const Verdicts& verdicts, const Workers& workers);
  void count(const JudgedScan& scan, const Segment& segment);
  const Part* partOf(std::uint32_t echo) const;
  std::size_t largestNewPart(const Segment& segment) const;

  Clusters clusters_;
  std::vector<ClusterRole> roles_;
  std::vector<Part> parts_;  ///< by cluster
};

}  // namespace donex
