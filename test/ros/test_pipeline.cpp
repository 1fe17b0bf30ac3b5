// Clouds meet their motion by time, whatever the order of arrival, and the motion is the right one.
#include <algorithm>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "donex/memory_bound.h"
#include "ros/pipeline_rig.h"

namespace donex {
namespace {

using test::CloudBuilder;
using test::PipelineRig;
using test::PointField;

TEST(Pipeline, WaitsForOdometryThatCoversTheStamp) {
  PipelineRig rig;
  rig.odometry(100.0);
  rig.cloud(100.05);
  rig.run(100.05);
  EXPECT_TRUE(rig.labeled.empty());
  rig.odometry(100.04);
  rig.run(100.06);
  EXPECT_TRUE(rig.labeled.empty()) << "within max_extrapolation, but what comes must not depend on when one asks";
  rig.odometry(100.06);
  rig.run(100.07);
  EXPECT_EQ(rig.stamps(), std::vector<double>{100.05});
  EXPECT_EQ(rig.pipeline.waiting(), 0U);
}

TEST(Pipeline, InterpolatesThePoseAtTheStamp) {
  PipelineRig rig;
  rig.odometry(100.0, 8.0);
  rig.odometry(100.1, 8.0);
  rig.cloud(100.025);
  rig.run(100.1);
  ASSERT_EQ(rig.labeled.size(), 1U);
  EXPECT_NEAR(rig.labeled[0].odom_from_base.translation().x(), 0.2, 1e-6);
  EXPECT_NEAR(rig.labeled[0].base_from_sensor.translation().z(), 1.7, 1e-12);
}

TEST(Pipeline, TheOrderOfArrivalDoesNotMatter) {
  std::mt19937 random(11);
  for (int repetition = 0; repetition < 20; ++repetition) {
    // Clouds at 10 Hz, odometry at 50 Hz, both out of order by up to 0.3 s.
    std::multimap<double, double> clouds, odometry;  // by arrival
    std::uniform_real_distribution<double> delay(0.0, 0.3);
    for (int i = 0; i <= 20; ++i) clouds.emplace(100.0 + 0.1 * i + delay(random), 100.0 + 0.1 * i);
    for (int i = 0; i <= 105; ++i) odometry.emplace(100.0 + 0.02 * i + delay(random), 100.0 + 0.02 * i);
    PipelineRig rig;
    for (double now = 100.0; now < 104.0; now += 0.001) {
      for (; !odometry.empty() && odometry.begin()->first <= now; odometry.erase(odometry.begin())) {
        rig.odometry(odometry.begin()->second, 5.0);
      }
      for (; !clouds.empty() && clouds.begin()->first <= now; clouds.erase(clouds.begin())) {
        rig.cloud(clouds.begin()->second, now);
      }
      rig.run(now);
    }
    rig.pipeline.finish();
    EXPECT_TRUE(std::is_sorted(rig.labeled.begin(), rig.labeled.end(),
                               [](const auto& a, const auto& b) { return a.stamp < b.stamp; }));
    ASSERT_EQ(rig.labeled.size() + rig.pipeline.counts().dropped.total(), 21U);
    EXPECT_GE(rig.labeled.size(), 10U);
    for (const auto& scan : rig.labeled) {
      EXPECT_NEAR(scan.odom_from_base.translation().x(), 5.0 * (scan.stamp - 100.0), 1e-6);
    }
  }
}

TEST(Pipeline, ExtrapolatesOnlyAfterTheTimeoutAndOnlyBounded) {
  PipelineRig rig;
  rig.odometry(99.9, 8.0);
  rig.odometry(100.0, 8.0);
  rig.cloud(100.015);
  rig.cloud(100.03);
  rig.run(100.4);
  EXPECT_TRUE(rig.labeled.empty());
  rig.run(100.7);
  ASSERT_EQ(rig.stamps(), std::vector<double>{100.015});
  EXPECT_NEAR(rig.labeled[0].odom_from_base.translation().x(), 0.12, 1e-6);
  EXPECT_EQ(rig.dropped(DropReason::kNoOdometry), 1U);
  EXPECT_NE(rig.drops.at(0).find("0.030 s older"), std::string::npos) << rig.drops[0];
}

TEST(Pipeline, WithoutOdometryEveryCloudIsDroppedWithAReason) {
  PipelineRig rig;
  for (int i = 0; i < 5; ++i) rig.cloud(100.0 + 0.1 * i);
  rig.run(101.1);
  EXPECT_EQ(rig.dropped(DropReason::kNoOdometry), 5U);
  EXPECT_EQ(rig.drops.size(), 5U);
}

TEST(Pipeline, LateOdometryLosesNoCloud) {
  PipelineRig rig;
  for (int i = 0; i < 30; ++i) {
    const double now = 100.0 + 0.1 * i;
    rig.cloud(now);
    if (i >= 4) rig.odometry(now - 0.4);
    rig.run(now);
  }
  EXPECT_EQ(rig.labeled.size(), 26U);
  EXPECT_EQ(rig.pipeline.counts().dropped.total(), 0U);
}

TEST(Pipeline, BeforeTheFirstOdometry) {
  PipelineRig rig;
  rig.odometry(100.0);
  rig.cloud(99.9);
  rig.run(100.0);
  EXPECT_EQ(rig.dropped(DropReason::kBeforeOdometry), 1U);
}

TEST(Pipeline, AGapIsNotInterpolated) {
  PipelineRig rig;
  rig.odometry(100.0);
  rig.odometry(105.0);
  rig.cloud(102.0, 105.0);
  rig.cloud(105.0);
  rig.run(105.0);
  EXPECT_EQ(rig.dropped(DropReason::kOdometryGap), 1U);
  EXPECT_EQ(rig.stamps(), std::vector<double>{105.0});
}

TEST(Pipeline, TheQueueIsBoundedAndTheNewestStay) {
  Config config = test::smallConfig();
  config.node.queue_size = 3;
  PipelineRig rig(config);
  for (int i = 0; i < 8; ++i) rig.cloud(100.0 + 0.1 * i, 100.0);
  EXPECT_EQ(rig.pipeline.waiting(), 3U);
  EXPECT_EQ(rig.dropped(DropReason::kQueueFull), 5U);
  rig.odometry(100.0);
  rig.odometry(100.8);
  rig.run(100.0);
  EXPECT_EQ(rig.stamps(), (std::vector<double>{100.5, 100.6, 100.7}));
}

/// Sector `part` of 10 of a ring.
sensor_msgs::PointCloud2ConstPtr partOfARing(int part, double stamp, std::size_t echoes = 1000) {
  const std::vector<Eigen::Vector3f> all = test::ring(echoes);
  const auto each = static_cast<std::ptrdiff_t>(echoes / 10);
  return test::plainCloud({all.begin() + part * each, all.begin() + (part + 1) * each}, stamp);
}

TEST(Pipeline, ThePartsOfATurnCountAsOneInTheQueue) {
  Config config = test::smallConfig();
  config.node.queue_size = 3;
  PipelineRig rig(config);
  constexpr double kPart = 0.01;  // [s]
  const auto send = [&](int first, int last, std::size_t echoes) {
    for (int k = first; k < last; ++k) {
      const double stamp = 100.0 + kPart * k;
      rig.pipeline.addCloud(partOfARing(k % 10, stamp, echoes), stamp);
    }
  };
  for (int k = 0; k < 20; ++k) {
    rig.odometry(100.0 + kPart * k);
    send(k, k + 1, 1000);
    rig.run(100.0 + kPart * k);
  }
  ASSERT_EQ(rig.labeled.size(), 20U);
  // Then the odometry is late.
  send(20, 60, 1000);
  EXPECT_EQ(rig.pipeline.waiting(), 30U);
  EXPECT_EQ(rig.dropped(DropReason::kQueueFull), 10U);
  // What was a part may be followed by anything: memory stays bounded.
  send(60, 66, 10 * kUsualScan);
  EXPECT_EQ(rig.pipeline.waiting(), 3U);
}

TEST(Pipeline, MissingTransformIsWaitedForThenDropped) {
  PipelineRig rig(test::smallConfig(), false);
  for (int i = 0; i < 20; ++i) rig.odometry(100.0 + 0.1 * i);
  rig.cloud(100.0);
  rig.cloud(100.5);
  rig.run(100.7);
  EXPECT_EQ(rig.dropped(DropReason::kNoTransform), 1U);
  EXPECT_NE(rig.drops.at(0).find("'base_link' <- 'lidar'"), std::string::npos) << rig.drops[0];
  rig.tf.setTransform(test::transformAt(0.0, "base_link", "lidar", 0.0, 1.7), "test", true);
  rig.run(100.8);
  EXPECT_EQ(rig.stamps(), std::vector<double>{100.5});
}

TEST(Pipeline, OdometryOfAnUnconnectedFrame) {
  PipelineRig rig;
  const auto wrong = [](double stamp) {
    auto odometry = test::odometryAt(stamp);
    odometry.child_frame_id = "somebody_else";
    return odometry;
  };
  for (int i = 0; i < 10; ++i) rig.pipeline.addOdometry(wrong(100.0 + 0.1 * i));
  rig.cloud(100.2);
  rig.run(100.9);
  EXPECT_EQ(rig.dropped(DropReason::kNoTransform), 1U);
  EXPECT_NE(rig.drops.at(0).find("somebody_else"), std::string::npos) << rig.drops[0];
  // The right frames come: the old track must not be mixed with the new one.
  rig.odometry(101.0);
  rig.odometry(101.1);
  rig.cloud(101.05);
  rig.run(101.1);
  EXPECT_EQ(rig.stamps(), std::vector<double>{101.05});
  EXPECT_EQ(rig.forgotten.size(), 1U);
}

/// Odometry of a second source, in step with the usual one.
nav_msgs::Odometry otherOdometry(double stamp) {
  auto odometry = test::odometryAt(stamp, 3.0);
  odometry.header.frame_id = "map";
  return odometry;
}

TEST(Pipeline, OfTwoSourcesOnOneTopicTheConfiguredOneIsUsed) {
  for (const bool is_second_first : {false, true}) {
    PipelineRig rig;
    if (is_second_first) rig.pipeline.addOdometry(otherOdometry(99.95));
    for (int i = 0; i < 10; ++i) {
      const double stamp = 100.0 + 0.1 * i;
      rig.odometry(stamp);
      rig.pipeline.addOdometry(otherOdometry(stamp + 0.02));
      rig.cloud(stamp);
      rig.run(stamp);
    }
    EXPECT_EQ(rig.labeled.size(), 10U);
    EXPECT_EQ(rig.refused(OdometryRefusal::kOtherSource), 10U);
    EXPECT_EQ(rig.forgotten.size(), is_second_first ? 1U : 0U);
    EXPECT_NE(rig.refusals.at(0).find("two sources"), std::string::npos) << rig.refusals[0];
    for (const char* frame : {"'odom'", "'map'", "fixed_frame"}) {
      EXPECT_NE(rig.refusals[0].find(frame), std::string::npos) << rig.refusals[0];
    }
  }
}

TEST(Pipeline, ASourceThatEndsMakesWayForAnother) {
  PipelineRig rig;
  for (int i = 0; i < 5; ++i) rig.odometry(100.0 + 0.1 * i);
  for (int i = 0; i < 5; ++i) rig.pipeline.addOdometry(otherOdometry(102.0 + 0.1 * i));
  rig.cloud(102.1);
  rig.run(102.4);
  EXPECT_EQ(rig.labeled.size(), 1U);
  EXPECT_EQ(rig.refused(OdometryRefusal::kOtherSource), 0U);
}

TEST(Pipeline, ALeadingSlashIsNoOtherFrame) {
  PipelineRig rig;
  auto odometry = test::odometryAt(100.0);
  odometry.header.frame_id = "/odom";
  odometry.child_frame_id = "/base_link";
  rig.pipeline.addOdometry(odometry);
  rig.pipeline.addCloud(test::plainCloud(test::ring(), 100.0, "/lidar"), 100.0);
  rig.run(100.0);
  EXPECT_EQ(rig.labeled.size(), 1U);
}

TEST(Pipeline, BaseFrameWhereTheOdometryNamesNone) {
  PipelineRig rig;
  auto odometry = test::odometryAt(100.0);
  odometry.child_frame_id.clear();
  rig.pipeline.addOdometry(odometry);
  rig.cloud(100.0);
  rig.run(100.0);
  EXPECT_EQ(rig.labeled.size(), 1U);
}

TEST(Pipeline, AtRestNothingElseIsNeeded) {
  PipelineRig rig(test::smallConfig(OdometrySource::kNone), false);
  rig.cloud(100.0);
  rig.cloud(100.1);
  rig.run(100.1);
  ASSERT_EQ(rig.labeled.size(), 2U);
  EXPECT_TRUE(rig.labeled[1].odom_from_base.isApprox(Eigen::Isometry3d::Identity()));
}

TEST(Pipeline, TellsOnceWhatTheSensorIsLike) {
  std::vector<Eigen::Vector3f> rings;
  for (const float slope : {-0.1F, -0.07F, -0.04F, -0.01F}) {
    for (int azimuth = 0; azimuth < 720; ++azimuth) {
      const float angle = static_cast<float>(azimuth) * static_cast<float>(M_PI) / 360.0F;
      rings.emplace_back(20.0F * std::cos(angle), 20.0F * std::sin(angle), 20.0F * slope);
    }
  }
  PipelineRig rig(test::smallConfig(OdometrySource::kNone), false);
  for (int k = 0; k < 5; ++k) {
    const double stamp = 100.0 + 0.1 * k;
    rig.pipeline.addCloud(test::plainCloud(rings, stamp), stamp);
    rig.run(stamp);
    EXPECT_EQ(rig.sensors.size(), k == 0 ? 0U : 1U);
  }
  ASSERT_EQ(rig.sensors.size(), 1U);
  EXPECT_EQ(rig.sensors[0].rfind("beams 1.7", 0), 0U) << rig.sensors[0];
  EXPECT_NE(rig.sensors[0].find("over 360 deg of azimuth, 10.0 turns a second"), std::string::npos) << rig.sensors[0];
}

TEST(Pipeline, MotionFromTf) {
  PipelineRig rig(test::smallConfig(OdometrySource::kTf));
  rig.tf.setTransform(test::transformAt(100.0, "odom", "base_link", 0.0), "test");
  rig.cloud(100.05);
  rig.run(100.05);
  EXPECT_TRUE(rig.labeled.empty());
  rig.tf.setTransform(test::transformAt(100.1, "odom", "base_link", 1.0), "test");
  rig.run(100.1);
  ASSERT_EQ(rig.labeled.size(), 1U);
  EXPECT_NEAR(rig.labeled[0].odom_from_base.translation().x(), 0.5, 1e-6);
}

TEST(Pipeline, MotionFromTwist) {
  PipelineRig rig(test::smallConfig(OdometrySource::kTwist));
  for (int i = 0; i <= 10; ++i) {
    auto odometry = test::odometryAt(100.0 + 0.1 * i, 4.0);
    odometry.pose.pose = {};  // nobody fills it in
    rig.pipeline.addOdometry(odometry);
  }
  rig.cloud(100.0);
  rig.cloud(100.75);
  rig.run(101.0);
  ASSERT_EQ(rig.labeled.size(), 2U);
  const Eigen::Isometry3d moved = rig.labeled[0].odom_from_base.inverse() * rig.labeled[1].odom_from_base;
  EXPECT_NEAR(moved.translation().x(), 3.0, 1e-6);
}

/// A point 20 m ahead, seen three times in one scan at 10 m/s.
boost::shared_ptr<test::PointCloud2> distortedCloud(double stamp) {
  CloudBuilder builder;
  builder.stamp(stamp).xyz().field("time", PointField::FLOAT32).size(3);
  for (std::size_t i = 0; i < 3; ++i) {
    const double time = 0.05 * static_cast<double>(i);
    builder.at(i, 20.0 - 10.0 * time, 0.0, 0.0).set(i, "time", time);
  }
  return builder.build();
}

TEST(Pipeline, DeskewsByEachEchosOwnTime) {
  for (const OdometrySource source : {OdometrySource::kPose, OdometrySource::kTwist, OdometrySource::kTf}) {
    PipelineRig rig(test::smallConfig(source));
    rig.tf.setTransform(test::transformAt(100.0, "odom", "base_link", 0.0), "test");
    rig.odometry(100.0, 10.0);
    rig.odometry(100.05, 10.0);
    rig.pipeline.addCloud(distortedCloud(100.0), 100.0);
    rig.run(100.05);
    EXPECT_TRUE(rig.labeled.empty()) << "the last echo is not covered yet";
    rig.tf.setTransform(test::transformAt(100.2, "odom", "base_link", 2.0), "test");
    rig.odometry(100.1, 10.0);
    rig.run(100.1);
    ASSERT_EQ(rig.labeled.size(), 1U);
    for (const Eigen::Vector3f& echo : rig.labeled[0].echoes) EXPECT_NEAR(echo.x(), 20.0F, 1e-3F);
  }
}

TEST(Pipeline, WithoutDeskewEchoesStayAsMeasured) {
  Config config = test::smallConfig();
  config.motion.deskew = false;
  PipelineRig rig(config);
  rig.odometry(100.0, 10.0);
  rig.pipeline.addCloud(distortedCloud(100.0), 100.0);
  rig.run(100.0);
  ASSERT_EQ(rig.labeled.size(), 1U);
  EXPECT_EQ(rig.labeled[0].echoes[2].x(), 19.0F);
}

TEST(Pipeline, TimesOfAnotherClockAreToldAndIgnored) {
  PipelineRig rig;
  rig.odometry(100.0, 10.0);
  auto cloud = CloudBuilder().stamp(100.0).xyz().field("timestamp", PointField::FLOAT64).size(1);
  rig.pipeline.addCloud(cloud.at(0, 1, 2, 3).set(0, "timestamp", 5e8).build(), 100.0);
  rig.run(100.0);
  EXPECT_EQ(rig.labeled.size(), 1U);
  EXPECT_EQ(rig.strange_times.size(), 1U);
}

}  // namespace
}  // namespace donex
