#include "bag/simulation_bag.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <tf2_msgs/TFMessage.h>

#include "bag/bag_file.h"
#include "simulated_lidar/simulation_messages.h"

namespace donex {
namespace {

tf2_msgs::TFMessage messageOf(std::vector<geometry_msgs::TransformStamped> transforms) {
  tf2_msgs::TFMessage message;
  message.transforms = std::move(transforms);
  return message;
}

void write(BagWriter& bag, const OdometrySample& sample, const SimulationFrames& frames) {
  const ros::Time stamp(sample.stamp);
  bag.write("/odom", stamp, toOdometry(sample, frames));
  bag.write("/tf", stamp, messageOf({toTransform(sample, frames)}));
}

}  // namespace

double leastStart(const simulation::OdometryOptions& odometry) {
  constexpr double kUsual = 2.0, kFirstStamp = 0.5;  // [s]
  return std::max(kUsual, kFirstStamp - odometry.firstStamp());
}

SimulationBagSummary writeSimulationBag(simulation::Simulator& simulator, const std::filesystem::path& file,
                                        rosbag::CompressionType compression, const std::function<void()>& progress) {
  const SimulationFrames frames;
  SimulationBagSummary summary;
  for (std::size_t i = 0; i < simulator.sensorCount(); ++i) {
    summary.frames.push_back(frames.of(simulator.sensorName(i)));
  }
  BagWriter writer(file, compression);
  simulation::SimulatedScan scan;
  while (simulator.next(scan)) {
    if (summary.clouds == 0) {
      const double start = std::min(scan.stamp, scan.odometry.front().stamp);
      writer.write("/tf_static", ros::Time(start), messageOf(mountingsOf(simulator, start, frames)),
                   latchedTransforms());
    }
    for (const OdometrySample& sample : scan.odometry) write(writer, sample, frames);
    writer.write("/points", ros::Time(scan.sent), *toCloud(scan, frames));
    summary.odometry += scan.odometry.size();
    ++summary.clouds;
    progress();
  }
  writer.commit();
  return summary;
}

}  // namespace donex
