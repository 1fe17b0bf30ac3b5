// Clouds that somebody has moved into the vehicle's frame do not say where their sensor is.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <sensor_msgs/PointCloud2.h>

#include "ros/cloud_layout.h"

namespace donex {

/// Whether the echoes lie as they do around the vehicle's own origin on the ground, where no sensor can be: somebody
/// has moved the cloud into the vehicle's frame, and lines of sight would begin in the wrong place.
bool liesOnTheGround(const std::vector<Eigen::Vector3f>& echoes);

/// Finds the sensor where the clouds have rings (RingApex), else sees whether it cannot be at the origin.
class OriginWatch {
 public:
  /// Of a cloud that is told in the vehicle's frame, while the configuration does not say where the sensor is: what is
  /// strange, once; else empty. `echoes` are the cloud's, as they came. Follows the frame of the first such cloud
  /// alone.
  std::string follow(const sensor_msgs::PointCloud2& cloud, const CloudLayout& layout,
                     const std::vector<Eigen::Vector3f>& echoes);

  /// Where the sensor was found in the clouds of a frame [m]; zero where it was not.
  Eigen::Vector3d foundIn(const std::string& frame) const {
    return frame == frame_ ? found_ : Eigen::Vector3d(Eigen::Vector3d::Zero());
  }

 private:
  static constexpr int kCertain = 5;         // clouds in a row whose ground lies there
  static constexpr int kAgreeing = 3;        // ... whose rings meet in one place
  static constexpr double kSame = 0.1;       // between two clouds [m]
  static constexpr double kOwnOrigin = 0.3;  // sensors whose beams do not meet in one point, but nearly [m]

  std::string followApex(const Eigen::Vector3d& apex, const sensor_msgs::PointCloud2& cloud);

  std::string frame_;
  bool is_settled_ = false;
  int on_the_ground_ = 0;  // clouds in a row
  int agreeing_ = 0;       // clouds in a row
  Eigen::Vector3d apex_ = Eigen::Vector3d::Zero(), found_ = Eigen::Vector3d::Zero();
  std::vector<std::uint32_t> rings_;  // kept for its memory
};

}  // namespace donex
