// A bag in, the same bag with labelled clouds out.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "donex/config.h"
#include "evaluation/evaluation.h"
#include "io/data_error.h"
#include "ros/pipeline.h"

namespace donex {

struct LabelBagOptions {
  std::string points;  ///< topic of the clouds; empty: the only one of its type
  std::string odom;    ///< topic of the odometry; empty: the only one of its type
  std::string labeled = "/donex/labeled_points";
  bool calibrate = false;  ///< also tell what the clouds say of mounting, scale and stamps of the odometry
  Config config;
};

struct LabelBagSummary {
  std::string points, odom;  ///< the topics in use; no odom where the configuration needs none
  std::string motion;        ///< where the ego motion comes from, and why
  std::string sensor;        ///< as its first scans show it; empty where nothing did
  std::size_t messages = 0;  ///< of the input
  std::size_t echoes = 0;
  PipelineCounts counts;
  double duration = 0.0;                 ///< from the first to the last message of the input [s]
  std::vector<double> times;             ///< parsing and judging, a labelled cloud [s]
  Evaluation evaluation;                 ///< where the clouds carry their truth, as simulated ones do
  std::string check;                     ///< odometry against the scans, one line; empty where that is not asked
  std::vector<std::string> calibration;  ///< lines, where that was asked
  std::vector<std::string> remarks;      ///< why data were dropped, refused or forgotten: the first of each kind
};

/// `progress` is called with the number of messages done and of all.
using LabelBagProgress = std::function<void(std::size_t done, std::size_t total)>;

/// Bags that follow one another in time: the parts of one recording, most often only one.
using BagParts = std::vector<std::filesystem::path>;

/// Called for every labelled cloud: the time of the message that completed it, and the part that holds this message.
/// What it throws is handed on as it is.
using LabelBagSink = std::function<void(const LabeledScan& scan, const ros::Time& now, std::size_t part)>;

/// Labels the clouds as the live node would, which sees the parts of a recording as one: its memory and /tf_static go
/// on from part to part. Methods that need whole drives read it several times. What the node would drop is dropped.
/// Memory does not grow with the bags (but for such a method's own). `options.labeled` is not used.
/// Throws DataError: a bag is not sound, a part does not follow the one before, there are not the topics (the message
/// lists those there are), or not one cloud could be labelled. Throws std::invalid_argument with every fault of the
/// configuration.
LabelBagSummary judgeBag(const BagParts& in, const LabelBagOptions& options, const LabelBagSink& sink,
                         const LabelBagProgress& progress);

/// Copies every part byte for byte (so order, times, connection headers and compression are kept) to its `out`, and
/// adds the labelled clouds at the time of the message that completed them, as a recording of the live node would:
/// judgeBag, which tells what is thrown. Each output appears whole or not at all.
LabelBagSummary labelBag(const BagParts& in, const BagParts& out, const LabelBagOptions& options,
                         const LabelBagProgress& progress);

}  // namespace donex
