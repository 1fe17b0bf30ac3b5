// Hours of driving in minutes: a simulated drive again and again, with whatever goes wrong in a vehicle thrown in at
// random. No crash, every scan accounted for, memory flat. DONEX_SOAK_SCANS says how many (scripts/soak: 36,000).
#include <array>
#include <cmath>
#include <iostream>
#include <random>

#include <gtest/gtest.h>

#include "ros/pipeline_rig.h"
#include "ros/soak_drive.h"

namespace donex {
namespace {

using test::PipelineRig;
using test::SoakDrive;

constexpr double kPeriod = 0.1;                  // [s]
constexpr std::size_t kLeastForReasons = 10000;  // scans

/// What the faults lead to, each of them sooner or later.
constexpr std::array kThrownIn{DropReason::kBadLayout,   DropReason::kQueueFull,   DropReason::kNoOdometry,
                               DropReason::kOdometryGap, DropReason::kNoTransform, DropReason::kOutOfOrder,
                               DropReason::kDuplicate,   DropReason::kTimeRanBack};

class Soak {
 public:
  explicit Soak(std::size_t scans) : scans_(scans), drive_(scans, {}), rig_(configOf(0.3), false) {
    rig_.tf.setTransform(mountingOf(Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 1.8)), 1.0, {}), "soak", true);
  }

  void run() {
    for (std::size_t scan = 0; scan < scans_; ++scan) {
      now_ += kPeriod;
      jumpInTime();
      disturb();
      sendOdometry(drive_.at(scan));
      sendCloud(drive_.at(scan));
      if (chance(0.004)) busy_ = 20;  // scans, which pile up
      busy_ == 0 ? rig_.run(now_) : void(--busy_);
      forgetNotes();
      memory_.look();
    }
    rig_.pipeline.finish();
  }

  const PipelineCounts& counts() const { return rig_.pipeline.counts(); }
  std::size_t sent() const { return sent_; }
  const test::MemoryWatch& memory() const { return memory_; }

 private:
  static Config configOf(double voxel_size) {
    Config config;
    config.region = {-30.0, 30.0, -30.0, 30.0, -3.0, 5.0};
    config.voxel_size = voxel_size;
    return config;
  }
  bool chance(double probability) { return std::uniform_real_distribution<double>(0.0, 1.0)(random_) < probability; }

  void jumpInTime() {
    if (chance(0.001)) now_ -= 50.0;
    if (chance(0.001)) now_ += 50.0;
    if (chance(0.003)) odometry_lost_until_ = now_ + 3.0;
  }
  void disturb() {
    if (chance(0.002)) rig_.pipeline.reset();
    if (chance(0.002)) rig_.pipeline.configure(configOf(0.35));
    if (chance(0.01)) rig_.pipeline.configure(configOf(0.3));
    if (chance(0.005)) add(test::CloudBuilder().field("x", test::PointField::INT8).size(3).build());
    if (chance(0.005)) add(test::plainCloud(test::ring(), now_, "nobody_knows"));
    if (chance(0.005)) add(test::plainCloud({}, now_ - 0.03, "velodyne"));
  }
  void sendOdometry(const SoakDrive::Piece& piece) {
    const bool is_lost = now_ < odometry_lost_until_ && now_ > odometry_lost_until_ - 10.0;
    if (is_lost) return;
    OdometrySample sample;
    sample.stamp = now_ - (chance(0.02) ? 0.3 : 0.0);
    sample.odom_from_base = piece.odom_from_base;
    if (chance(0.01)) sample.odom_from_base.translation().x() = std::nan("");
    rig_.pipeline.addOdometry(*toOdometry(sample, {}));
    if (chance(0.02)) rig_.pipeline.addOdometry(*toOdometry(sample, {}));
  }
  void sendCloud(const SoakDrive::Piece& piece) {
    auto cloud = boost::make_shared<sensor_msgs::PointCloud2>(*piece.cloud);
    cloud->header.stamp.fromSec(now_ - (chance(0.01) ? 0.25 : 0.0));
    if (chance(0.01)) cloud->data.resize(cloud->data.size() / 2);
    add(cloud);
    if (chance(0.01)) add(cloud);
  }
  void add(const sensor_msgs::PointCloud2ConstPtr& cloud) {
    ++sent_;
    rig_.pipeline.addCloud(cloud, now_);
  }
  /// The rig writes down everything: here that would be a leak of its own.
  void forgetNotes() {
    rig_.labeled.clear();
    for (auto* notes : {&rig_.drops, &rig_.refusals, &rig_.forgotten, &rig_.strange_times}) notes->clear();
  }

  test::MemoryWatch memory_;  // before all that it watches
  std::size_t scans_, sent_ = 0, busy_ = 0;
  std::mt19937 random_{7};
  SoakDrive drive_;
  PipelineRig rig_;
  double now_ = 1e6, odometry_lost_until_ = 0.0;
};

void printCounts(const PipelineCounts& counts) {
  std::cout << counts.clouds_in << " scans in, " << counts.clouds_labeled << " labelled, " << counts.dropped.total()
            << " dropped:\n";
  for (std::size_t i = 0; i < kDropReasons; ++i) {
    const auto reason = static_cast<DropReason>(i);
    std::cout << "  " << describe(reason) << ": " << counts.dropped.of(reason) << "\n";
  }
}

TEST(Soak, EveryScanIsAccountedForAndMemoryStaysFlat) {
  const std::size_t scans = test::soakScans(500);
  Soak soak(scans);
  soak.run();
  const PipelineCounts& counts = soak.counts();
  printCounts(counts);
  EXPECT_EQ(counts.clouds_in, soak.sent());
  EXPECT_EQ(counts.clouds_labeled + counts.dropped.total(), counts.clouds_in);
  EXPECT_EQ(counts.dropped.of(DropReason::kInternalError), 0U);
  EXPECT_GT(counts.clouds_labeled, scans / 2);
  soak.memory().expectFlat();
  if (scans < kLeastForReasons) return;
  for (const DropReason reason : kThrownIn) EXPECT_GT(counts.dropped.of(reason), 0U) << describe(reason);
}

}  // namespace
}  // namespace donex
