// The clouds for the eye: layouts that rviz takes, and colours that say what the labels say.
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "ros/explanation_clouds.h"
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

/// A sensor at rest whose scans are explained, one after the other.
class Explainer {
 public:
  explicit Explainer(Config config) : config_(atRest(std::move(config))) {}

  sensor_msgs::PointCloud2Ptr explain(const std::vector<Eigen::Vector3f>& echoes) {
    explained_.reset();
    stamp_ += 0.1;
    pipeline_.addCloud(test::plainCloud(echoes, stamp_), stamp_);
    pipeline_.step(stamp_);
    return explained_;
  }

 private:
  static Config atRest(Config config) {
    config.motion.source = OdometrySource::kNone;
    return config;
  }
  PipelineEvents events() {
    PipelineEvents events;
    events.labeled = [this](const LabeledScan& scan) { explained_ = explainScan(scan); };
    events.dropped = [](DropReason, const std::string& text) { ADD_FAILURE() << text; };
    events.refused = [](OdometryRefusal, const std::string&) {};
    events.forgotten = events.strange_times = [](const std::string&) {};
    return events;
  }

  Config config_;
  double stamp_ = 100.0;  // [s]
  tf2::BufferCore tf_;
  sensor_msgs::PointCloud2Ptr explained_;
  Pipeline pipeline_{config_, tf_, events()};
};

EchoReason reasonAt(const sensor_msgs::PointCloud2& cloud, std::size_t echo) {
  return static_cast<EchoReason>(numberAt(cloud, "reason", echo));
}

struct Colour {
  std::uint32_t red, green, blue;

  bool isGrey() const { return red == green && green == blue; }
};

Colour colourAt(const sensor_msgs::PointCloud2& cloud, std::size_t echo) {
  const std::uint32_t rgb = numberAt(cloud, "rgb", echo);
  return {rgb >> 16U & 0xFFU, rgb >> 8U & 0xFFU, rgb & 0xFFU};
}

TEST(ExplanationClouds, MovingIsMagentaAndReasonsAreTold) {
  Explainer explainer(paperConfig(Method::kDonex3d));
  explainer.explain({{5.0F, 0.0F, 0.5F}});
  const auto explained = explainer.explain({{5.0F, 0.0F, 0.5F}, {0.0F, 6.0F, 0.5F}, {90.0F, 0.0F, 0.0F}});
  ASSERT_TRUE(explained);
  ASSERT_TRUE(std::holds_alternative<CloudLayout>(judgeLayout(*explained)));
  EXPECT_EQ(explained->width, 3U);
  EXPECT_EQ(explained->header.frame_id, "lidar");
  const EchoReason wanted[] = {EchoReason::kSettled, EchoReason::kMoving, EchoReason::kOutside};
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(reasonAt(*explained, i), wanted[i]) << i;
  EXPECT_EQ(numberAt(*explained, "rgb", 1), 0xFF00FFU);
  EXPECT_TRUE(colourAt(*explained, 0).isGrey());
}

constexpr std::size_t kRows = 13, kColumns = 81;

/// A wall 10 m in front of the sensor, row by row upwards.
std::vector<Eigen::Vector3f> wall() {
  constexpr float kDegree = 0.017453293F;
  std::vector<Eigen::Vector3f> echoes;
  for (std::size_t row = 0; row < kRows; ++row) {
    for (std::size_t column = 0; column < kColumns; ++column) {
      const float azimuth = kDegree * (0.5F * static_cast<float>(column) - 20.0F);
      const float elevation = kDegree * (static_cast<float>(row) - 6.0F);
      echoes.emplace_back(10.0F, 10.0F * std::tan(azimuth), 10.0F * std::tan(elevation));
    }
  }
  return echoes;
}

TEST(ExplanationClouds, EveryReasonForStaticHasAColour) {
  Config config = test::smallConfig();
  config.region.z_min = -2.0;
  config.evidence.ground = false;
  Explainer explainer(config);
  auto echoes = wall();
  for (int i = 0; i < 20; ++i) explainer.explain(echoes);
  const std::size_t alone = echoes.size(), unobserved = alone + 1, outside = alone + 2;
  echoes.insert(echoes.end(), {{5.0F, 0.03F, 0.03F}, {4.0F, -9.0F, 0.0F}, {90.0F, 0.0F, 0.0F}});
  const auto cloud = explainer.explain(echoes);
  ASSERT_TRUE(cloud);

  for (std::size_t row = 0; row < kRows; ++row) {
    const std::size_t echo = row * kColumns;
    ASSERT_EQ(reasonAt(*cloud, echo), EchoReason::kSettled) << row;
    const Colour colour = colourAt(*cloud, echo);
    EXPECT_TRUE(colour.isGrey()) << row;
    if (row != 0) {
      EXPECT_GT(colour.red, colourAt(*cloud, echo - kColumns).red) << "lighter than the row below, " << row;
    }
  }
  ASSERT_EQ(reasonAt(*cloud, alone), EchoReason::kNewAlone);
  EXPECT_EQ(numberAt(*cloud, "proof", alone), 0) << "no motion was proven";
  const Colour orange = colourAt(*cloud, alone);
  EXPECT_TRUE(orange.red > 200 && orange.green > 100 && orange.green < 180 && orange.blue < 50) << "orange";
  ASSERT_EQ(reasonAt(*cloud, unobserved), EchoReason::kUnobserved);
  const Colour blue = colourAt(*cloud, unobserved);
  EXPECT_TRUE(blue.blue > blue.red + 30 && blue.blue > blue.green + 30 && blue.blue < 128) << "dark blue";
  ASSERT_EQ(reasonAt(*cloud, outside), EchoReason::kOutside);
  const Colour black = colourAt(*cloud, outside);
  EXPECT_TRUE(black.isGrey() && black.red < 60) << "nearly black";
  EXPECT_LT(black.red, colourAt(*cloud, 0).red);
}

TEST(ExplanationClouds, CellsAreACloudEvenWithoutAny) {
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
