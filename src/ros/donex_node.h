// The classifier as a ROS node; nodelet and executable wrap this class.
#pragma once

#include <memory>

#include <ros/node_handle.h>

namespace donex {

/// Topics and services as documented in README.md, parameters in docs/parameters.md. All callbacks run on nh's
/// queue, which must be served by one thread at a time.
class DonexNode {
 public:
  /// Subscribes relative names with `nh`, publishes and reads parameters with `pnh`; both share one queue.
  /// Throws std::invalid_argument with every fault of the parameters. Does not wait for anything.
  DonexNode(const ros::NodeHandle& nh, const ros::NodeHandle& pnh);
  ~DonexNode();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace donex
