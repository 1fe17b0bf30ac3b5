// A bag in, the same bag with labelled clouds out.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "donex/core/config.h"
#include "donex/io/data_error.h"
#include "donex/ros/pipeline.h"

namespace donex {

struct LabelBagOptions {
  std::string points;  ///< topic of the clouds; empty: the only one of its type
  std::string odom;    ///< topic of the odometry; empty: the only one of its type
  std::string labeled = "/donex/labeled_points";
  Config config;
};

struct LabelBagSummary {
  std::string points, odom;  ///< the topics in use; no odom where the configuration needs none
  std::size_t messages = 0;  ///< of the input
  std::size_t echoes = 0;
  PipelineCounts counts;
  std::vector<double> times;         ///< parsing and judging, a labelled cloud [s]
  std::vector<std::string> remarks;  ///< why something was dropped, refused or forgotten: each kind's first
};

/// `progress` hears how many of how many messages are done.
using LabelBagProgress = std::function<void(std::size_t done, std::size_t total)>;

/// Copies `in` byte for byte (so order, times, connection headers and compression are kept) to `out`, and adds the
/// labelled clouds at the time of the message that completed them, as a recording of the live node would. What the node
/// would drop is dropped here. Memory does not grow with the bag. `out` appears whole or not at all.
/// Throws DataError: `in` is no sound bag, has not the topics (the message lists those it has), or not one cloud
/// could be labelled. Throws std::invalid_argument with every fault of the configuration.
LabelBagSummary labelBag(const std::filesystem::path& in, const std::filesystem::path& out,
                         const LabelBagOptions& options, const LabelBagProgress& progress);

}  // namespace donex
