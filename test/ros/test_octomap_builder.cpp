// What moves hardly gets into a map of static echoes, and stays in one of all echoes.
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iostream>
#include <limits>
#include <set>
#include <vector>

#include <gtest/gtest.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <unistd.h>

#include "ros/explanation_clouds.h"
#include "ros/octomap_builder.h"
#include "ros/pipeline_rig.h"
#include "simulated_lidar/simulation_messages.h"
#include "simulation/simulator.h"

namespace donex {
namespace {

constexpr int kScans = 22;
constexpr int kWarmUp = 10;                                 // scans
constexpr OctomapBuilder::Options kCoarse{0.3, 20.0, 0.0};  // [m]
constexpr std::uint32_t kFirstMoving = 252, kClass = 0xFFFF;

/// A sensor at rest at an intersection, every scan of it in two maps.
class Maps {
 public:
  Maps() {
    simulation::SimulatorOptions options;
    options.beams = 32;
    simulation::Simulator simulator("intersection", options);
    Config config;
    config.motion.source = OdometrySource::kNone;
    tf2::BufferCore tf;
    Pipeline pipeline(config, tf, events());
    simulation::SimulatedScan scan;
    for (int i = 0; i < kScans && simulator.next(scan); ++i) {
      map_from_cloud_ = scan.odom_from_base * scan.base_from_sensor;
      if (i >= kWarmUp) rememberVoxels(scan);
      const auto cloud = toCloud(scan, {});
      if (i < kWarmUp) warm_up_until_ = cloud->header.stamp;
      pipeline.addCloud(cloud, scan.stamp);
      pipeline.step(scan.stamp);
    }
  }

  OctomapBuilder of_static{kCoarse}, of_all{kCoarse};

  /// Occupied voxels that a moving object hit and nothing that stands: who walks along a wall shares voxels with it.
  std::size_t ghostsIn(const OctomapBuilder& map) const {
    std::size_t ghosts = 0;
    for (const Voxel& voxel : moving_) {
      const Eigen::Vector3d center = (Eigen::Array3d(voxel[0], voxel[1], voxel[2]) + 0.5) * kCoarse.resolution;
      ghosts += standing_.count(voxel) == 0 && map.isOccupied(center) ? 1U : 0U;
    }
    return ghosts;
  }

 private:
  using Voxel = std::array<int, 3>;

  PipelineEvents events() {
    PipelineEvents events;
    events.labeled = [this](const LabeledScan& scan) { add(scan); };
    events.dropped = [](DropReason, const std::string& text) { ADD_FAILURE() << text; };
    events.refused = [](OdometryRefusal, const std::string&) {};
    events.forgotten = events.strange_times = [](const std::string&) {};
    return events;
  }
  void add(const LabeledScan& scan) {
    if (scan.cloud->header.stamp <= warm_up_until_) return;
    EXPECT_TRUE(of_static.add(*selectPart(*scan.cloud, scan.layout, scan.labels, CloudPart::kStatic), map_from_cloud_));
    EXPECT_TRUE(of_all.add(*scan.cloud, map_from_cloud_));
  }
  void rememberVoxels(const simulation::SimulatedScan& scan) {
    for (std::size_t i = 0; i < scan.echoes.size(); ++i) {
      const Eigen::Vector3d echo = scan.echoes[i].position.cast<double>();
      const bool moves = (scan.labels[i] & kClass) >= kFirstMoving;
      const Eigen::Array3d place = (map_from_cloud_ * echo).array();
      const bool is_above_ground = place.z() > 2.0 * kCoarse.resolution;
      if (!is_above_ground || echo.norm() >= kCoarse.max_range) continue;
      const Eigen::Array3i voxel = (place / kCoarse.resolution).floor().cast<int>();
      (moves ? moving_ : standing_).insert({voxel.x(), voxel.y(), voxel.z()});
    }
  }

  std::set<Voxel> moving_, standing_;
  Eigen::Isometry3d map_from_cloud_ = Eigen::Isometry3d::Identity();
  ros::Time warm_up_until_;
};

TEST(OctomapBuilder, MovingThingsHardlyGetIn) {
  const Maps maps;
  const std::size_t of_all = maps.ghostsIn(maps.of_all), of_static = maps.ghostsIn(maps.of_static);
  std::cout << "voxels that only moving objects hit, occupied in a map of all echoes: " << of_all
            << ", of static echoes: " << of_static << '\n';
  EXPECT_GT(of_all, 40U) << "a map of all echoes holds who came by";
  EXPECT_LT(10 * of_static, of_all);
  EXPECT_GT(maps.of_static.occupiedCells({})->width, 1000U) << "the street is there";
}

/// A street without an end, as a sensor sees it: walls on both sides, ground, a post every 8 m.
sensor_msgs::PointCloud2Ptr street(double at) {
  constexpr float kSide = 6.0F, kHeight = 3.0F, kAhead = 20.0F, kStep = 0.4F;
  std::vector<Eigen::Vector3f> echoes;
  for (float x = -kAhead; x < kAhead; x += kStep) {
    for (float z = -1.5F; z < kHeight; z += kStep) {
      echoes.emplace_back(x, -kSide, z);
      echoes.emplace_back(x, kSide, z);
    }
    for (float y = -kSide; y < kSide; y += 2.0F * kStep) echoes.emplace_back(x, y, -1.5F);
    const double post = std::fmod(at + static_cast<double>(x), 8.0);
    if (std::abs(post) < static_cast<double>(kStep)) echoes.emplace_back(x, 3.0F, 0.0F);
  }
  return cellCloud(echoes, {});
}

/// Memory that the process has resident [bytes].
double residentMemory() {
  std::ifstream statm("/proc/self/statm");
  double all = 0.0, resident = 0.0;
  statm >> all >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

struct Growth {
  std::size_t nodes_half_way, nodes;
  double bytes_half_way, bytes;
};

/// Drives along the street, a cloud every 2 m.
Growth driveOn(OctomapBuilder& map, int clouds) {
  Growth growth{};
  constexpr double kStep = 2.0;  // [m]
  for (int i = 0; i < clouds; ++i) {
    const double at = kStep * i;
    EXPECT_TRUE(map.add(*street(at), Eigen::Isometry3d(Eigen::Translation3d(at, 0.3, 1.8))));
    if (i == clouds / 2) growth.nodes_half_way = map.nodes(), growth.bytes_half_way = residentMemory();
  }
  growth.nodes = map.nodes(), growth.bytes = residentMemory();
  return growth;
}

TEST(OctomapBuilder, MemoryStaysFlatOnALongDrive) {
  constexpr int kClouds = 240;
  OctomapBuilder map({0.3, 20.0, 40.0});
  const Growth bounded = driveOn(map, kClouds);
  std::cout << "nodes " << bounded.nodes_half_way << " half-way, " << bounded.nodes << " in the end; resident memory "
            << bounded.bytes_half_way / 1e6 << " MB, " << bounded.bytes / 1e6 << " MB\n";
  EXPECT_LT(static_cast<double>(bounded.nodes), 1.05 * static_cast<double>(bounded.nodes_half_way));
  EXPECT_LT(bounded.bytes, 1.05 * bounded.bytes_half_way);
  const double end = 2.0 * (kClouds - 1);  // [m]
  const auto cells = map.occupiedCells({});
  float nearest = std::numeric_limits<float>::infinity();
  for (sensor_msgs::PointCloud2ConstIterator<float> x(*cells, "x"); x != x.end(); ++x) nearest = std::min(nearest, *x);
  EXPECT_GT(static_cast<double>(nearest), end - 40.0 - 2.0 * 4.8) << "a block of 4.8 m, and a block's way";
  EXPECT_LT(static_cast<double>(nearest), end - 30.0) << "what is near is kept";
  OctomapBuilder all({0.3, 20.0, 0.0});
  const Growth unbounded = driveOn(all, kClouds / 2);
  EXPECT_GT(static_cast<double>(unbounded.nodes), 1.5 * static_cast<double>(unbounded.nodes_half_way))
      << "then the bound says little";
}

/// Where a drive along the street begins [m]. The posts stand 8 m apart.
void expectSameMapAt(const Eigen::Vector3d& place) {
  OctomapBuilder here({0.25, 20.0, 40.0}), there({0.25, 20.0, 40.0});
  for (double at = -24.0; at < 24.0; at += 2.0) {
    const Eigen::Isometry3d pose(Eigen::Translation3d(at + 0.03, 0.31, 1.81));  // no echo on a border of leaves
    EXPECT_TRUE(here.add(*street(at), pose));
    EXPECT_TRUE(there.add(*street(at), Eigen::Translation3d(place) * pose));
  }
  EXPECT_EQ(there.nodes(), here.nodes());
  const auto cells = here.occupiedCells({});
  EXPECT_GT(cells->width, 1000U);
  std::size_t missing = 0;
  for (sensor_msgs::PointCloud2ConstIterator<float> x(*cells, "x"); x != x.end(); ++x) {
    missing += there.isOccupied(place + Eigen::Vector3f(x[0], x[1], x[2]).cast<double>()) ? 0U : 1U;
  }
  EXPECT_EQ(missing, 0U);
}

TEST(OctomapBuilder, TheMapIsTheSameFarFromTheOrigin) {
  expectSameMapAt({4096.0, 0.0, 0.0});             // the octree's origin follows on the way
  expectSameMapAt({16384.0, -16384.0, 0.0});       // beyond what its keys reach
  expectSameMapAt({499712.0, 5324800.0, 2048.0});  // UTM
}

TEST(OctomapBuilder, UnreadableCloudsAreRefused) {
  OctomapBuilder map({});
  EXPECT_FALSE(map.add(*test::CloudBuilder().field("x", test::PointField::FLOAT32).size(2).build(),
                       Eigen::Isometry3d::Identity()));
}

}  // namespace
}  // namespace donex
