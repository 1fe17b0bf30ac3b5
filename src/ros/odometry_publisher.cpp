#include "ros/odometry_publisher.h"

#include <tf2_eigen/tf2_eigen.h>

namespace donex {
namespace {

constexpr std::uint32_t kQueue = 50;  // messages that wait for a slow listener
constexpr double kFound = 1e-4;       // [m^2, rad^2] of a pose that is determined: 1 cm, 0.6 degrees
constexpr double kOpen = 1.0;         // of one that is not, altogether

}  // namespace

nav_msgs::Odometry toOdometry(const LabeledScan& scan) {
  nav_msgs::Odometry odometry;
  odometry.header.stamp = scan.cloud->header.stamp;
  odometry.header.frame_id = scan.odom_frame;
  odometry.child_frame_id = scan.motion.base_frame;
  odometry.pose.pose = tf2::toMsg(scan.scan.odom_from_base);
  const bool is_open = scan.motion.tracked && scan.motion.tracked->status == TrackingStatus::kDegenerate;
  for (std::size_t i = 0; i < 6; ++i) odometry.pose.covariance[7 * i] = is_open ? kOpen : kFound;
  const Twist& twist = scan.motion.twist;
  odometry.twist.twist.linear.x = twist.linear.x();
  odometry.twist.twist.linear.y = twist.linear.y();
  odometry.twist.twist.linear.z = twist.linear.z();
  odometry.twist.twist.angular.x = twist.angular.x();
  odometry.twist.twist.angular.y = twist.angular.y();
  odometry.twist.twist.angular.z = twist.angular.z();
  return odometry;
}

OdometryPublisher::OdometryPublisher(ros::NodeHandle pnh, const MotionConfig& config) {
  const bool may_find = config.source == OdometrySource::kLidar || config.source == OdometrySource::kAuto;
  if (!may_find) return;
  odometry_ = pnh.advertise<nav_msgs::Odometry>("odometry", kQueue);
  if (config.publish_tf) tf_ = std::make_unique<tf2_ros::TransformBroadcaster>();
}

void OdometryPublisher::publish(const LabeledScan& scan) {
  if (!odometry_ || !scan.motion.tracked) return;
  const nav_msgs::Odometry odometry = toOdometry(scan);
  odometry_.publish(odometry);
  if (tf_ == nullptr) return;
  geometry_msgs::TransformStamped transform = tf2::eigenToTransform(scan.scan.odom_from_base);
  transform.header = odometry.header;
  transform.child_frame_id = odometry.child_frame_id;
  tf_->sendTransform(transform);
}

}  // namespace donex
