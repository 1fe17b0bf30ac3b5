// The plain node, over TCP, with the parameters of config/default.yaml; and what it says of bad ones.
#include <array>
#include <cstdio>

#include <gtest/gtest.h>

#include "ros/manager_rig.h"

namespace donex {
namespace {

using test::waitFor;

TEST(Node, LabelsOverTheNetwork) {
  ros::NodeHandle nh;
  auto clouds = nh.advertise<sensor_msgs::PointCloud2>("points", 10);
  auto odometry = nh.advertise<nav_msgs::Odometry>("odom", 10);
  tf2_ros::StaticTransformBroadcaster transforms;
  transforms.sendTransform(test::transformAt(0.0, "base_link", "lidar", 0.0, 1.7));
  std::vector<sensor_msgs::PointCloud2ConstPtr> received;
  const boost::function<void(const sensor_msgs::PointCloud2ConstPtr&)> take = [&](const auto& cloud) {
    received.push_back(cloud);
  };
  const auto labeled = nh.subscribe<sensor_msgs::PointCloud2>("donex/labeled_points", 10, take);
  ASSERT_TRUE(waitFor([&] {
    return clouds.getNumSubscribers() == 1 && odometry.getNumSubscribers() == 1 && labeled.getNumPublishers() == 1;
  }));
  for (std::size_t i = 0; i < 10; ++i) {
    const double stamp = 100.0 + 0.1 * static_cast<double>(i);
    const auto cloud = test::plainCloud(test::ring(), stamp);
    odometry.publish(test::odometryAt(stamp));
    clouds.publish(cloud);
    ASSERT_TRUE(waitFor([&] { return received.size() == i + 1; }));
    EXPECT_EQ(received[i]->header.stamp, cloud->header.stamp);
    EXPECT_EQ(received[i]->width, cloud->width);
  }
}

struct Outcome {
  int status;
  std::string output;
};

Outcome run(const std::string& command) {
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::string output;
  std::array<char, 256> buffer{};
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) output += buffer.data();
  return {pclose(pipe), output};
}

TEST(Node, BadParametersEndItWithAllFaultsInOneMessage) {
  const auto outcome = run(std::string(DONEX_NODE) + " __name:=faulty _voxel_size:=9.5 _metod:=donex_3d _deskew:=2");
  EXPECT_EQ(WEXITSTATUS(outcome.status), 1) << outcome.output;
  for (const char* words : {"voxel_size is 9.5", "'metod'", "deskew is an integer"}) {
    EXPECT_NE(outcome.output.find(words), std::string::npos) << outcome.output;
  }
}

}  // namespace
}  // namespace donex

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "node_test");
  ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
