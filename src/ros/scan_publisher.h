// Everything that is published of a labelled scan, the labels first.
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "ros/markers.h"
#include "ros/pipeline.h"

namespace donex {

/// The node's topics. All but the labelled cloud is made only for subscribers.
class ScanPublisher {
 public:
  /// Advertises private names.
  explicit ScanPublisher(ros::NodeHandle pnh);

  /// The labelled cloud: to be called before all other outputs of the scan.
  void publishLabels(const LabeledScan& scan) const;
  void publishTheRest(const LabeledScan& scan, const Config& config);

  /// Nothing stale stays on screen.
  void clearMarkers();

  bool somebodyWatchesCells() const;

 private:
  void publishCells(const LabeledScan& scan) const;

  MarkerMaker maker_;
  ros::Publisher labeled_, dynamic_, static_, objects_, markers_;
  ros::Publisher explained_, shadowed_, seen_through_;  // for the eye
};

}  // namespace donex
