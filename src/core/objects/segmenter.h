// From connected echoes to segments that may be objects (algorithm: "Objects").
#pragma once

#include <vector>

#include "core/objects/clusters.h"
#include "core/objects/segment_rules.h"

namespace donex {

struct SegmenterOptions {
  double cut_rim = 0.3;         ///< by which a predicted object may exceed what it is cut out of [m]
  double tight_cut_rim = 0.1;   ///< around the predicted object: what lies in it is cut out with it [m]
  std::size_t least_part = 10;  ///< a part of fewer echoes is not worth cutting
  double least_settled = 0.25;  ///< settled by unsettled echoes: less hides no object
};

class Segmenter {
 public:
  /// A square of `reach` [m] around the sensor.
  Segmenter(double reach, const ObjectConfig& config, const SegmenterOptions& options = {});

  /// Finds the scan's clusters. What their places say is not asked yet; segment() follows.
  void connect(const JudgedScan& scan) {
    clusters_.connect(scan.sensor, scan.points, scan.heights, scan.roles, {scan.own(), scan.far, scan.together},
                      scan.beams_apart);
  }

  /// The scan's clusters, one object each as far as can be told:
  ///  - what is predicted and has run into something larger is cut out of it;
  ///  - a cluster that is new only in part (a pedestrian at a wall) is replaced by its parts that are not settled. A
  ///    long one stays as well, as mixed: it may be one thing that creeps.
  void segment(const JudgedScan& scan, const Predictions& predictions, Segments& segments,
               const Workers& workers = Workers::alone());

  std::size_t memoryBytes() const;
  /// What memoryBytes will be, for scans of so many echoes [bytes], about.
  static double bytesFor(double reach, const ObjectConfig& config, double echoes);

 private:
  void append(const JudgedScan& scan, Segments& segments, const Workers& workers);
  void cutOut(const JudgedScan& scan, const Prediction& object, std::size_t whole, Segments& segments) const;
  bool isMixed(const Segment& segment, const Predictions& predictions) const;
  bool mayBeOne(const Segment& mixed) const { return rules_.isLong(mixed.extent()) && !rules_.isTooLong(mixed); }

  ObjectConfig config_;
  SegmenterOptions options_;
  SegmentRules rules_;
  Clusters clusters_;
  std::vector<ClusterRole> roles_;
  std::vector<std::size_t> segment_of_;  ///< by cluster: its number
};

}  // namespace donex
