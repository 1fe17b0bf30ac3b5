// From connected echoes to segments that may be objects (algorithm: "Objects").
#pragma once

#include <vector>

#include "core/objects/clusters.h"
#include "core/objects/segment.h"

namespace donex {

class Segmenter {
 public:
  /// A square of `reach` [m] around the sensor.
  Segmenter(double reach, const ObjectConfig& config);

  /// The scan's clusters, one object each as far as can be told:
  ///  - what is predicted and has run into something larger is cut out of it;
  ///  - a cluster that is new only in part (a pedestrian at a wall) is replaced by its parts that are not settled.
  void segment(const JudgedScan& scan, const Predictions& predictions, Segments& segments);

  std::size_t memoryBytes() const;
  /// What memoryBytes will be, for scans of so many echoes [bytes], about.
  static double bytesFor(double reach, const ObjectConfig& config, double echoes);

 private:
  void append(const JudgedScan& scan, Segments& segments);
  static void cutOut(const JudgedScan& scan, const Prediction& object, std::size_t whole, Segments& segments);
  bool isMixed(const Segment& segment, const Predictions& predictions) const;

  ObjectConfig config_;
  Clusters clusters_;
  std::vector<ClusterRole> roles_;
  std::vector<std::size_t> segment_of_;  ///< by cluster: its number
};

}  // namespace donex
