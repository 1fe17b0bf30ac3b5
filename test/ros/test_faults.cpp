// What can go wrong with time, odometry, tf and clouds: what is counted, and that labels come back.
#include "ros/faults_rig.h"

namespace donex {
namespace {

using test::FaultsTest;
using test::waitFor;

class Faults : public FaultsTest {};

TEST_F(Faults, OdometryAtAnyRate) {
  load();
  for (const double rate : {10.0, 50.0, 200.0, 1000.0}) {
    const std::size_t before = received_.size();
    for (int scan = 0; scan < 5; ++scan) {
      advance();
      for (double time = now_ - kPeriod + 1.0 / rate; time < now_ + 1e-4; time += 1.0 / rate) sendOdometry(time);
      sendCloud(now_);
    }
    ASSERT_TRUE(waitForLabeled(before + 5)) << rate << " Hz: " << status_;
  }
  conclude("odometry at 10, 50, 200, 1000 Hz", "every scan labelled");
}

TEST_F(Faults, OdometryHalfASecondLate) {
  load();
  driveWell();
  constexpr int kLate = 5, kScans = 20;  // scans
  for (int scan = 0; scan < kScans + kLate; ++scan) {
    advance();
    if (scan < kScans) sendCloud(now_);
    if (scan >= kLate) sendOdometry(now_ - kLate * kPeriod);
  }
  ASSERT_TRUE(waitForLabeled(kGood + kScans)) << status_;
  conclude("odometry 0.5 s late", "every scan labelled");
}

TEST_F(Faults, OdometryLostForFiveSeconds) {
  load();
  driveWell();
  for (int scan = 0; scan < 50; ++scan) {
    advance();
    sendCloud(now_);
  }
  ASSERT_TRUE(waitFor([this] { return status_.find("dropped (no odometry in time)") != std::string::npos; }))
      << status_;
  recover();
  conclude("odometry lost for 5 s");
}

TEST_F(Faults, OdometryTwiceAndOutOfOrder) {
  load();
  driveWell();
  for (int scan = 0; scan < 10; ++scan) {
    advance();
    sendOdometry(now_);
    sendOdometry(now_ - 0.05);
    sendOdometry(now_);
    sendCloud(now_);
  }
  ASSERT_TRUE(waitForLabeled(kGood + 10)) << status_;
  conclude("odometry doubled and out of order", "every scan labelled");
}

TEST_F(Faults, OdometryIsNotANumber) {
  load();
  driveWell();
  for (int scan = 0; scan < 10; ++scan) {
    advance();
    auto bad = boost::make_shared<nav_msgs::Odometry>(test::odometryAt(now_));
    if (scan % 2 == 0) {
      bad->pose.pose.position.x = std::nan("");
    } else {
      bad->pose.pose.orientation.w = 0.2;
    }
    odometry_.publish(bad);
    sendCloud(now_);
  }
  for (int wait = 0; wait < 8; ++wait) advance();
  recover();
  conclude("odometry with NaN and invalid quaternions for 1 s");
}

TEST_F(Faults, MountingComesLate) {
  load();
  advance();
  sendOdometry(now_);
  ++clouds_sent_;
  clouds_.publish(test::plainCloud(test::ring(), now_, "lidar_on_the_roof"));
  advance();
  transforms_.sendTransform(test::transformAt(0.0, "base_link", "lidar_on_the_roof", 0.0, 2.0));
  ASSERT_TRUE(waitForLabeled(1)) << status_;
  conclude("the mounting's transform comes 0.1 s after the first cloud", "every scan labelled");
}

TEST_F(Faults, MountingIsMissing) {
  load();
  driveWell();
  for (int scan = 0; scan < 10; ++scan) {
    advance();
    ++clouds_sent_;
    sendOdometry(now_);
    clouds_.publish(test::plainCloud(test::ring(), now_, "unknown"));
  }
  for (int wait = 0; wait < 8; ++wait) advance();
  recover();
  conclude("clouds in a frame that tf does not know");
}

TEST_F(Faults, UnreadableClouds) {
  load();
  driveWell();
  for (std::uint32_t claim : {4000000000U, 4294967295U}) {
    auto huge = test::plainCloud(test::ring(), now_);
    huge->width = claim;
    clouds_.publish(huge);
    auto truncated = test::plainCloud(test::ring(), now_);
    truncated->data.resize(5);
    clouds_.publish(truncated);
    clouds_sent_ += 2;
  }
  recover();
  conclude("clouds that claim 4 billion points; truncated ones");
}

TEST_F(Faults, CloudsTwiceAndOutOfOrder) {
  load();
  driveWell();
  sendCloud(now_);
  sendCloud(now_ - 0.05);
  recover();
  conclude("a cloud twice; one that comes after its successor");
}

TEST_F(Faults, TheClockJumpsAhead) {
  load();
  driveWell();
  setClock(now_ + 1000.0);
  recover();
  conclude("the clock jumps 1000 s ahead");
}

TEST_F(Faults, TheClockJumpsBack) {
  load();
  setClock(2000.0);
  driveWell();
  setClock(1000.0);
  recover();
  conclude("the clock jumps 1000 s back");
}

TEST_F(Faults, ABagThatLoops) {
  load();
  for (int loop = 0; loop < 4; ++loop) {
    setClock(kBegin);
    driveWell(10);
  }
  conclude("a bag that loops 4 times", "every scan labelled");
}

TEST_F(Faults, TheClockIsPaused) {
  load();
  driveWell();
  ASSERT_TRUE(waitFor([this] { return status_.find("no clouds for") != std::string::npos; })) << status_;
  recover();
  conclude("the clock is paused; the status says `no clouds for ... s`");
}

TEST_F(Faults, ASensorAtRestNeedsNothing) {
  ros::param::set(nodeName() + "/odometry_source", "none");
  load();
  for (int scan = 0; scan < 10; ++scan) {
    advance();
    ++clouds_sent_;
    clouds_.publish(test::plainCloud(test::ring(), now_, "frame_that_nobody_knows"));
  }
  ASSERT_TRUE(waitForLabeled(10)) << status_;
  conclude("`odometry_source: none`: no odometry, no tf at all", "every scan labelled");
}

TEST_F(Faults, MotionFromTfThatIsLateAndThenLost) {
  ros::param::set(nodeName() + "/odometry_source", "tf");
  load();
  ros::Publisher tf = nh_.advertise<tf2_msgs::TFMessage>("/tf", 100);
  ASSERT_TRUE(waitFor([&] { return tf.getNumSubscribers() != 0; }));
  const auto sendTf = [&](double stamp) {
    tf2_msgs::TFMessage message;
    message.transforms.push_back(test::transformAt(stamp, "odom", "base_link", 0.0));
    tf.publish(message);
  };
  sendTf(now_);
  for (int scan = 0; scan < 10; ++scan) {
    advance();
    sendCloud(now_);
    sendTf(now_ - 0.3);
  }
  sendTf(now_);
  ASSERT_TRUE(waitForLabeled(10)) << status_;
  for (int scan = 0; scan < 20; ++scan) {
    advance();
    sendCloud(now_);
  }
  for (int wait = 0; wait < 8; ++wait) advance();
  sendTf(now_);
  advance();
  sendTf(now_);
  sendCloud(now_);
  ASSERT_TRUE(waitFor([this] { return hasLabeled(now_); })) << status_;
  conclude("`odometry_source: tf`: tf 0.3 s late, then lost for 2 s");
}

}  // namespace
}  // namespace donex
