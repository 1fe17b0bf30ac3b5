// Clouds that are labelled and should not be believed without a word, two sources of one thing, and tf that was lost.
#include "ros/faults_rig.h"
#include "ros/lost_transform.h"
#include "support/room_of_rings.h"

namespace donex {
namespace {

using test::FaultsTest;
using test::waitFor;

class FaultsOfClouds : public FaultsTest {
 protected:
  void drive(const std::vector<Eigen::Vector3f>& echoes, int scans, const std::string& frame = "lidar") {
    const std::size_t before = received_.size();
    for (int scan = 0; scan < scans; ++scan) {
      advance();
      sendOdometry(now_);
      ++clouds_sent_;
      clouds_.publish(test::plainCloud(echoes, now_, frame));
    }
    ASSERT_TRUE(waitForLabeled(before + static_cast<std::size_t>(scans))) << status_;
  }
  bool waitForStatus(const std::string& text) {
    return waitFor([&] { return status_.find(text) != std::string::npos; });
  }
  /// A scan's echoes one after the other up to now; one of them much later.
  boost::shared_ptr<sensor_msgs::PointCloud2> cloudWithAWildTime() const {
    constexpr std::size_t kWild = 7;
    test::CloudBuilder builder;
    builder.frame("lidar").stamp(now_).xyz().field("time", sensor_msgs::PointField::FLOAT32);
    builder.size(static_cast<std::uint32_t>(ring_.size()));
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      const Eigen::Vector3d echo = ring_[i].cast<double>();
      const double share = static_cast<double>(i) / static_cast<double>(ring_.size());
      builder.at(i, echo.x(), echo.y(), echo.z()).set(i, "time", i == kWild ? 0.9 : kPeriod * (share - 1.0));
    }
    return builder.build();
  }
  /// Of a sensor 1 m before and 1.8 m above the vehicle's origin, told in the vehicle's frame.
  boost::shared_ptr<sensor_msgs::PointCloud2> cloudMovedWithItsRings() const {
    const auto mounting = Eigen::Isometry3f(Eigen::Translation3f(1.0F, 0.0F, 1.8F));
    const testing::RingedCloud cloud = testing::ringsIn(testing::Room::kWithWalls, mounting);
    test::CloudBuilder builder;
    builder.frame("base_link").stamp(now_).xyz().field("ring", sensor_msgs::PointField::UINT16);
    builder.size(static_cast<std::uint32_t>(cloud.echoes.size()));
    for (std::size_t i = 0; i < cloud.echoes.size(); ++i) {
      const Eigen::Vector3d echo = cloud.echoes[i].cast<double>();
      builder.at(i, echo.x(), echo.y(), echo.z()).set(i, "ring", cloud.rings[i]);
    }
    return builder.build();
  }
  int dynamicEchoes() const {
    int count = 0;
    const auto& cloud = *received_.back();
    for (std::size_t i = 0; i < cloud.width; ++i) count += test::labelOf(cloud, "dynamic", i);
    return count;
  }

  const std::vector<Eigen::Vector3f> ring_ = test::ring(500);
};

TEST_F(FaultsOfClouds, ARegionBesideEverything) {
  ros::param::set(nodeName() + "/z_min", -9.0);
  ros::param::set(nodeName() + "/z_max", -5.0);
  load();
  drive(ring_, 5);
  ASSERT_TRUE(waitForStatus("0.0 % of the echoes lie in the region")) << status_;
  conclude("a region beside everything; the status says `0.0 % of the echoes lie in the region`",
           "every scan labelled");
}

TEST_F(FaultsOfClouds, Millimetres) {
  load();
  drive(test::ring(500, 10000.0F), 5);
  ASSERT_TRUE(waitForStatus("are the clouds in metres?")) << status_;
  conclude("clouds in millimetres; the status asks `are the clouds in metres?`", "every scan labelled");
}

TEST_F(FaultsOfClouds, NoReturnsAtTheLargestRange) {
  load();
  std::vector<Eigen::Vector3f> echoes = ring_;
  for (const Eigen::Vector3f& end : test::ring(100, 100.0F)) echoes.push_back(end);
  drive(echoes, 5);
  ASSERT_TRUE(waitFor([this] {
    return diagnostic("beams without an echo").rfind("100 echoes at one largest", 0) == 0;
  })) << diagnostic("beams without an echo");
  conclude("beams without an echo written at the largest range; `beams without an echo` counts them",
           "every scan labelled");
}

TEST_F(FaultsOfClouds, NoReturnsAtTheSensorOfAMovedCloud) {
  ros::param::set(nodeName() + "/origin_z", 1.7);
  usePapersRule(nodeName());
  load();
  std::vector<Eigen::Vector3f> echoes = ring_;
  for (Eigen::Vector3f& echo : echoes) echo.z() += 1.7F;
  drive(echoes, 9, "base_link");
  echoes.insert(echoes.end(), 100, Eigen::Vector3f(0.0F, 0.0F, 1.7F));  // only now: what was there before is not new
  drive(echoes, 1, "base_link");
  EXPECT_EQ(dynamicEchoes(), 0);
  conclude("beams without an echo at 0, 0, 0, moved into the vehicle's frame with the cloud", "none is dynamic");
}

TEST_F(FaultsOfClouds, MovedIntoTheVehiclesFrame) {
  load();
  for (int scan = 0; scan < 10; ++scan) {
    advance();
    sendOdometry(now_);
    ++clouds_sent_;
    clouds_.publish(cloudMovedWithItsRings());
  }
  ASSERT_TRUE(waitForLabeled(10)) << status_;
  ASSERT_TRUE(waitFor([this] {
    return diagnostic("origin of the clouds").find("their rings meet at x 1.00, y") != std::string::npos;
  })) << diagnostic("origin of the clouds");
  conclude(
      "clouds moved into the vehicle's frame; `origin of the clouds` says where their rings meet, and lines of sight "
      "begin there",
      "every scan labelled");
}

TEST_F(FaultsOfClouds, NoTimesOfEchoes) {
  load();
  drive(ring_, 5);
  ASSERT_TRUE(waitFor([this] {
    return diagnostic("de-skewed by").rfind("nothing: the clouds carry no times", 0) == 0;
  })) << diagnostic("de-skewed by");
  conclude("clouds without times of echoes; `de-skewed by` says `nothing: the clouds carry no times of echoes`",
           "every scan labelled");
}

TEST_F(FaultsOfClouds, OneWildTimeInEachCloud) {
  load();
  sendOdometry(now_ - kPeriod);  // before the first echo of the first cloud
  sendOdometry(now_);
  for (int scan = 0; scan < 10; ++scan) {
    advance();
    sendOdometry(now_);
    ++clouds_sent_;
    clouds_.publish(cloudWithAWildTime());
    ASSERT_TRUE(waitForLabeled(received_.size() + 1)) << status_;
  }
  ASSERT_TRUE(waitFor([this] { return diagnostic("echo times outside of the scan").rfind("1, taken", 0) == 0; }));
  conclude("one echo of every cloud has a time 0.9 s ahead; `echo times outside of the scan` counts it",
           "every scan labelled");
}

TEST_F(FaultsOfClouds, TwoSourcesOfOdometry) {
  load();
  for (int scan = 0; scan < 10; ++scan) {
    advance();
    sendOdometry(now_);
    auto other = boost::make_shared<nav_msgs::Odometry>(test::odometryAt(now_, 5.0));
    other->header.frame_id = "map";
    odometry_.publish(other);
    sendCloud(now_);
  }
  ASSERT_TRUE(waitForLabeled(10)) << status_;
  ASSERT_TRUE(waitFor([this] { return diagnostic("last odometry refused").find("two sources") != std::string::npos; }));
  conclude("two publishers of odometry in different frames: that of `fixed_frame` and `base_frame` is used",
           "every scan labelled");
}

TEST_F(FaultsOfClouds, LatchedTfIsLost) {
  const test::LostTransform mounting("base_link", "lidar_on_the_roof");
  load();
  ASSERT_TRUE(waitFor([&] { return mounting.subscribers() == 1; }));
  const auto isLabeled = [this] { return !received_.empty(); };
  do {
    advance();
    sendOdometry(now_);
    ++clouds_sent_;
    clouds_.publish(test::plainCloud(test::ring(), now_, "lidar_on_the_roof"));
    const bool is_over = waitFor(isLabeled, kPeriod);
    if (is_over) break;
  } while (clouds_sent_ < 3000);
  ASSERT_TRUE(isLabeled()) << status_;
  EXPECT_GE(mounting.subscribers(), 2);
  driveWell();
  conclude("the latched `/tf_static` is lost: tf is subscribed to anew after 5 s");
}

}  // namespace
}  // namespace donex
