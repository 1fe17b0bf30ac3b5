// donex/OctomapNodelet.
#include <pluginlib/class_list_macros.hpp>

#include "nodelets/nodelet_of.h"
#include "ros/octomap_node.h"

namespace donex {

using OctomapNodelet = NodeletOf<OctomapNode>;

}  // namespace donex

PLUGINLIB_EXPORT_CLASS(donex::OctomapNodelet, nodelet::Nodelet)
