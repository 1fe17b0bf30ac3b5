// What can go wrong with the ego motion itself: it jumps, nobody fills it in, the clouds do not tell it.
#include <nav_msgs/Odometry.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include "core/motion/surfaces.h"
#include "ros/faults_rig.h"

namespace donex {
namespace {

using test::FaultsTest;
using test::waitFor;

constexpr double kSpeed = 5.0;  // [m/s]

class FaultsOfMotion : public FaultsTest {
 protected:
  /// What a sensor sees that has driven through a courtyard since the beginning.
  sensor_msgs::PointCloud2Ptr courtyardNow() const {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation().x() = kSpeed * (now_ - kBegin);
    return test::plainCloud(testing::seenFrom(pose, testing::courtyard()), now_);
  }
  void sendCourtyard() {
    ++clouds_sent_;
    clouds_.publish(courtyardNow());
  }
};

TEST_F(FaultsOfMotion, OdometryJumps) {
  load();
  driveWell();
  for (int scan = 0; scan < 10; ++scan) {
    advance();
    auto odometry = boost::make_shared<nav_msgs::Odometry>(test::odometryAt(now_));
    odometry->pose.pose.position.y = 0.5;
    odometry_.publish(odometry);
    sendCloud(now_);
  }
  ASSERT_TRUE(waitForLabeled(kGood + 10)) << status_;
  ASSERT_TRUE(waitForDiagnostic("odometry jumps", "1"));
  conclude("odometry jumps by 0.5 m: `odometry jumps` counts it, the grid is forgotten", "every scan labelled");
}

TEST_F(FaultsOfMotion, NobodyFillsInThePose) {
  load();
  for (int scan = 0; scan < 20; ++scan) {
    advance();
    auto odometry = boost::make_shared<nav_msgs::Odometry>(test::odometryAt(now_));
    odometry->twist.twist.linear.x = 10.0;
    odometry_.publish(odometry);
    sendCloud(now_);
  }
  for (int wait = 0; wait < 8; ++wait) advance();
  ASSERT_TRUE(waitFor([&] { return count("odometry refused: pose stands still, twist does not") > 10; })) << status_;
  conclude("a pose that nobody fills in, a twist of 10 m/s", "labels withheld after 0.4 s, with what to set");
}

TEST_F(FaultsOfMotion, TheCloudsTellOthersWhereTheVehicleIs) {
  ros::param::set(nodeName() + "/odometry_source", "lidar");
  ros::param::set(nodeName() + "/publish_tf", true);
  tf2_ros::Buffer tf;
  const tf2_ros::TransformListener listener(tf);
  std::vector<nav_msgs::OdometryConstPtr> told;
  const boost::function<void(const nav_msgs::OdometryConstPtr&)> take = [&](const auto& odometry) {
    told.push_back(odometry);
  };
  const auto subscriber = nh_.subscribe<nav_msgs::Odometry>("donex/odometry", 100, take);
  load();
  ASSERT_TRUE(waitFor([&] { return subscriber.getNumPublishers() == 1; }));
  constexpr std::size_t kScans = 8;
  for (std::size_t scan = 0; scan < kScans; ++scan) {
    advance();
    sendCourtyard();
    ASSERT_TRUE(waitFor([&] { return told.size() == scan + 1; })) << status_;
  }
  const double way = kSpeed * kPeriod * (kScans - 1);
  EXPECT_EQ(told.back()->header.frame_id, "odom");
  EXPECT_EQ(told.back()->child_frame_id, "base_link");
  EXPECT_NEAR(told.back()->pose.pose.position.x, way, 0.01);
  EXPECT_NEAR(told.back()->twist.twist.linear.x, kSpeed, 0.1);
  const ros::Time stamp = told.back()->header.stamp;
  ASSERT_TRUE(waitFor([&] { return tf.canTransform("odom", "base_link", stamp); }));
  EXPECT_NEAR(tf.lookupTransform("odom", "base_link", stamp).transform.translation.x, way, 0.01);
}

TEST_F(FaultsOfMotion, CloudsThatDoNotTellTheirMotion) {
  ros::param::set(nodeName() + "/odometry_source", "lidar");
  load();
  const auto drive = [&](int scans) {
    for (int scan = 0; scan < scans; ++scan) {
      advance();
      sendCourtyard();
    }
  };
  drive(5);
  ASSERT_TRUE(waitForLabeled(5)) << status_;
  for (int scan = 0; scan < 3; ++scan) {
    advance();
    sendCloud(now_);  // 36 echoes
  }
  ASSERT_TRUE(waitFor([&] { return count("dropped: ego motion not found") == 3; })) << status_;
  drive(2);
  ASSERT_TRUE(waitForLabeled(7)) << status_;
  conclude("`odometry_source: lidar`: 3 clouds of 36 echoes, as of a covered sensor");
}

}  // namespace
}  // namespace donex
