// Clouds in the vehicle's frame: whether their sensor is found, and what is said where it is not.
#include <gtest/gtest.h>

#include "core/motion/surfaces.h"
#include "ros/origin_watch.h"
#include "ros/pipeline_rig.h"
#include "support/room_of_rings.h"

namespace donex {
namespace {

using sensor_msgs::PointField;

Eigen::Isometry3f at(float x, float y, float z) { return Eigen::Isometry3f(Eigen::Translation3f(x, y, z)); }

/// Follows the cloud of a sensor there, told in the vehicle's frame with its rings.
std::string followFrom(const Eigen::Isometry3f& mounting, OriginWatch& watch, const std::string& frame = "base_link") {
  const testing::RingedCloud seen = testing::ringsIn(testing::Room::kWithWalls, mounting);
  test::CloudBuilder builder;
  builder.frame(frame).xyz().field("ring", PointField::UINT16).size(static_cast<std::uint32_t>(seen.echoes.size()));
  for (std::size_t i = 0; i < seen.echoes.size(); ++i) builder.set(i, "ring", seen.rings[i]);
  const auto cloud = builder.build();
  return watch.follow(*cloud, std::get<CloudLayout>(judgeLayout(*cloud)), seen.echoes);
}

TEST(OriginWatch, FindsTheSensorOfTheThirdCloudThatAgrees) {
  OriginWatch watch;
  EXPECT_EQ(followFrom(at(1.0F, 0.0F, 1.8F), watch), "");
  EXPECT_EQ(followFrom(at(1.0F, 0.0F, 1.8F), watch), "");
  EXPECT_TRUE(watch.foundIn("base_link").isZero());
  EXPECT_NE(followFrom(at(1.0F, 0.0F, 1.8F), watch).find("rings meet at x 1.00, y"), std::string::npos);
  EXPECT_TRUE(watch.foundIn("base_link").isApprox(Eigen::Vector3d(1.0, 0.0, 1.8), 1e-3));
  EXPECT_TRUE(watch.foundIn("another").isZero());
  EXPECT_EQ(followFrom(at(1.0F, 0.0F, 1.8F), watch), "") << "once";
}

TEST(OriginWatch, ASensorAtTheVehiclesOriginIsNotStrange) {
  OriginWatch watch;
  for (int i = 0; i < 10; ++i) EXPECT_EQ(followFrom(at(0.1F, 0.0F, 0.1F), watch), "") << i;
  EXPECT_TRUE(watch.foundIn("base_link").isZero());
}

TEST(OriginWatch, SensorsThatTakeTurnsHaveNoPlace) {
  OriginWatch watch;
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(followFrom(i % 2 == 0 ? at(1.0F, 0.0F, 1.8F) : at(-1.0F, 0.5F, 1.8F), watch), "") << i;
  }
  EXPECT_TRUE(watch.foundIn("base_link").isZero());
}

TEST(OriginWatch, FollowsTheFirstFrameAlone) {
  OriginWatch watch;
  followFrom(at(1.0F, 0.0F, 1.8F), watch);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(followFrom(at(2.0F, 0.0F, 1.0F), watch, "another"), "") << i;
  EXPECT_TRUE(watch.foundIn("another").isZero());
}

TEST(OriginWatch, KnowsAnOriginThatLiesOnTheGround) {
  std::vector<Eigen::Vector3f> moved = testing::seenFrom(Eigen::Isometry3d::Identity(), testing::courtyard());
  EXPECT_FALSE(liesOnTheGround(moved)) << "as the sensor measured it";
  for (Eigen::Vector3f& echo : moved) echo.z() = echo.z() < 0.0F ? 0.01F : echo.z() + 1.7F;
  EXPECT_TRUE(liesOnTheGround(moved));
  EXPECT_FALSE(liesOnTheGround({}));
}

TEST(OriginWatch, AnOriginOnTheGroundIsSaidOnce) {
  std::vector<std::string> said;
  PipelineEvents events;
  events.labeled = [](const LabeledScan&) {};
  events.dropped = [](DropReason, const std::string& text) { ADD_FAILURE() << text; };
  events.refused = [](OdometryRefusal, const std::string& text) { ADD_FAILURE() << text; };
  events.forgotten = events.strange_times = [](const std::string&) {};
  events.strange_origin = [&](const std::string& text) { said.push_back(text); };
  tf2::BufferCore tf;
  Pipeline pipeline(test::smallConfig(), tf, events);
  auto echoes = testing::seenFrom(Eigen::Isometry3d::Identity(), testing::courtyard());
  for (Eigen::Vector3f& echo : echoes) echo.z() = echo.z() < 0.0F ? 0.01F : echo.z() + 1.7F;
  for (int i = 0; i < 12; ++i) {
    const double stamp = 100.0 + 0.1 * i;
    pipeline.addOdometry(test::odometryAt(stamp));
    pipeline.addCloud(test::plainCloud(echoes, stamp, "base_link"), stamp);
    pipeline.step(stamp);
  }
  ASSERT_EQ(said.size(), 1U);
  EXPECT_NE(said[0].find("origin_x"), std::string::npos) << said[0];
}

}  // namespace
}  // namespace donex
