// The check of odometry behind the pipeline, and on a thread of its own.
#include <condition_variable>
#include <mutex>

#include <gtest/gtest.h>

#include "core/motion/surfaces.h"
#include "ros/odometry_monitor.h"
#include "ros/pipeline_rig.h"

namespace donex {
namespace {

using test::smallConfig;

constexpr double kSpeed = 5.0;  // [m/s]
constexpr double kStart = 100.0;
constexpr int kScans = 24;

/// A drive through a courtyard with odometry of this speed; each labelled scan goes to `take`.
void drive(double told_speed, const std::function<void(const LabeledScan&)>& take) {
  PipelineEvents events;
  events.labeled = take;
  events.dropped = [](DropReason, const std::string& text) { ADD_FAILURE() << text; };
  events.refused = [](OdometryRefusal, const std::string& text) { ADD_FAILURE() << text; };
  events.forgotten = events.strange_times = [](const std::string& text) { ADD_FAILURE() << text; };
  tf2::BufferCore tf;
  tf.setTransform(test::transformAt(0.0, "base_link", "lidar", 0.0, 1.7), "test", true);
  Pipeline pipeline(smallConfig(), tf, events);
  for (int i = 0; i < kScans; ++i) {
    const double stamp = kStart + 0.1 * i;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation().x() = kSpeed * (stamp - kStart);
    pipeline.addOdometry(test::odometryAt(stamp, told_speed));
    pipeline.addCloud(test::plainCloud(testing::seenFrom(pose, testing::courtyard()), stamp), stamp);
    pipeline.step(stamp);
  }
  pipeline.finish();
}

TEST(OdometryMonitor, SaysThatSoundOdometryAgrees) {
  LabeledScanCheck check{MotionConfig()};
  drive(kSpeed, [&](const LabeledScan& scan) { check.check(LabeledScanCheck::questionOf(scan)); });
  EXPECT_EQ(check.finding().scans, static_cast<std::size_t>(kScans));
  EXPECT_EQ(check.finding().agreement, Agreement::kAgrees);
}

TEST(OdometryMonitor, NamesWhatIsWrong) {
  LabeledScanCheck check{MotionConfig()};
  drive(1.1 * kSpeed, [&](const LabeledScan& scan) { check.check(LabeledScanCheck::questionOf(scan)); });
  EXPECT_EQ(check.finding().agreement, Agreement::kDisagrees);
  EXPECT_EQ(check.finding().cause.cause, OdometryCause::kScale);
  EXPECT_NEAR(check.finding().cause.figure, 1.1, 0.002);
}

TEST(OdometryMonitor, ChecksOneSensorOfSeveralUntilItIsGone) {
  OneSensor sensor;
  for (int i = 0; i < 200; ++i) {
    EXPECT_TRUE(sensor.isIt("front"));
    EXPECT_FALSE(sensor.isIt("rear"));
    EXPECT_FALSE(sensor.isIt("left"));
  }
  int others = 0;
  while (!sensor.isIt("rear")) ++others;
  EXPECT_EQ(others, 98) << "a hundred, with the two that came before";
  EXPECT_FALSE(sensor.isIt("front"));
}

TEST(OdometryMonitor, DoesTheSameOnAThreadOfItsOwn) {
  std::mutex mutex;
  std::condition_variable told;
  OdometryFinding newest;
  OdometryMonitor monitor(MotionConfig(), [&](const OdometryFinding& finding) {
    const std::lock_guard<std::mutex> lock(mutex);
    newest = finding;
    told.notify_one();
  });
  std::size_t scans = 0;
  drive(1.1 * kSpeed, [&](const LabeledScan& scan) {
    monitor.add(scan);
    std::unique_lock<std::mutex> lock(mutex);
    ++scans;
    told.wait(lock, [&] { return newest.scans == scans; });
  });
  EXPECT_EQ(newest.agreement, Agreement::kDisagrees);
}

TEST(OdometryMonitor, EndsWhileAScanWaits) {
  for (int i = 0; i < 3; ++i) {
    OdometryMonitor monitor(MotionConfig(), [](const OdometryFinding&) {});
    int scans = 0;
    drive(kSpeed, [&](const LabeledScan& scan) {
      if (scans++ < 2) monitor.add(scan);
    });
  }
}

TEST(OdometryMonitor, AsksOnlyWhereSomebodyElseTellsTheMotion) {
  MotionConfig config;
  EXPECT_TRUE(isChecked(config, OdometrySource::kPose));
  EXPECT_TRUE(isChecked(config, OdometrySource::kTf));
  EXPECT_FALSE(isChecked(config, OdometrySource::kLidar));
  EXPECT_FALSE(isChecked(config, OdometrySource::kNone));
  config.odometry_check = false;
  EXPECT_FALSE(isChecked(config, OdometrySource::kPose));
}

}  // namespace
}  // namespace donex
