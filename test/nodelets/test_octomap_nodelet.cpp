// donex/OctomapNodelet in this process: parameters that cannot be meant, and what must not keep clouds out of the map.
#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <nodelet/loader.h>
#include <ros/ros.h>

#include "ros/lost_transform.h"
#include "ros/manager_rig.h"
#include "ros/unserved_nodelet.h"

namespace donex {
namespace {

class OctomapNodeletTest : public testing::Test {
 protected:
  bool loadsWith(const std::string& parameter, double value) {
    const std::string node = "/static_map_" + std::to_string(++count_);
    ros::param::set(node + "/" + parameter, value);
    const bool loads = manager_.load(node, "donex/OctomapNodelet", {}, {});
    ros::param::del(node);
    return loads;
  }

  nodelet::Loader manager_{false};
  int count_ = 0;
};

TEST_F(OctomapNodeletTest, ParametersOutOfRangeAreRefused) {
  for (const double value : {0.0, -0.2, 0.001, 11.0, static_cast<double>(NAN)}) {
    EXPECT_FALSE(loadsWith("resolution", value)) << value;
  }
  for (const double value : {0.0, -40.0, 1e6}) EXPECT_FALSE(loadsWith("max_range", value)) << value;
  for (const double value : {-1.0, 0.5, static_cast<double>(NAN)}) EXPECT_FALSE(loadsWith("map_range", value)) << value;
  EXPECT_TRUE(loadsWith("map_range", 0.0)) << "nothing is forgotten";
  EXPECT_TRUE(loadsWith("resolution", 0.2)) << "then refusing says little";
  EXPECT_TRUE(loadsWith("max_range", 100.0));
}

/// A sensor at rest, its map, and who looks at it.
class MapRig {
 public:
  MapRig()
      : clouds_(nh_.advertise<sensor_msgs::PointCloud2>("clouds", 10)),
        cells_(nh_.subscribe("/map/cells", 1, &MapRig::onCells, this)),
        map_("/map", "donex/OctomapNodelet", {{"/points", clouds_.getTopic()}}) {}

  /// A cloud every 50 ms, until the map shows one. False where it never does.
  bool sendUntilMapped(const std::string& frame) {
    return test::waitFor([&] {
      clouds_.publish(test::plainCloud(test::ring(), ros::Time::now().toSec(), frame));
      return test::waitFor([this] { return is_mapped_; }, 0.05);
    });
  }

 private:
  void onCells(const sensor_msgs::PointCloud2ConstPtr& cells) { is_mapped_ = cells->width > 0; }

  ros::NodeHandle nh_;
  bool is_mapped_ = false;
  ros::Publisher clouds_;
  ros::Subscriber cells_;
  test::UnservedNodelet map_;
};

TEST(OctomapNodelet, MapsWithAManagerThatDropsCallbacks) {
  tf2_ros::StaticTransformBroadcaster transforms;
  transforms.sendTransform(test::transformAt(0.0, "odom", "lidar", 0.0, 1.7));
  MapRig rig;
  EXPECT_TRUE(rig.sendUntilMapped("lidar"));
}

TEST(OctomapNodelet, ALostLatchedTransformIsAskedForAgain) {
  const test::LostTransform mounting("odom", "lidar_on_the_roof");
  MapRig rig;
  EXPECT_TRUE(rig.sendUntilMapped("lidar_on_the_roof"));
  EXPECT_GE(mounting.subscribers(), 2);
}

}  // namespace
}  // namespace donex

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_octomap_nodelet");
  const ros::NodeHandle alive;
  return RUN_ALL_TESTS();
}
