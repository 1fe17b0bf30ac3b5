// Everything that is said of a labelled scan, the labels first.
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "ros/markers.h"
#include "ros/pipeline.h"

namespace donex {

/// The node's topics. But for the labelled cloud nothing is made that nobody subscribed to.
class ScanPublisher {
 public:
  /// Advertises private names.
  explicit ScanPublisher(ros::NodeHandle pnh);

  /// On the way from cloud to labels: to be called before anything else is made of the scan.
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
