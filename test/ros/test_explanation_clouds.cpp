// The clouds for the eye: layouts that rviz takes, and colours that say what the labels say.
#include <cstring>

#include <gtest/gtest.h>

#include "donex/ros/explanation_clouds.h"
#include "ros/pipeline_rig.h"

namespace donex {
namespace {

std::uint32_t numberAt(const sensor_msgs::PointCloud2& cloud, const std::string& name, std::size_t echo) {
  for (const auto& field : cloud.fields) {
    if (field.name != name) continue;
    std::uint32_t number = 0;
    const std::size_t bytes = field.datatype == sensor_msgs::PointField::UINT8 ? 1 : 4;
    std::memcpy(&number, &cloud.data.at(echo * cloud.point_step + field.offset), bytes);
    return number;
  }
  ADD_FAILURE() << "no field " << name;
  return 0;
}

TEST(ExplanationClouds, movingIsMagentaAndReasonsAreTold) {
  tf2::BufferCore tf;
  sensor_msgs::PointCloud2Ptr explained;
  PipelineEvents events;
  events.labeled = [&](const LabeledScan& scan) { explained = explainScan(scan); };
  events.dropped = [](DropReason, const std::string& text) { ADD_FAILURE() << text; };
  events.refused = [](OdometryRefusal, const std::string&) {};
  events.forgotten = events.strange_times = [](const std::string&) {};
  Config config = paperConfig(Method::kDonex3d);
  config.motion.source = OdometrySource::kNone;
  Pipeline pipeline(config, tf, events);
  pipeline.addCloud(test::plainCloud({{5.0F, 0.0F, 0.5F}}, 100.0), 100.0);
  pipeline.step(100.0);
  pipeline.addCloud(test::plainCloud({{5.0F, 0.0F, 0.5F}, {0.0F, 6.0F, 0.5F}, {90.0F, 0.0F, 0.0F}}, 100.1), 100.1);
  pipeline.step(100.1);
  ASSERT_TRUE(explained);
  ASSERT_TRUE(std::holds_alternative<CloudLayout>(judgeLayout(*explained)));
  EXPECT_EQ(explained->width, 3U);
  EXPECT_EQ(explained->header.frame_id, "lidar");
  const EchoReason wanted[] = {EchoReason::kSettled, EchoReason::kMoving, EchoReason::kOutside};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(numberAt(*explained, "reason", i), static_cast<std::uint32_t>(wanted[i]));
  }
  EXPECT_EQ(numberAt(*explained, "rgb", 1), 0xFF00FFU);
  const std::uint32_t grey = numberAt(*explained, "rgb", 0);
  EXPECT_EQ(grey & 0xFFU, grey >> 16U) << "a grey";
}

TEST(ExplanationClouds, cellsAreACloudEvenWithoutAny) {
  std_msgs::Header header;
  header.frame_id = "odom";
  for (const std::size_t count : {0U, 3U}) {
    const std::vector<Eigen::Vector3f> centers(count, {1.0F, 2.0F, 3.0F});
    const auto cloud = cellCloud(centers, header);
    const CloudLayout layout = std::get<CloudLayout>(judgeLayout(*cloud));
    std::vector<Eigen::Vector3f> back;
    parseEchoes(*cloud, layout, back);
    EXPECT_EQ(back, centers);
    EXPECT_EQ(cloud->header.frame_id, "odom");
  }
}

}  // namespace
}  // namespace donex
