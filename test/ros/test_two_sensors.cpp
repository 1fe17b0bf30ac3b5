// Sensors on one topic are labelled as well as each on a topic of its own: the halves of a real sensor's turn where
// DONEX_SHARED_DATA names a folder of sequences, and the rigs of a simulated vehicle (seed 1, or DONEX_SEED).
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>

#include <gtest/gtest.h>

#include "evaluation/evaluation.h"
#include "io/sequence.h"
#include "ros/pipeline_rig.h"
#include "simulated_lidar/simulation_messages.h"

namespace donex {
namespace {

using simulation::SimulatedEcho;
using simulation::SimulatedScan;

constexpr double kFarthestOff = 0.01;  // IoU below that of the sensor alone

struct Sensor {
  std::string frame;
  Eigen::Isometry3d base_from_sensor = Eigen::Isometry3d::Identity();
  std::function<bool(const Eigen::Vector3f&)> sees = [](const Eigen::Vector3f&) { return true; };

  SimulationFrames frames() const { return {"odom", "base_link", frame}; }
};
using Sensors = std::vector<Sensor>;
using Scores = std::map<std::string, Evaluation>;  // by frame

bool isLeft(const Eigen::Vector3f& place) { return place.y() >= 0.0F; }
bool isRight(const Eigen::Vector3f& place) { return !isLeft(place); }

/// What one topic with these sensors on it is labelled as. Their clocks are synchronised.
class Topic {
 public:
  explicit Topic(const Sensors& sensors) : pipeline_({}, tf_, events()) {
    for (const Sensor& sensor : sensors) {
      tf_.setTransform(mountingOf(sensor.base_from_sensor, 1.0, sensor.frames()), "test", true);
    }
  }

  void move(double stamp, const Eigen::Isometry3d& odom_from_base) {
    OdometrySample sample;
    sample.stamp = stamp;
    sample.odom_from_base = odom_from_base;
    pipeline_.addOdometry(*toOdometry(sample, {}));
  }
  /// What the sensor sees of it.
  void send(const Sensor& sensor, const SimulatedScan& all) {
    SimulatedScan scan = all;
    scan.echoes.clear();
    scan.labels.clear();
    for (std::size_t i = 0; i < all.echoes.size(); ++i) {
      if (!sensor.sees(all.echoes[i].position)) continue;
      scan.echoes.push_back(all.echoes[i]);
      scan.labels.push_back(all.labels[i]);
    }
    truth_[sensor.frame].push_back(scan.labels);
    pipeline_.addCloud(toCloud(scan, sensor.frames()), scan.stamp);
    while (pipeline_.step(scan.stamp)) {
    }
  }

  const Scores& scores() const { return scores_; }

 private:
  PipelineEvents events() {
    PipelineEvents events;
    events.labeled = [this](const LabeledScan& scan) { judge(scan); };
    events.dropped = [](DropReason, const std::string& text) { ADD_FAILURE() << text; };
    events.refused = [](OdometryRefusal, const std::string& text) { ADD_FAILURE() << text; };
    events.forgotten = events.strange_times = [](const std::string& text) { ADD_FAILURE() << text; };
    return events;
  }
  void judge(const LabeledScan& scan) {
    const std::string& frame = scan.cloud->header.frame_id;
    scores_[frame].add(judged_[frame]++, scan.scan.echoes, truth_[frame].front(), asSemanticKitti(scan.labels));
    truth_[frame].pop_front();
  }

  tf2::BufferCore tf_;
  std::map<std::string, std::deque<std::vector<std::uint32_t>>> truth_;  // of the clouds that wait
  std::map<std::string, std::size_t> judged_;
  Scores scores_;
  Pipeline pipeline_;
};

using Drive = std::function<Scores(const Sensors&)>;

void expectAsGoodAsAlone(const Drive& drive, const Sensors& sensors) {
  const Scores together = drive(sensors);
  ASSERT_EQ(together.size(), sensors.size());
  for (const Sensor& sensor : sensors) {
    const Evaluation alone = drive({sensor}).at(sensor.frame);
    const Evaluation& one = together.at(sensor.frame);
    EXPECT_GT(alone.total().moving(), 500U) << "echoes to be right about";
    std::printf("%s: IoU / precision, phantoms per scan: alone %.3f / %.3f, %.2f; together %.3f / %.3f, %.2f\n",
                sensor.frame.c_str(), alone.total().iou(), alone.total().precision(), alone.phantomsPerScan(),
                one.total().iou(), one.total().precision(), one.phantomsPerScan());
    EXPECT_GT(one.total().iou(), alone.total().iou() - kFarthestOff) << sensor.frame;
  }
}

Scores realDrive(const std::string& directory, const Sensors& sensors) {
  const SequenceReader reader(directory);
  Topic topic(sensors);
  for (std::size_t i = 0; i < reader.size(); ++i) {
    const SequenceScan read = reader.scan(i);
    SimulatedScan scan;
    scan.stamp = read.stamp + 1.0;  // ros::Time has no time before 0
    for (const Eigen::Vector3f& position : read.echoes) {
      SimulatedEcho echo{};
      echo.position = position;
      scan.echoes.push_back(echo);
    }
    scan.labels = reader.labels(i);
    topic.move(scan.stamp, read.odom_from_sensor.isometry());
    for (const Sensor& sensor : sensors) topic.send(sensor, scan);
  }
  return topic.scores();
}

/// The drive's labels end where its camera's view does: behind, nothing is known to move.
TEST(TwoSensors, LeftAndRightHalfOfARealDrive) {
  const char* folder = std::getenv("DONEX_SHARED_DATA");
  const std::string drive = folder == nullptr ? "" : std::string(folder) + "/kitti_0005";
  if (!std::filesystem::is_directory(drive)) GTEST_SKIP() << "no DONEX_SHARED_DATA with kitti_0005";
  const Eigen::Isometry3d mounting = Eigen::Isometry3d::Identity();
  expectAsGoodAsAlone([&](const Sensors& sensors) { return realDrive(drive, sensors); },
                      {{"left", mounting, isLeft}, {"right", mounting, isRight}});
}

/// What the sensors of a rig measure in a stretch of the street.
struct Street {
  Sensors sensors;
  std::vector<SimulatedScan> scans;
};

Street simulatedStreet(const std::string& rig, double begin) {
  constexpr double kStretch = 4.0;  // [s]
  simulation::SimulatorOptions options;
  options.rig = rig;
  options.beams = 32;
  if (const char* seed = std::getenv("DONEX_SEED")) options.seed = static_cast<decltype(options.seed)>(std::atoi(seed));
  options.duration = begin + kStretch;
  options.start_stamp = 10.0;  // ros::Time has no time before 0
  simulation::Simulator simulator("street", options);
  Street street;
  for (std::size_t i = 0; i < simulator.sensorCount(); ++i) {
    street.sensors.push_back({simulator.sensorName(i), simulator.baseFromSensor(i)});
  }
  SimulatedScan scan;
  while (simulator.next(scan)) {
    if (scan.stamp > options.start_stamp + begin) street.scans.push_back(scan);
  }
  return street;
}

Scores label(const std::vector<SimulatedScan>& scans, const Sensors& sensors) {
  Topic topic(sensors);
  for (const SimulatedScan& scan : scans) {
    const bool is_first_of_moment = scan.sensor == scans.front().sensor;
    if (is_first_of_moment) topic.move(scan.stamp, scan.odom_from_base);
    for (const Sensor& sensor : sensors) {
      if (sensor.frame == scan.sensor) topic.send(sensor, scan);
    }
  }
  return topic.scores();
}

void expectAsGoodAsAloneInAStreet(const std::string& rig, double begin) {
  const Street street = simulatedStreet(rig, begin);
  std::printf("%s, from %g s on\n", rig.c_str(), begin);
  expectAsGoodAsAlone([&](const Sensors& those) { return label(street.scans, those); }, street.sensors);
}

constexpr double kEarly = 0.0, kLate = 10.0;  // [s] of the scene

TEST(TwoSensors, FrontAndRear) {
  expectAsGoodAsAloneInAStreet("front_rear", kEarly);
  expectAsGoodAsAloneInAStreet("front_rear", kLate);
}

TEST(TwoSensors, RoofAndBumper) {
  expectAsGoodAsAloneInAStreet("roof_bumper", kEarly);
  expectAsGoodAsAloneInAStreet("roof_bumper", kLate);
}

TEST(TwoSensors, RoofAndBothBumpers) {
  expectAsGoodAsAloneInAStreet("roof_front_rear", kEarly);
  expectAsGoodAsAloneInAStreet("roof_front_rear", kLate);
}

}  // namespace
}  // namespace donex
