// Livox' CustomMsg: every number arrives where it belongs, and bytes that are no such message are refused.
#include <cstring>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "ros/livox_message.h"
#include "ros/pipeline_rig.h"

namespace donex {
namespace {

using sensor_msgs::PointField;
using test::LivoxPoint;
using test::PipelineRig;

sensor_msgs::PointCloud2Ptr cloudOf(const std::vector<std::uint8_t>& bytes) {
  return livoxCloud(bytes.data(), bytes.size());
}

template <class Number>
Number at(const sensor_msgs::PointCloud2& cloud, std::size_t point, const std::string& name, std::uint8_t datatype) {
  for (const PointField& field : cloud.fields) {
    if (field.name != name) continue;
    EXPECT_EQ(field.datatype, datatype) << name;
    Number number{};
    std::memcpy(&number, cloud.data.data() + point * cloud.point_step + field.offset, sizeof number);
    return number;
  }
  ADD_FAILURE() << "no field " << name;
  return {};
}

TEST(LivoxCloud, HasEveryNumberOfTheMessage) {
  const std::vector<LivoxPoint> points{{0, {1.5F, -2.25F, 0.5F}, 255, 16, 3}, {99000000, {-7.0F, 8.0F, 9.0F}, 0, 1, 5}};
  const auto cloud = cloudOf(test::livoxBytes(points, 123.456789, "livox_frame"));
  EXPECT_EQ(cloud->header.frame_id, "livox_frame");
  EXPECT_EQ(cloud->header.stamp, ros::Time(123.456789));
  ASSERT_EQ(cloud->width, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(at<float>(*cloud, i, "x", PointField::FLOAT32), points[i].position.x());
    EXPECT_EQ(at<float>(*cloud, i, "y", PointField::FLOAT32), points[i].position.y());
    EXPECT_EQ(at<float>(*cloud, i, "z", PointField::FLOAT32), points[i].position.z());
    EXPECT_EQ(at<float>(*cloud, i, "intensity", PointField::FLOAT32), static_cast<float>(points[i].reflectivity));
    EXPECT_EQ(at<std::uint8_t>(*cloud, i, "tag", PointField::UINT8), points[i].tag);
    EXPECT_EQ(at<std::uint8_t>(*cloud, i, "line", PointField::UINT8), points[i].line);
    EXPECT_EQ(at<std::uint32_t>(*cloud, i, "offset_time", PointField::UINT32), points[i].offset_time);
  }
}

TEST(LivoxCloud, IsLabelledByItsOwnTimes) {
  PipelineRig rig;
  for (int i = 0; i < 40; ++i) rig.odometry(99.0 + 0.05 * i, 10.0);
  const std::vector<LivoxPoint> points{{0, {8.0F, 4.0F, 0.5F}, 1, 2, 3}, {100000000, {7.0F, 4.0F, 0.5F}, 1, 2, 3}};
  rig.pipeline.addCloud(cloudOf(test::livoxBytes(points, 100.0)), 100.0);
  rig.run(100.2);
  ASSERT_EQ(rig.labeled.size(), 1U) << (rig.drops.empty() ? "" : rig.drops[0]);
  EXPECT_LT((rig.labeled[0].echoes[1] - rig.labeled[0].echoes[0]).norm(), 1e-3F) << "1 m on the way, in 0.1 s";
  EXPECT_NEAR(rig.labeled[0].last_echo, 100.1, 1e-6) << "of what the latency is told";
  EXPECT_EQ(rig.labeled[0].published->fields.size(), 9U);
  EXPECT_EQ(rig.labeled[0].published->fields.back().name, "observed");
}

TEST(LivoxCloud, WithoutPointsIsACloudAsWell) {
  PipelineRig rig;
  rig.odometry(100.0);
  rig.pipeline.addCloud(cloudOf(test::livoxBytes({}, 100.0)), 100.0);
  rig.run(100.0);
  EXPECT_EQ(rig.labeled.size(), 1U);
}

TEST(LivoxCloud, CutOffAnywhereIsRefused) {
  const auto bytes = test::livoxBytes(test::livoxPoints(test::ring(5)), 100.0);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    // A vector of its own: a sanitizer sees whoever reads behind its end.
    const std::vector<std::uint8_t> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_THROW(cloudOf(cut), std::exception) << size;
  }
}

TEST(LivoxCloud, BytesLeftAreRefused) {
  auto bytes = test::livoxBytes(test::livoxPoints(test::ring(5)), 100.0);
  bytes.push_back(0);
  EXPECT_THROW(cloudOf(bytes), std::invalid_argument);
}

TEST(LivoxCloud, LengthsThatLieAreRefusedWithoutRoomForThem) {
  const auto sound = test::livoxBytes(test::livoxPoints(test::ring(5)), 100.0);
  constexpr std::size_t kFrameLength = 12, kFrame = 5, kPointsLength = 16 + kFrame + 16;
  for (const std::size_t place : {kFrameLength, kPointsLength}) {
    for (const std::uint32_t lie : {6U, 0x7FFFFFFFU, 0x0D79435FU, 0xFFFFFFFFU}) {
      auto bytes = sound;
      std::memcpy(bytes.data() + place, &lie, sizeof lie);
      EXPECT_THROW(cloudOf(bytes), std::exception) << place << ": " << lie;
    }
  }
}

TEST(LivoxCloud, WhateverTheNumbersEveryCloudIsAccountedFor) {
  std::mt19937 random(3);
  PipelineRig rig;
  for (int i = 0; i < 400; ++i) rig.odometry(99.0 + 0.1 * i);
  const auto sound = test::livoxBytes(test::livoxPoints(test::ring(20)), 100.0);
  constexpr std::size_t kPoints = 41;  // behind header and lengths
  for (int i = 0; i < 300; ++i) {
    auto bytes = sound;
    for (std::size_t k = kPoints; k < bytes.size(); ++k) bytes[k] = static_cast<std::uint8_t>(random());
    const auto cloud = cloudOf(bytes);
    cloud->header.stamp = ros::Time(100.0 + 0.1 * i);
    rig.pipeline.addCloud(cloud, 100.0 + 0.1 * i);
    rig.run(100.0 + 0.1 * i);
  }
  rig.pipeline.finish();
  const auto& counts = rig.pipeline.counts();
  EXPECT_EQ(counts.clouds_labeled + counts.dropped.total(), 300U);
  EXPECT_EQ(counts.dropped.of(DropReason::kInternalError), 0U) << rig.drops.back();
}

TEST(LivoxCloud, OfBothDriversAndOfNoOtherDefinition) {
  EXPECT_TRUE(isLivox("livox_ros_driver/CustomMsg", kLivoxMd5));
  EXPECT_TRUE(isLivox("livox_ros_driver2/CustomMsg", kLivoxMd5));
  EXPECT_FALSE(isLivox("livox_ros_driver2/CustomMsg", "0123456789abcdef0123456789abcdef"));
  EXPECT_FALSE(isLivox("somebody/CustomMsg", kLivoxMd5));
}

}  // namespace
}  // namespace donex
