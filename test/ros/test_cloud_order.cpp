// Several sensors on one topic, and parts of scans: which clouds are judged, and which are not clouds of their own.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "ros/cloud_order.h"
#include "ros/pipeline_rig.h"

namespace donex {
namespace {

using test::CloudBuilder;
using test::PipelineRig;
using test::PointField;
using Frames = std::vector<std::string>;

constexpr double kSpeed = 8.0;  // [m/s]

/// A vehicle with sensors 1 m apart, whose odometry comes before the clouds.
struct SensorsRig : PipelineRig {
  explicit SensorsRig(const Frames& frames, const Config& config = test::smallConfig()) : PipelineRig(config, false) {
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const double x = 1.0 - static_cast<double>(i);
      tf.setTransform(test::transformAt(0.0, "base_link", frames[i], x, 1.7), "test", true);
    }
    for (double stamp = 99.0; stamp < 106.0; stamp += 0.05) odometry(stamp, kSpeed);
  }
  void cloudOf(const std::string& frame, double stamp, float radius = 10.0F) {
    pipeline.addCloud(test::plainCloud(test::ring(36, radius), stamp, frame), stamp);
    run(stamp);
  }
  void expectPosesOfTheirOwnTimes() const {
    for (const test::Labeled& scan : labeled) {
      EXPECT_NEAR(scan.odom_from_base.translation().x(), kSpeed * (scan.stamp - 100.0), 1e-6);
      EXPECT_EQ(scan.last_echo, scan.stamp) << "echoes without times of their own";
    }
  }
};

TEST(CloudOrder, SynchronisedSensorsShareTheirStamps) {
  for (const Method method : {Method::kDonex3d, Method::kDonex2d}) {
    Config config = test::smallConfig();
    config.method = method;
    SensorsRig rig({"front", "rear"}, config);
    for (int i = 0; i < 20; ++i) {
      rig.cloudOf("front", 100.0 + 0.1 * i);
      rig.cloudOf("rear", 100.0 + 0.1 * i);
    }
    EXPECT_EQ(rig.labeled.size(), 40U) << (rig.drops.empty() ? "" : rig.drops[0]);
    rig.expectPosesOfTheirOwnTimes();
    EXPECT_TRUE(rig.forgotten.empty());
  }
}

TEST(CloudOrder, SharedStampsWaitTogether) {
  SensorsRig rig({"front", "rear"});
  for (const char* frame : {"front", "rear", "front"}) {
    rig.pipeline.addCloud(test::plainCloud(test::ring(), 110.0, frame), 110.0);
  }
  EXPECT_EQ(rig.pipeline.waiting(), 2U);
  EXPECT_EQ(rig.dropped(DropReason::kDuplicate), 1U) << "the second of 'front'";
}

/// Each turn's newest cloud comes first: the next sensor's is 30 ms older, the third's 60 ms.
TEST(CloudOrder, SensorsMayComeNewestFirst) {
  const Frames frames{"roof", "left", "right"};
  SensorsRig rig(frames);
  for (int i = 0; i < 20; ++i) {
    for (std::size_t k = 0; k < 3; ++k) rig.cloudOf(frames[k], 100.06 + 0.1 * i - 0.03 * static_cast<double>(k));
  }
  EXPECT_EQ(rig.labeled.size(), 60U) << (rig.drops.empty() ? "" : rig.drops[0]);
  rig.expectPosesOfTheirOwnTimes();
  EXPECT_TRUE(rig.forgotten.empty());
}

TEST(CloudOrder, ASensorThatGoesBackIsNotHelpedByAnother) {
  SensorsRig rig({"front", "rear"});
  rig.cloudOf("front", 100.0);
  rig.cloudOf("rear", 100.05);
  rig.cloudOf("front", 100.1);
  rig.cloudOf("front", 100.06, 9.0F);
  rig.cloudOf("rear", 100.15);
  EXPECT_EQ(rig.stamps(), (std::vector<double>{100.0, 100.05, 100.1, 100.15}));
  EXPECT_EQ(rig.dropped(DropReason::kOutOfOrder), 1U);
}

TEST(CloudOrder, PartsOfOneStampAreCloudsOfTheirOwn) {
  SensorsRig rig({"lidar"});
  const auto echoes = test::ring(40);
  for (int turn = 0; turn < 5; ++turn) {
    for (int part = 0; part < 4; ++part) {
      const auto first = echoes.begin() + 10 * part;
      const double stamp = 100.0 + 0.1 * turn;
      const auto cloud = test::plainCloud({first, first + 10}, stamp);
      for (int time = 0; time < 2; ++time) rig.pipeline.addCloud(cloud, stamp);
      rig.run(stamp);
    }
  }
  EXPECT_EQ(rig.labeled.size(), 20U);
  EXPECT_EQ(rig.dropped(DropReason::kDuplicate), 20U) << "each part again";
}

TEST(CloudOrder, ATurnThatIsSentTwiceIsTakenOnce) {
  SensorsRig rig({"lidar"});
  for (int turn = 0; turn < 5; ++turn) {
    for (int time = 0; time < 2; ++time) {
      for (int part = 0; part < 10; ++part) rig.cloudOf("lidar", 100.0 + 0.1 * turn + 0.01 * part);
    }
  }
  EXPECT_EQ(rig.labeled.size(), 50U);
  EXPECT_EQ(rig.dropped(DropReason::kDuplicate), 50U);
  EXPECT_TRUE(rig.forgotten.empty());
}

/// Sectors of one organised cloud, each with nothing elsewhere: all of one size.
TEST(CloudOrder, LargeCloudsOfOneStampAreToldApartByTheirContent) {
  constexpr std::uint32_t kColumns = 1024, kRows = 64, kSectors = 40;
  CloudOrder order;
  for (std::uint32_t sector = 0; sector < kSectors; ++sector) {
    auto builder = CloudBuilder().xyz().field("intensity", PointField::FLOAT32).size(kColumns, kRows);
    const std::uint32_t first = sector * kColumns / kSectors, last = (sector + 1) * kColumns / kSectors;
    for (std::size_t row = 0; row < kRows; ++row) {
      for (std::size_t column = first; column < last; ++column) builder.at(row * kColumns + column, 5.0, 1.0, 0.5);
    }
    const auto cloud = builder.build();
    EXPECT_EQ(order.judge(*cloud), Arrival::kInTime) << sector;
    order.admit(*cloud);
    EXPECT_EQ(order.judge(*cloud), Arrival::kDuplicate) << sector;
  }
}

TEST(CloudOrder, StampsThatStandStillAreRefused) {
  CloudOrder order;
  std::vector<Arrival> all;
  for (std::size_t i = 0; i <= CloudOrder::kMostOfOneStamp; ++i) {
    const auto cloud = test::plainCloud(test::ring(1, 5.0F + static_cast<float>(i)), 100.0);
    all.push_back(order.judge(*cloud));
    if (all.back() == Arrival::kInTime) order.admit(*cloud);
  }
  EXPECT_EQ(std::count(all.begin(), all.end(), Arrival::kInTime), CloudOrder::kMostOfOneStamp);
  EXPECT_EQ(all.back(), Arrival::kDuplicate);
  EXPECT_NE(order.why().find("stand still"), std::string::npos) << order.why();
}

/// The other's clouds are 2 s old by the clock of the first, whose are all labelled.
TEST(CloudOrder, AnotherClockIsRefusedWithHowFarItIsBehind) {
  SensorsRig rig({"front", "rear"});
  for (int i = 0; i < 20; ++i) {
    rig.cloudOf("front", 103.0 + 0.1 * i);
    for (int k = 0; k < 2; ++k) rig.cloudOf("rear", 101.0 + 0.1 * i + 0.05 * k);
  }
  EXPECT_EQ(rig.labeled.size(), 20U);
  EXPECT_EQ(rig.dropped(DropReason::kOutOfOrder), 40U);
  EXPECT_TRUE(rig.forgotten.empty());
  EXPECT_NE(rig.drops.at(0).find("'rear' is 2.000000 s behind"), std::string::npos) << rig.drops[0];
}

TEST(CloudOrder, AnotherClockIsFollowedOnceItsCloudsAreAllThatComes) {
  SensorsRig rig({"front", "rear"}, test::smallConfig(OdometrySource::kNone));
  rig.cloudOf("front", 200.0);
  for (int i = 0; i < 60; ++i) rig.cloudOf("rear", 100.0 + 0.1 * i);
  EXPECT_EQ(rig.forgotten.size(), 1U);
  EXPECT_EQ(rig.labeled.size(), 11U) << "after " << CloudOrder::kLeft << " s";
}

TEST(CloudOrder, StampsOfAnyTimeAreTaken) {
  CloudOrder order;
  for (const double stamp : {4.2e9, 0.0, 2.1e9, 4.2e9}) {
    const auto cloud = test::plainCloud(test::ring(), stamp);
    EXPECT_NO_THROW(order.judge(*cloud));
    order.admit(*cloud);
    order.labeled(cloud->header);
  }
}

TEST(CloudOrder, EveryCloudIsAccountedForHoweverSensorsMix) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> late(0.0, 0.4);
  std::uniform_int_distribution<std::size_t> which(0, 2);
  const Frames frames{"a", "b", "c"};
  SensorsRig rig(frames);
  for (int i = 0; i < 1000; ++i) {
    rig.cloudOf(frames[which(random)], 100.4 + 0.005 * i - (i % 7 == 0 ? late(random) : 0.0));
  }
  rig.pipeline.finish();
  const auto& counts = rig.pipeline.counts();
  EXPECT_EQ(counts.dropped.of(DropReason::kInternalError), 0U) << rig.drops.back();
  EXPECT_EQ(counts.clouds_in, counts.clouds_labeled + counts.dropped.total());
  EXPECT_GT(counts.clouds_labeled, 850U);
}

}  // namespace
}  // namespace donex
