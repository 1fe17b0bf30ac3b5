// donex/DonexNodelet.
#include <pluginlib/class_list_macros.hpp>

#include "nodelets/nodelet_of.h"
#include "ros/donex_node.h"

namespace donex {

using DonexNodelet = NodeletOf<DonexNode>;

}  // namespace donex

PLUGINLIB_EXPORT_CLASS(donex::DonexNodelet, nodelet::Nodelet)
