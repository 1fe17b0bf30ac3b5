// Clouds that are strange and labelled all the same: what is said of them, and how good the labels still are. The drive
// is the simulated street, as everybody's tools might have treated its clouds.
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>

#include <gtest/gtest.h>

#include "ros/pipeline_rig.h"
#include "simulated_lidar/simulation_messages.h"
#include "support/simulated_drive.h"

namespace donex {
namespace {

using simulation::SimulatedScan;

constexpr int kScans = 30;
constexpr int kWarmUp = 5;

/// What somebody did to a scan before it was sent; to its echoes and their labels alike.
using Treatment = std::function<void(SimulatedScan&)>;

class TreatedDrive {
 public:
  /// `frame`: the one that the clouds are told in, of the mounting that tf knows.
  enum class Frame { kSensor, kVehicle };

  explicit TreatedDrive(const Treatment& treat, const Config& config = {}, int beams = 32, Frame frame = Frame::kSensor)
      : pipeline_(config, tf_, events()) {
    simulation::SimulatorOptions options;
    options.duration = 0.1 * kScans;
    options.start_stamp = 10.0;
    options.distortion = true;
    options.beams = beams;
    simulation::Simulator simulator("street", options);
    Eigen::Isometry3d mounting = simulator.baseFromSensor();
    mounting.translate(-Eigen::Vector3d(config.cloud.origin_x, config.cloud.origin_y, config.cloud.origin_z));
    const Eigen::Isometry3f moved = frame == Frame::kVehicle ? mounting.cast<float>() : Eigen::Isometry3f::Identity();
    if (frame == Frame::kVehicle) mounting.setIdentity();
    tf_.setTransform(mountingOf(mounting, 1.0, {}), "test", true);
    while (simulator.next(scan_)) {
      treat(scan_);
      for (auto& echo : scan_.echoes) echo.position = moved * echo.position;
      for (const OdometrySample& sample : scan_.odometry) {
        pipeline_.addOdometry(*toOdometry(sample, {}));
      }
      pipeline_.addCloud(toCloud(scan_, {}), scan_.stamp);
      EXPECT_TRUE(pipeline_.step(scan_.stamp));
    }
  }

  const testing::Score& score() const { return score_; }
  const std::vector<std::string>& saidOfOrigin() const { return said_of_origin_; }
  std::string remark(CloudRemark kind) const { return remarkOf(pipeline_.remarks(), kind); }

 private:
  PipelineEvents events() {
    PipelineEvents events;
    events.labeled = [this](const LabeledScan& scan) {
      if (++judged_ > kWarmUp) score_.add({scan_.coreScan(), scan_.labels}, scan.labels);
    };
    events.dropped = [](DropReason, const std::string& text) { ADD_FAILURE() << text; };
    events.refused = [](OdometryRefusal, const std::string&) {};
    events.forgotten = events.strange_times = [](const std::string& text) { ADD_FAILURE() << text; };
    events.strange_origin = [this](const std::string& text) {
      said_of_origin_.push_back(text);
      judged_ = 0;  // the grid is forgotten
      score_ = {};
    };
    return events;
  }

  tf2::BufferCore tf_;
  SimulatedScan scan_;
  std::vector<std::string> said_of_origin_;
  testing::Score score_;
  int judged_ = 0;
  Pipeline pipeline_;
};

/// Keeps the echoes for which `is_kept` holds, with their labels.
void keep(SimulatedScan& scan, const std::function<bool(std::size_t)>& is_kept) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < scan.echoes.size(); ++i) {
    if (!is_kept(i)) continue;
    scan.echoes[kept] = scan.echoes[i];
    scan.labels[kept++] = scan.labels[i];
  }
  scan.echoes.resize(kept);
  scan.labels.resize(kept);
}

void addBeam(SimulatedScan& scan, const Eigen::Vector3f& end, float time) {
  scan.echoes.push_back({end, 0.0F, time, 0});
  scan.labels.push_back(50);
}

/// The beams above the horizon: they end at 120 m.
void writeNoReturnsAtTheEnd(SimulatedScan& scan) {
  for (int i = 0; i < 8000; ++i) {
    const float azimuth = 2.0F * static_cast<float>(M_PI) * static_cast<float>(i % 2000) / 2000.0F;
    const float elevation = 0.02F * static_cast<float>(i / 2000);
    const Eigen::Vector3f direction(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                    std::sin(elevation));
    addBeam(scan, 120.0F * direction, -0.1F + 0.1F * static_cast<float>(i % 2000) / 2000.0F);
  }
}

void tell(const testing::Score& score) {
  std::printf("precision %.3f, recall %.3f, IoU %.3f\n", score.precision(), score.recall(), score.iou());
}

TEST(StrangeClouds, NoReturnsAtOneLargestRange) {
  const TreatedDrive plain([](SimulatedScan&) {}), treated(writeNoReturnsAtTheEnd);
  EXPECT_EQ(plain.remark(CloudRemark::kNoReturns), "");
  EXPECT_NE(treated.remark(CloudRemark::kNoReturns).find("8000 echoes at one largest range, 120"), std::string::npos)
      << treated.remark(CloudRemark::kNoReturns);
  EXPECT_NEAR(treated.score().precision(), plain.score().precision(), 0.005);
  EXPECT_NEAR(treated.score().recall(), plain.score().recall(), 0.005);
}

TEST(StrangeClouds, NoReturnsAtTheOriginOfAMovedCloud) {
  Config config;
  config.cloud.origin_x = 1.0;
  config.cloud.origin_z = 1.7;
  const Eigen::Vector3f shift(1.0F, 0.0F, 1.7F);
  const auto move = [&](SimulatedScan& scan) {
    for (int i = 0; i < 8000; ++i) addBeam(scan, Eigen::Vector3f::Zero(), -0.1F + 0.0000125F * static_cast<float>(i));
    for (auto& echo : scan.echoes) echo.position += shift;
  };
  const TreatedDrive plain([](SimulatedScan&) {}), treated(move, config);
  EXPECT_NEAR(treated.score().precision(), plain.score().precision(), 0.02);
}

TEST(StrangeClouds, MovedIntoTheVehiclesFrameAreSeenFromWhereTheirRingsMeet) {
  const auto nothing = [](SimulatedScan&) {};
  const TreatedDrive plain(nothing), moved(nothing, {}, 32, TreatedDrive::Frame::kVehicle);
  EXPECT_TRUE(plain.saidOfOrigin().empty());
  ASSERT_EQ(moved.saidOfOrigin().size(), 1U);
  EXPECT_NE(moved.saidOfOrigin()[0].find("rings meet at"), std::string::npos) << moved.saidOfOrigin()[0];
  tell(plain.score());
  tell(moved.score());
  EXPECT_NEAR(moved.score().precision(), plain.score().precision(), 0.01);
  EXPECT_NEAR(moved.score().recall(), plain.score().recall(), 0.02);
}

TEST(StrangeClouds, MovedWithNoReturnsAreSeenFromWhereTheirRingsMeet) {
  const auto add_no_returns = [](SimulatedScan& scan) {
    for (int i = 0; i < 8000; ++i) addBeam(scan, Eigen::Vector3f::Zero(), -0.1F + 0.0000125F * static_cast<float>(i));
  };
  const TreatedDrive moved(add_no_returns, {}, 32, TreatedDrive::Frame::kVehicle);
  ASSERT_EQ(moved.saidOfOrigin().size(), 1U);
  tell(moved.score());
  EXPECT_GT(moved.score().precision(), 0.95);
}

TEST(StrangeClouds, ARegionBesideEverything) {
  Config config;
  config.region.z_min = -9.0;
  config.region.z_max = -5.0;
  const TreatedDrive drive([](SimulatedScan&) {}, config);
  const std::string text = drive.remark(CloudRemark::kRegionMissed);
  EXPECT_NE(text.find("0.0 % of the echoes lie in the region"), std::string::npos) << text;
  EXPECT_NE(text.find("z -9.0 to -5.0"), std::string::npos) << text;
  EXPECT_EQ(text.find("metres?"), std::string::npos) << text;
}

TEST(StrangeClouds, Millimetres) {
  const TreatedDrive drive([](SimulatedScan& scan) {
    for (auto& echo : scan.echoes) echo.position *= 1000.0F;
  });
  const std::string text = drive.remark(CloudRemark::kRegionMissed);
  EXPECT_NE(text.find("are the clouds in metres?"), std::string::npos) << text;
}

/// SemanticKITTI's classes of the ground: road to other ground, and terrain.
bool isGround(std::uint32_t label) {
  const std::uint32_t kind = label & 0xFFFFU;
  return (kind >= 40 && kind <= 49) || kind == 60 || kind == 72;
}

TEST(StrangeClouds, GroundRemovedUpstream) {
  constexpr int kBeams = 64;
  const TreatedDrive plain([](SimulatedScan&) {}, {}, kBeams);
  const TreatedDrive removed(
      [](SimulatedScan& scan) { keep(scan, [&](std::size_t i) { return !isGround(scan.labels[i]); }); }, {}, kBeams);
  EXPECT_EQ(plain.remark(CloudRemark::kNoGround), "");
  EXPECT_NE(removed.remark(CloudRemark::kNoGround), "");
  tell(plain.score());
  tell(removed.score());
  EXPECT_GE(removed.score().recall(), 0.95) << plain.score().recall() << " with the ground";
  EXPECT_GE(removed.score().precision(), plain.score().precision() - 0.02);
}

/// As pcl's VoxelGrid thins a cloud: the mean of each voxel's echoes. The label is that of one of them.
void thin(SimulatedScan& scan) {
  constexpr float kLeaf = 0.2F;  // [m]
  struct Voxel {
    std::size_t first = 0;
    int count = 0;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  };
  std::map<std::array<int, 3>, Voxel> voxels;
  for (std::size_t i = 0; i < scan.echoes.size(); ++i) {
    const Eigen::Vector3f& position = scan.echoes[i].position;
    const Eigen::Array3i key = (position.array() / kLeaf).floor().cast<int>();
    Voxel& voxel = voxels[{key.x(), key.y(), key.z()}];
    if (voxel.count++ == 0) voxel.first = i;
    voxel.sum += position;
  }
  std::vector<std::uint8_t> is_first(scan.echoes.size(), 0);
  for (const auto& entry : voxels) {
    const Voxel& voxel = entry.second;
    is_first[voxel.first] = 1;
    scan.echoes[voxel.first].position = voxel.sum / static_cast<float>(voxel.count);
  }
  keep(scan, [&](std::size_t i) { return is_first[i] != 0; });
}

TEST(StrangeClouds, VoxelFilterUpstream) {
  const TreatedDrive thinned(thin);
  tell(thinned.score());
  EXPECT_GE(thinned.score().precision(), 0.93) << "the limit that the documents state";
  EXPECT_GE(thinned.score().recall(), 0.88);
}

}  // namespace
}  // namespace donex
