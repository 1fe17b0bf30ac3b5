// The classifier as a plain node.
#include "ros/donex_node.h"

#include <ros/ros.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "donex");
  const ros::NodeHandle keep_alive;  // without one, ROS shuts down before the error below is logged
  try {
    const donex::DonexNode node(ros::NodeHandle(), ros::NodeHandle("~"));
    ros::spin();
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
  return 0;
}
