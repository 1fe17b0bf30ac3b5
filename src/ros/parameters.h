// The private parameters of a node, read strictly; and dynamic_reconfigure's messages as configurations.
#pragma once

#include <string>
#include <vector>

#include <XmlRpcValue.h>
#include <dynamic_reconfigure/Config.h>
#include <ros/node_handle.h>

#include "donex/config.h"

namespace donex {

/// Sets what `values` (a map of names to values) holds. Returns every fault, one sentence each: unknown names,
/// wrong types, values that are not in the enumeration, and faultsOf the outcome.
std::vector<std::string> applyParameters(const XmlRpc::XmlRpcValue& values, Config& config);

/// The configuration of a node from its private namespace over the defaults.
/// Throws std::invalid_argument with every fault at once.
Config readParameters(const ros::NodeHandle& pnh);

/// The reconfigurable parameters as dynamic_reconfigure carries them.
dynamic_reconfigure::Config toMessage(const Config& config);

/// Sets what the message holds. Returns every fault, as applyParameters does.
std::vector<std::string> applyMessage(const dynamic_reconfigure::Config& message, Config& config);

/// Whether two configurations need the same grid: they differ in the node's switches at most.
bool sameDetection(const Config& a, const Config& b);

/// "a", "b" -> "a; b".
std::string joined(const std::vector<std::string>& faults);

}  // namespace donex
