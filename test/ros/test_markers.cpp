// Marker arrays that rviz takes without an error, and that leave nothing stale behind.
#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include "ros/markers.h"

namespace donex {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

/// Shows what it is told.
class FakeDetector : public Detector {
 public:
  void process(const Scan&, EchoLabels&) override {}
  void reset() override {}
  const std::vector<Object>& objects() const override { return objects_; }
  std::vector<Eigen::Vector3f> dynamicCells() const override { return cells_; }
  GridOutline outline() const override { return outline_; }
  std::size_t memoryBytes() const override { return 0; }

  std::vector<Object> objects_;
  std::vector<Eigen::Vector3f> cells_;
  GridOutline outline_;
};

Object objectOf(std::uint32_t id, double speed) {
  Object object;
  object.id = id;
  object.size = {4.0, 2.0, 0.0};
  object.velocity.x() = speed;
  object.dynamic = true;
  return object;
}

/// What rviz would show, after checking what it would complain about.
class Screen {
 public:
  void take(const MarkerArray& array) {
    std::set<std::pair<std::string, int>> seen;
    for (const Marker& marker : array.markers) {
      const auto key = std::make_pair(marker.ns, marker.id);
      EXPECT_TRUE(seen.insert(key).second) << marker.ns << " twice";
      EXPECT_EQ(marker.header.frame_id, "odom");
      if (marker.action == Marker::DELETE) {
        shown.erase(key);
        continue;
      }
      ASSERT_EQ(marker.action, Marker::ADD);
      EXPECT_NE(marker.pose.orientation.w, 0.0);
      EXPECT_GT(marker.scale.x, 0.0);
      const bool is_list = marker.type == Marker::CUBE_LIST || marker.type == Marker::LINE_LIST;
      EXPECT_EQ(is_list && marker.points.empty(), false) << marker.ns;
      EXPECT_EQ(marker.type == Marker::CUBE && marker.scale.z <= 0.0, false) << marker.ns;
      shown[key] = marker;
    }
  }
  std::set<std::string> namespaces() const {
    std::set<std::string> all;
    for (const auto& [key, marker] : shown) all.insert(key.first);
    return all;
  }

  std::map<std::pair<std::string, int>, Marker> shown;
};

class Markers : public testing::Test {
 protected:
  void SetUp() override {
    detector_.outline_.max_corner = {10.0, 20.0, 3.0};
    detector_.objects_ = {objectOf(4, 3.0), objectOf(7, 0.0)};
    detector_.cells_ = {{1.0F, 2.0F, 3.0F}, {4.0F, 5.0F, 6.0F}};
  }
  void show() { screen_.take(*maker_.make(detector_, config_, ros::Time(100.0), "odom", odom_from_world_)); }

  FakeDetector detector_;
  Config config_;
  Eigen::Isometry3d odom_from_world_ = Eigen::Isometry3d::Identity();
  MarkerMaker maker_;
  Screen screen_;
};

TEST_F(Markers, ShowEverything) {
  show();
  EXPECT_EQ(screen_.namespaces(), (std::set<std::string>{"dynamic_cells", "grid", "objects", "speeds", "velocities"}));
  const Marker& cells = screen_.shown.at({"dynamic_cells", 0});
  EXPECT_EQ(cells.type, Marker::CUBE_LIST);
  EXPECT_EQ(cells.points.size(), 2U);
  EXPECT_EQ(cells.scale.x, config_.voxel_size);
  EXPECT_EQ(screen_.shown.count({"objects", 7}), 1U);
  EXPECT_EQ(screen_.shown.count({"velocities", 7}), 0U) << "an arrow without a direction";
}

TEST_F(Markers, LieWhereTheOdometryHasTheVehicle) {
  odom_from_world_ = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY());
  odom_from_world_.pretranslate(Eigen::Vector3d(0.0, 0.0, 2.0));
  show();
  const auto placed = [&](const char* name_space, int id) {
    Eigen::Isometry3d odom_from_marker;
    tf2::fromMsg(screen_.shown.at({name_space, id}).pose, odom_from_marker);
    return odom_from_marker;
  };
  EXPECT_TRUE(placed("objects", 4).isApprox(odom_from_world_ * detector_.objects_[0].odom_from_box, 1e-12));
  for (const char* list : {"dynamic_cells", "grid"}) EXPECT_TRUE(placed(list, 0).isApprox(odom_from_world_, 1e-12));
  EXPECT_TRUE(placed("velocities", 4).isApprox(odom_from_world_, 1e-12)) << "from point to point";
}

TEST_F(Markers, SpeedsAreWrittenAboveTheBoxes) {
  detector_.objects_ = {objectOf(3, 8.34)};
  show();
  const Marker& speed = screen_.shown.at({"speeds", 3});
  EXPECT_EQ(speed.text, "8.3 m/s");
  EXPECT_GT(speed.pose.position.z, 0.5);
}

TEST_F(Markers, TheGridHasTwelveEdgesAlongItsAxes) {
  show();
  const auto& points = screen_.shown.at({"grid", 0}).points;
  ASSERT_EQ(points.size(), 24U);
  double length = 0.0;
  for (std::size_t i = 0; i < points.size(); i += 2) {
    const Eigen::Vector3d edge(points[i + 1].x - points[i].x, points[i + 1].y - points[i].y,
                               points[i + 1].z - points[i].z);
    EXPECT_EQ((edge.array() != 0.0).count(), 1);
    length += edge.norm();
  }
  EXPECT_DOUBLE_EQ(length, 4 * (10.0 + 20.0 + 3.0));
}

TEST_F(Markers, NothingStaleStays) {
  show();
  detector_.cells_.clear();
  detector_.objects_ = {objectOf(9, 2.0)};
  show();
  EXPECT_EQ(screen_.namespaces(), (std::set<std::string>{"grid", "objects", "speeds", "velocities"}));
  EXPECT_EQ(screen_.shown.count({"objects", 4}), 0U);
  EXPECT_EQ(screen_.shown.count({"objects", 9}), 1U);
  detector_.objects_.clear();
  show();
  EXPECT_EQ(screen_.namespaces(), std::set<std::string>{"grid"});
}

TEST_F(Markers, SwitchesTakeTheirPartAway) {
  show();
  config_.node.marker_cells = false;
  show();
  EXPECT_EQ(screen_.namespaces().count("dynamic_cells"), 0U);
  config_.node.marker_objects = false;
  show();
  EXPECT_EQ(screen_.namespaces(), std::set<std::string>{"grid"});
  config_.node.marker_grid = false;
  show();
  EXPECT_TRUE(screen_.shown.empty());
  config_ = {};
  show();
  config_.node.markers = false;
  show();
  EXPECT_TRUE(screen_.shown.empty());
}

TEST_F(Markers, ClearTakesAllAwayAndOnce) {
  show();
  screen_.take(*maker_.clear());
  EXPECT_TRUE(screen_.shown.empty());
  EXPECT_TRUE(maker_.clear()->markers.empty());
}

}  // namespace
}  // namespace donex
