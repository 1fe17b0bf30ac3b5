// A simulated drive -> a bag as the vehicle would have recorded it, with ground truth.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <rosbag/bag.h>

#include "simulation/simulator.h"

namespace donex {

/// The earliest start_stamp of a drive in a bag [s]: a bag knows no time before 0 and tf none at 0, and odometry is
/// there before the scene begins. 2 s, unless late stamps of slow odometry ask for more.
double leastStart(const simulation::OdometryOptions& odometry);

struct SimulationBagSummary {
  std::size_t clouds = 0, odometry = 0;
  std::vector<std::string> frames;  ///< of the sensors
};

/// Topics /points (all sensors, each in a frame of its own, the only one in velodyne; with per-echo time, ring and
/// ground-truth label), /odom (odom, base_link), /tf (the odometry's motion), /tf_static (mountings). The scene must
/// have a duration, and begin at leastStart() or later. `progress` is called after each scan. Throws DataError.
SimulationBagSummary writeSimulationBag(simulation::Simulator& simulator, const std::filesystem::path& file,
                                        rosbag::CompressionType compression, const std::function<void()>& progress);

}  // namespace donex
