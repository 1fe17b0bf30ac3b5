// The simulated LiDAR as a plain node.
#include <ros/ros.h>

#include "simulated_lidar/simulated_lidar.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "simulated_lidar");
  const ros::NodeHandle keep_alive;  // without one, ROS shuts down before the error below is logged
  try {
    const donex::SimulatedLidar lidar(ros::NodeHandle(), ros::NodeHandle("~"));
    ros::spin();
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
  return 0;
}
