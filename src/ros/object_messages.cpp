#include "ros/object_messages.h"

#include <boost/make_shared.hpp>
#include <tf2_eigen/tf2_eigen.h>

namespace donex {
namespace {

geometry_msgs::Vector3 vectorOf(const Eigen::Vector3d& vector) {
  geometry_msgs::Vector3 message;
  tf2::toMsg(vector, message);
  return message;
}

MovingObject messageOf(const Object& object, const Eigen::Isometry3d& odom_from_world) {
  MovingObject message;
  message.id = object.id;
  message.dynamic = object.dynamic;
  message.pose = tf2::toMsg(Eigen::Isometry3d(odom_from_world * object.odom_from_box));
  message.size = vectorOf(object.size);
  message.velocity = vectorOf(odom_from_world.linear() * object.velocity);
  message.age.fromSec(object.age);
  message.echoes = object.echoes;
  message.proof = nameOf(object.proof);
  return message;
}

}  // namespace

MovingObjectsPtr toMessage(const Detector& detector, const ros::Time& stamp, const std::string& odom_frame,
                           const Eigen::Isometry3d& odom_from_world) {
  auto message = boost::make_shared<MovingObjects>();
  message->header.stamp = stamp;
  message->header.frame_id = odom_frame;
  for (const Object& object : detector.objects()) {
    message->objects.push_back(messageOf(object, odom_from_world));
  }
  return message;
}

}  // namespace donex
