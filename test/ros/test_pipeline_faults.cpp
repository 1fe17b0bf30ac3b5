// Whatever comes in: every cloud is labelled or dropped for a reason, once, and the pipeline goes on.
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "ros/pipeline_rig.h"

namespace donex {
namespace {

using test::CloudBuilder;
using test::PipelineRig;
using test::PointField;

/// Scans from `first` on, 10 Hz, with odometry of the same stamps.
void drive(PipelineRig& rig, double first, int scans) {
  for (int i = 0; i < scans; ++i) {
    const double stamp = first + 0.1 * i;
    rig.odometry(stamp);
    rig.cloud(stamp);
    rig.run(stamp);
  }
}

TEST(PipelineFaults, UnreadableCloudsAreCountedAndTheNextIsLabelled) {
  PipelineRig rig;
  rig.odometry(100.0);
  rig.pipeline.addCloud(CloudBuilder().field("x", PointField::FLOAT32).size(5).build(), 100.0);
  auto huge = test::plainCloud(test::ring(), 100.0);
  huge->width = std::numeric_limits<std::uint32_t>::max();
  rig.pipeline.addCloud(huge, 100.0);
  EXPECT_EQ(rig.dropped(DropReason::kBadLayout), 2U);
  EXPECT_NE(rig.drops.at(0).find("'y'"), std::string::npos) << rig.drops[0];
  rig.cloud(100.0);
  rig.run(100.0);
  EXPECT_EQ(rig.labeled.size(), 1U);
}

TEST(PipelineFaults, EmptyOneEchoAndAllNaN) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  PipelineRig rig;
  drive(rig, 100.0, 2);
  rig.odometry(100.2);
  rig.odometry(100.6);
  rig.pipeline.addCloud(test::plainCloud({}, 100.2), 100.2);
  rig.pipeline.addCloud(test::plainCloud({{1.0F, 2.0F, 0.5F}}, 100.3), 100.3);
  rig.pipeline.addCloud(test::plainCloud(std::vector<Eigen::Vector3f>(50, {nan, nan, nan}), 100.4), 100.4);
  rig.cloud(100.5);
  rig.run(100.6);
  ASSERT_EQ(rig.labeled.size(), 6U);
  EXPECT_TRUE(rig.labeled[2].labels.dynamic.empty());
  EXPECT_EQ(rig.labeled[4].labels.dynamic, std::vector<std::uint8_t>(50, 0));
  EXPECT_EQ(rig.labeled[4].labels.observed, std::vector<std::uint8_t>(50, 0));
}

TEST(PipelineFaults, StampsAtTheBeginningOfTime) {
  for (const OdometrySource source : {OdometrySource::kTf, OdometrySource::kPose, OdometrySource::kTwist}) {
    PipelineRig rig(test::smallConfig(source));
    rig.tf.setTransform(test::transformAt(0.1, "odom", "base_link", 0.0), "test");
    rig.odometry(0.1);
    CloudBuilder early;
    early.xyz().field("time", PointField::FLOAT32).size(2).stamp(0.01);
    early.at(0, 1, 2, 3).set(0, "time", -0.5).at(1, 1, 2, 3).set(1, "time", 0.0);
    rig.pipeline.addCloud(early.build(), 1.0);
    rig.cloud(0.0, 1.0);
    rig.pipeline.finish();
    EXPECT_EQ(rig.drops.size(), 2U);
    EXPECT_EQ(rig.pipeline.waiting(), 0U);
  }
}

TEST(PipelineFaults, ADuplicateIsDropped) {
  PipelineRig rig;
  rig.cloud(100.0);
  rig.cloud(100.0);
  rig.odometry(100.0);
  rig.run(100.0);
  rig.cloud(100.0);
  EXPECT_EQ(rig.labeled.size(), 1U);
  EXPECT_EQ(rig.dropped(DropReason::kDuplicate), 2U);
}

TEST(PipelineFaults, OneStragglerIsDroppedAndTheGridStays) {
  PipelineRig rig;
  drive(rig, 100.0, 3);
  rig.cloud(100.05, 100.3);
  drive(rig, 100.3, 2);
  EXPECT_EQ(rig.labeled.size(), 5U);
  EXPECT_EQ(rig.dropped(DropReason::kOutOfOrder), 1U);
  EXPECT_TRUE(rig.forgotten.empty());
}

/// The paper's rule alone: whatever is new is dynamic at once, also a single echo.
Config smallPaperConfig() {
  Config config = paperConfig(Method::kDonex3d);
  config.region = test::smallConfig().region;
  return config;
}

/// A ring where the lines of sight to the usual one have been: new, unless the grid is.
void driveInside(PipelineRig& rig, double stamp) {
  rig.odometry(stamp);
  rig.pipeline.addCloud(test::plainCloud(test::ring(36, test::kInside), stamp), stamp);
  rig.run(stamp);
}

const std::vector<std::uint8_t> kNone(36, 0), kAll(36, 1);

TEST(PipelineFaults, ALoopedBagStartsAnewOnceAndLosesNothing) {
  PipelineRig rig(smallPaperConfig());
  for (int loop = 0; loop < 3; ++loop) {
    driveInside(rig, 100.0);
    drive(rig, 100.1, 38);
    driveInside(rig, 103.9);
  }
  EXPECT_EQ(rig.labeled.size(), 120U);
  EXPECT_EQ(rig.pipeline.counts().dropped.total(), 0U);
  EXPECT_EQ(rig.forgotten.size(), 2U) << "said once a loop";
  // The same echoes: nothing is dynamic in the first scan after a restart, all are in the last one before.
  for (const std::size_t first : {0U, 40U, 80U}) {
    EXPECT_EQ(rig.labeled[first].labels.dynamic, kNone);
    EXPECT_EQ(rig.labeled[first + 39].labels.dynamic, kAll);
  }
}

TEST(PipelineFaults, ALoopSeenByCloudsAlone) {
  Config config = test::smallConfig(OdometrySource::kNone);
  PipelineRig rig(config, false);
  for (int loop = 0; loop < 2; ++loop) drive(rig, 100.0, 10);
  EXPECT_EQ(rig.labeled.size(), 20U);
  EXPECT_EQ(rig.forgotten.size(), 1U);
}

TEST(PipelineFaults, CloudsThatWaitWhenTimeRunsBackAreAccountedFor) {
  PipelineRig rig;
  drive(rig, 200.0, 5);
  rig.cloud(200.6);
  rig.cloud(200.7);
  drive(rig, 100.0, 5);
  EXPECT_EQ(rig.dropped(DropReason::kTimeRanBack), 2U);
  EXPECT_EQ(rig.labeled.size(), 10U);
}

TEST(PipelineFaults, OneOldOdometryChangesNothing) {
  PipelineRig rig;
  drive(rig, 100.0, 5);
  rig.odometry(3.0);
  drive(rig, 100.5, 5);
  EXPECT_EQ(rig.labeled.size(), 10U);
  EXPECT_TRUE(rig.forgotten.empty());
  EXPECT_EQ(rig.refused(OdometryRefusal::kTooOld), 1U);
}

TEST(PipelineFaults, BadOdometryIsRefusedWithItsReason) {
  PipelineRig rig;
  auto nan = test::odometryAt(100.0);
  nan.pose.pose.position.y = std::nan("");
  auto no_rotation = test::odometryAt(100.0);
  no_rotation.pose.pose.orientation.w = 0.0;
  auto long_quaternion = test::odometryAt(100.0);
  long_quaternion.pose.pose.orientation.w = 1.5;
  auto nameless = test::odometryAt(100.0);
  nameless.header.frame_id.clear();
  for (const auto& odometry : {nan, no_rotation, long_quaternion, nameless}) rig.pipeline.addOdometry(odometry);
  EXPECT_EQ(rig.refused(OdometryRefusal::kNonFinite), 1U);
  EXPECT_EQ(rig.refused(OdometryRefusal::kNonUnitQuaternion), 2U);
  EXPECT_EQ(rig.refused(OdometryRefusal::kNoFrame), 1U);
  EXPECT_EQ(rig.refusals.size(), 4U);
  drive(rig, 100.0, 3);
  rig.odometry(100.1);
  EXPECT_EQ(rig.refused(OdometryRefusal::kDuplicate), 1U);
  EXPECT_EQ(rig.labeled.size(), 3U);
}

TEST(PipelineFaults, ALostTwistTrackForgetsTheGrid) {
  Config config = test::smallConfig(OdometrySource::kTwist);
  PipelineRig rig(config);
  drive(rig, 100.0, 3);
  drive(rig, 110.0, 3);
  EXPECT_EQ(rig.labeled.size(), 6U);
  EXPECT_EQ(rig.forgotten.size(), 1U);
}

TEST(PipelineFaults, AnExceptionOfTheOwnerIsCounted) {
  tf2::BufferCore tf;
  Config config = test::smallConfig(OdometrySource::kNone);
  int calls = 0;
  std::string told;
  PipelineEvents events;
  events.labeled = [&](const LabeledScan&) {
    if (++calls == 1) throw std::runtime_error("no room");
  };
  events.dropped = [&](DropReason, const std::string& text) { told = text; };
  events.refused = [](OdometryRefusal, const std::string&) {};
  events.forgotten = events.strange_times = [](const std::string&) {};
  Pipeline pipeline(config, tf, events);
  for (const double stamp : {100.0, 100.1}) {
    pipeline.addCloud(test::plainCloud(test::ring(), stamp), stamp);
    EXPECT_TRUE(pipeline.step(stamp));
  }
  EXPECT_EQ(pipeline.counts().dropped.of(DropReason::kInternalError), 1U);
  EXPECT_EQ(told, "no room");
  EXPECT_EQ(pipeline.counts().clouds_labeled, 1U);
}

TEST(PipelineFaults, FinishSettlesWhatWaits) {
  PipelineRig rig;
  drive(rig, 100.0, 3);
  rig.cloud(100.21);
  rig.cloud(100.5);
  rig.cloud(100.0, 100.5);
  rig.cloud(100.05, 100.5);
  rig.pipeline.finish();
  EXPECT_EQ(rig.pipeline.waiting(), 0U);
  const auto& counts = rig.pipeline.counts();
  EXPECT_EQ(counts.clouds_in, counts.clouds_labeled + counts.dropped.total());
}

TEST(PipelineFaults, ConfigureRefusesFaultsAndRebuildsOnlyForTheGrid) {
  PipelineRig rig(smallPaperConfig());
  drive(rig, 100.0, 2);
  Config config = smallPaperConfig();
  config.voxel_size = 7.0;
  config.region.x_max = -60.0;
  try {
    rig.pipeline.configure(config);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("voxel_size"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("x_max"), std::string::npos);
  }
  drive(rig, 100.2, 8);
  config = smallPaperConfig();
  config.node.markers = false;
  rig.pipeline.configure(config);
  driveInside(rig, 101.0);
  EXPECT_EQ(rig.labeled.at(10).labels.dynamic, kAll) << "a switch keeps the grid";
  drive(rig, 101.1, 10);
  rig.pipeline.addCloud(test::plainCloud(test::ring(36, test::kInside), 102.1), 102.1);
  config.voxel_size = 0.3;
  rig.pipeline.configure(config);
  drive(rig, 102.2, 2);
  ASSERT_EQ(rig.labeled.size(), 24U) << "the waiting cloud is not lost";
  EXPECT_EQ(rig.labeled[21].labels.dynamic, kNone) << "first scan of the new grid";
}

TEST(PipelineFaults, EveryCloudIsAccountedForUnderRandomFaults) {
  std::mt19937 random(5);
  const auto chance = [&](double probability) {
    return std::uniform_real_distribution<double>(0.0, 1.0)(random) < probability;
  };
  Config config = test::smallConfig();
  config.node.queue_size = 4;
  PipelineRig rig(config);
  double time = 1000.0;
  for (int i = 0; i < 3000; ++i) {
    time += 0.1;
    if (chance(0.01)) time -= 20.0;
    if (chance(0.01)) time += 20.0;
    const double jitter = chance(0.05) ? -0.25 : 0.0;
    if (!chance(0.1)) rig.odometry(time + jitter, 1.0);
    if (chance(0.02)) rig.pipeline.addCloud(CloudBuilder().size(3).build(), time);
    rig.cloud(time + (chance(0.05) ? -0.3 : 0.0), time);
    if (chance(0.03)) rig.cloud(time);
    rig.run(time);
    const auto& counts = rig.pipeline.counts();
    ASSERT_LE(counts.clouds_labeled + counts.dropped.total(), counts.clouds_in);
    ASSERT_LE(counts.clouds_in - counts.clouds_labeled - counts.dropped.total(), 5U) << "queue and one suspect";
  }
  rig.pipeline.finish();
  const auto& counts = rig.pipeline.counts();
  EXPECT_EQ(counts.clouds_in, counts.clouds_labeled + counts.dropped.total());
  EXPECT_EQ(rig.drops.size(), counts.dropped.total());
  EXPECT_GT(counts.clouds_labeled, 2000U);
}

TEST(PipelineFaults, OdometryThatJumpsForgetsTheGridOnce) {
  PipelineRig rig;
  for (int i = 0; i < 10; ++i) {
    const double stamp = 100.0 + 0.1 * i;
    auto odometry = test::odometryAt(stamp, 3.0);
    if (i >= 5) odometry.pose.pose.position.y = 0.5;
    rig.pipeline.addOdometry(odometry);
    rig.cloud(stamp);
    rig.run(stamp);
  }
  EXPECT_EQ(rig.labeled.size(), 10U);
  EXPECT_EQ(rig.pipeline.counts().jumps, 1U);
  ASSERT_EQ(rig.forgotten.size(), 1U);
  EXPECT_NE(rig.forgotten[0].find("jumped by 0.50 m"), std::string::npos) << rig.forgotten[0];
}

TEST(PipelineFaults, JumpsAreLeftAloneWithoutTheCheck) {
  Config config = test::smallConfig();
  config.motion.odometry_check = false;
  PipelineRig rig(config);
  for (int i = 0; i < 10; ++i) {
    const double stamp = 100.0 + 0.1 * i;
    rig.pipeline.addOdometry(test::odometryAt(stamp, i < 5 ? 3.0 : 9.0));
    rig.cloud(stamp);
    rig.run(stamp);
  }
  EXPECT_EQ(rig.pipeline.counts().jumps, 0U);
  EXPECT_TRUE(rig.forgotten.empty());
}

TEST(PipelineFaults, APoseThatNobodyFillsInIsRefusedWithWhatToSet) {
  PipelineRig rig;
  for (int i = 0; i < 20; ++i) {
    auto odometry = test::odometryAt(100.0 + 0.05 * i);
    odometry.twist.twist.linear.x = 10.0;
    rig.pipeline.addOdometry(odometry);
  }
  EXPECT_EQ(rig.refused(OdometryRefusal::kStandsStill), 13U) << "from 0.35 s on";
  ASSERT_FALSE(rig.refusals.empty());
  EXPECT_NE(rig.refusals.back().find("set odometry_source: twist"), std::string::npos) << rig.refusals.back();
}

EchoLabels labelsWith(std::size_t dynamic) {
  EchoLabels labels;
  labels.assign(1000);
  labels.observed.assign(1000, 1);
  std::fill_n(labels.dynamic.begin(), dynamic, 1);
  return labels;
}

TEST(FloodWatch, TellsASuddenFloodOnce) {
  FloodWatch watch;
  int scan = 0;
  const auto follow = [&](std::size_t dynamic) { return watch.follow(100.0 + 0.1 * scan++, labelsWith(dynamic)); };
  for (int i = 0; i < 20; ++i) EXPECT_EQ(follow(20), 0.0) << i;
  EXPECT_EQ(follow(400), 0.0) << "one scan";
  EXPECT_EQ(follow(400), 0.4) << "two";
  for (int i = 0; i < 20; ++i) EXPECT_EQ(follow(400), 0.0) << i;
}

TEST(FloodWatch, IsNoCrowdAndNoStart) {
  FloodWatch crowd, start;
  for (int i = 0; i < 40; ++i) {
    EXPECT_EQ(crowd.follow(0.1 * i, labelsWith(static_cast<std::size_t>(10 * i))), 0.0) << i;
    EXPECT_EQ(start.follow(0.1 * i, labelsWith(400)), 0.0) << i;
  }
}

TEST(FloodWatch, LooksAtPartsOfATurnTogether) {
  FloodWatch watch;
  double share = 0.0;
  const auto turn = [&](int number, std::size_t dynamic, std::size_t in_one_part) {
    for (int part = 0; part < 10; ++part) {
      const std::size_t more = part == 4 ? in_one_part : 0;
      share = std::max(share, watch.follow(0.1 * number + 0.01 * part, labelsWith(dynamic + more)));
    }
  };
  for (int i = 0; i < 20; ++i) turn(i, 10, 0);
  for (int i = 20; i < 30; ++i) turn(i, 10, 800);
  EXPECT_EQ(share, 0.0) << "a lorry fills one part";
  for (int i = 30; i < 40; ++i) turn(i, 10, 0);
  for (int i = 40; i < 43; ++i) turn(i, 500, 0);
  EXPECT_NEAR(share, 0.5, 0.06) << "everywhere at once";
}

TEST(PipelineFaults, WhatStandsAndIsDynamicAtOnceIsSaid) {
  std::vector<std::string> said;
  PipelineEvents events;
  events.labeled = [](const LabeledScan&) {};
  events.dropped = [](DropReason, const std::string& text) { ADD_FAILURE() << text; };
  events.refused = [](OdometryRefusal, const std::string& text) { ADD_FAILURE() << text; };
  events.forgotten = events.strange_times = [](const std::string&) {};
  events.flooded = [&](const std::string& text) { said.push_back(text); };
  tf2::BufferCore tf;
  Config config = paperConfig(Method::kDonex3d);
  config.region = test::smallConfig().region;
  config.motion.source = OdometrySource::kNone;
  Pipeline pipeline(config, tf, events);
  for (int i = 0; i < 30; ++i) {
    // From scan 25 on all of it is elsewhere in every scan: whatever the reason, it is not the world.
    const float radius = i < 25 ? 10.0F : 10.0F - 0.6F * static_cast<float>(i - 24);
    const double stamp = 100.0 + 0.1 * i;
    pipeline.addCloud(test::plainCloud(test::ring(1000, radius), stamp), stamp);
    pipeline.step(stamp);
  }
  ASSERT_EQ(said.size(), 1U);
  EXPECT_NE(said[0].find("checked: jumps of the odometry (0)"), std::string::npos) << said[0];
  EXPECT_EQ(pipeline.counts().floods, 1U);
}

}  // namespace
}  // namespace donex
