// donex/SimulatedLidarNodelet.
#include <pluginlib/class_list_macros.hpp>

#include "nodelets/nodelet_of.h"
#include "simulated_lidar/simulated_lidar.h"

namespace donex {

using SimulatedLidarNodelet = NodeletOf<SimulatedLidar>;

}  // namespace donex

PLUGINLIB_EXPORT_CLASS(donex::SimulatedLidarNodelet, nodelet::Nodelet)
