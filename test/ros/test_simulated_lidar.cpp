// The simulated LiDAR as a node, and as a nodelet before the classifier.
#include <algorithm>

#include <tf2_ros/transform_listener.h>

#include "ros/conversions.h"
#include "ros/manager_rig.h"
#include "simulated_lidar/simulated_lidar.h"
#include "simulated_lidar/simulation_messages.h"

namespace donex {
namespace {

using test::waitFor;

class SimulatedLidarTest : public testing::Test {
 protected:
  SimulatedLidarTest() : nh_("/simulation"), pnh_("/simulation/lidar") {
    ros::param::del(pnh_.getNamespace());
    pnh_.setParam("scene", "bend");
    pnh_.setParam("beams", 16);
    clouds_ = nh_.subscribe("points", 100, &SimulatedLidarTest::onCloud, this);
    odometry_ = nh_.subscribe("odom", 5000, &SimulatedLidarTest::onOdometry, this);
  }

  void onCloud(const sensor_msgs::PointCloud2ConstPtr& cloud) {
    EXPECT_GE(ros::WallTime::now().toSec(), cloud->header.stamp.toSec() - 1e-3) << "sent before it was measured";
    received_.push_back(cloud);
    bytes_.push_back(cloud->data);
  }
  void onOdometry(const nav_msgs::OdometryConstPtr& odometry) { samples_.push_back(odometry); }

  /// Every fault is in the one message.
  void expectRefused(const std::vector<std::string>& parts) {
    try {
      const SimulatedLidar lidar(nh_, pnh_);
      FAIL() << "no complaint about " << parts.front();
    } catch (const std::invalid_argument& error) {
      for (const std::string& part : parts) {
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << part << " is not in: " << error.what();
      }
    }
  }

  ros::NodeHandle nh_, pnh_;
  ros::Subscriber clouds_, odometry_;
  std::vector<sensor_msgs::PointCloud2ConstPtr> received_;
  std::vector<std::vector<std::uint8_t>> bytes_;  // when it was received
  std::vector<nav_msgs::OdometryConstPtr> samples_;
};

TEST_F(SimulatedLidarTest, SendsCloudsAndOdometryInTheirOwnRhythms) {
  const SimulatedLidar lidar(nh_, pnh_);
  ASSERT_TRUE(waitFor([this] { return received_.size() >= 12 && samples_.size() >= 60; }));
  for (std::size_t i = 1; i < received_.size(); ++i) {
    EXPECT_NEAR((received_[i]->header.stamp - received_[i - 1]->header.stamp).toSec(), 0.1, 1e-5);
  }
  for (std::size_t i = 1; i < samples_.size(); ++i) {
    EXPECT_NEAR((samples_[i]->header.stamp - samples_[i - 1]->header.stamp).toSec(), 0.02, 1e-5);
  }
  EXPECT_EQ(received_.front()->header.frame_id, "velodyne");
  EXPECT_EQ(samples_.front()->header.frame_id, "odom");
  EXPECT_EQ(samples_.front()->child_frame_id, "base_link");
  for (std::size_t i = 0; i < received_.size(); ++i) {
    EXPECT_EQ(received_[i]->data, bytes_[i]) << "touched after it was sent";
  }
}

TEST_F(SimulatedLidarTest, TellsTheMountingAndTheMotionByTf) {
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  const SimulatedLidar lidar(nh_, pnh_);
  ASSERT_TRUE(waitFor([&] { return buffer.canTransform("base_link", "velodyne", ros::Time(0)); }));
  ASSERT_TRUE(waitFor([&] { return buffer.canTransform("odom", "velodyne", ros::Time(0)); }));
  EXPECT_NEAR(buffer.lookupTransform("base_link", "velodyne", ros::Time(0)).transform.translation.z, 1.73, 1e-6);
}

TEST_F(SimulatedLidarTest, SendsThePartsOfARigOnOneTopic) {
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  pnh_.setParam("rig", "front_rear");
  pnh_.setParam("parts", 4);
  pnh_.setParam("distortion", true);
  const SimulatedLidar lidar(nh_, pnh_);
  ASSERT_TRUE(waitFor([this] { return received_.size() >= 40; }));
  for (std::size_t i = 0; i + 1 < received_.size(); i += 2) {
    EXPECT_EQ(received_[i]->header.frame_id, "front");
    EXPECT_EQ(received_[i + 1]->header.frame_id, "rear");
    EXPECT_EQ(received_[i]->header.stamp, received_[i + 1]->header.stamp);
    const auto& before = received_[i < 2 ? 0 : i - 2];
    EXPECT_NEAR((received_[i]->header.stamp - before->header.stamp).toSec(), i < 2 ? 0.0 : 0.025, 1e-5);
  }
  for (const char* frame : {"front", "rear"}) {
    EXPECT_TRUE(waitFor([&] { return buffer.canTransform("odom", frame, ros::Time(0)); })) << frame;
  }
}

TEST_F(SimulatedLidarTest, TellsTheMountingAgainToWhomTheLatchedMessagePassedBy) {
  std::size_t told = 0;
  const boost::function<void(const tf2_msgs::TFMessageConstPtr&)> count = [&](const auto& message) {
    ASSERT_EQ(message->transforms.size(), 1U);
    EXPECT_EQ(message->transforms[0].child_frame_id, "velodyne");
    ++told;
  };
  const ros::Subscriber subscriber = nh_.subscribe<tf2_msgs::TFMessage>("/tf_static", 10, count);
  const SimulatedLidar lidar(nh_, pnh_);
  EXPECT_TRUE(waitFor([&] { return told >= 3; })) << told;
}

TEST_F(SimulatedLidarTest, EndsWithItsDuration) {
  pnh_.setParam("duration", 0.5);
  const SimulatedLidar lidar(nh_, pnh_);
  ASSERT_TRUE(waitFor([this] { return received_.size() == 5; }));
  const double last = received_.back()->header.stamp.toSec();
  EXPECT_TRUE(waitFor([last] { return ros::WallTime::now().toSec() > last + 0.5; }));
  EXPECT_EQ(received_.size(), 5U);
}

TEST_F(SimulatedLidarTest, MayEndAtAnyMoment) {
  for (int i = 0; i < 3; ++i) {
    const std::size_t before = received_.size();
    const auto lidar = std::make_unique<SimulatedLidar>(nh_, pnh_);
    ASSERT_TRUE(i == 0 || waitFor([&] { return received_.size() > before; }));
  }
}

TEST_F(SimulatedLidarTest, NamesEveryFaultOfItsParameters) {
  pnh_.setParam("scene", "strret");
  pnh_.setParam("beams", 17);
  pnh_.setParam("dropout", "much");
  pnh_.setParam("range_nois", 0.1);
  pnh_.setParam("odometry_rate", 0);
  pnh_.setParam("rig", "front_back");
  pnh_.setParam("parts", 0);
  expectRefused({"strret", "empty_room", "beams", "17", "dropout", "a number", "range_nois", "odometry_rate",
                 "front_back", "roof_bumper", "parts is 0"});
}

TEST_F(SimulatedLidarTest, OnlyASingleSensorsFrameCanBeNamed) {
  pnh_.setParam("sensor_frame", "lidar");
  pnh_.setParam("rig", "roof_bumper");
  expectRefused({"sensor_frame is for a single sensor"});
}

/// In one manager with the classifier, which gets the very messages that were published.
TEST_F(SimulatedLidarTest, FeedsTheClassifierInOneManager) {
  nodelet::Loader manager(false);
  const std::string space = nh_.getNamespace();
  ros::param::del(space + "/donex");
  std::vector<sensor_msgs::PointCloud2ConstPtr> labeled;
  const boost::function<void(const sensor_msgs::PointCloud2ConstPtr&)> keep =
      [&](const sensor_msgs::PointCloud2ConstPtr& cloud) { labeled.push_back(cloud); };
  const ros::Subscriber subscriber = nh_.subscribe<sensor_msgs::PointCloud2>("donex/labeled_points", 100, keep);
  ASSERT_TRUE(manager.load(space + "/donex", "donex/DonexNodelet", {}, {}));
  ASSERT_TRUE(manager.load(pnh_.getNamespace(), "donex/SimulatedLidarNodelet", {}, {}));
  ASSERT_TRUE(waitFor([&] { return labeled.size() >= 5; }));
  const auto has = [&](const std::string& name) {
    const auto& fields = labeled.back()->fields;
    return std::any_of(fields.begin(), fields.end(), [&](const auto& field) { return field.name == name; });
  };
  for (const char* name : {"x", "time", "ring", "label", "dynamic", "observed"}) EXPECT_TRUE(has(name)) << name;
  manager.clear();
}

}  // namespace
}  // namespace donex

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_simulated_lidar");
  const ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
