// The nodelet in a manager, with everything that happens to it while data flows.
#include <donex/MovingObjects.h>
#include <std_srvs/Trigger.h>

#include "ros/manager_rig.h"
#include "ros/unserved_nodelet.h"

namespace donex {
namespace {

using test::CloudBuilder;
using test::ManagerTest;
using test::PointField;
using test::waitFor;

class Manager : public ManagerTest {
 protected:
  static void expectDynamic(const sensor_msgs::PointCloud2& cloud, bool dynamic) {
    for (std::size_t i = 0; i < cloud.width; ++i) EXPECT_EQ(test::labelOf(cloud, "dynamic", i), dynamic ? 1 : 0);
  }
};

TEST_F(Manager, LabelsEveryCloudInItsFrame) {
  load();
  for (std::size_t i = 0; i < 20; ++i) {
    send(100.0 + 0.1 * static_cast<double>(i));
    ASSERT_TRUE(waitForLabeled(i + 1));
  }
  for (std::size_t i = 0; i < 20; ++i) {
    const auto& cloud = *received_[i];
    EXPECT_EQ(cloud.header.frame_id, "lidar");
    EXPECT_NEAR(cloud.header.stamp.toSec(), 100.0 + 0.1 * static_cast<double>(i), 1e-6);
    EXPECT_EQ(cloud.fields.size(), 6U);
  }
  ASSERT_TRUE(waitForDiagnostic("clouds labelled", "20"));
  EXPECT_EQ(diagnostic("clouds dropped"), "0");
}

TEST_F(Manager, NothingIsLostToAManagerThatDropsCallbacks) {
  const test::UnservedNodelet nodelet(nodeName(), "donex/DonexNodelet");
  connect(clouds_);
  sendCloud(100.0);
  sendOdometry(100.0);
  EXPECT_TRUE(waitForLabeled(1)) << "not with the next cloud, which may never come";
  EXPECT_TRUE(waitForDiagnostic("clouds labelled", "1")) << "its timers run";
}

TEST_F(Manager, ThePartsDivideTheCloudWhileSomebodyListens) {
  load();
  sensor_msgs::PointCloud2ConstPtr moving, still;
  const boost::function<void(const sensor_msgs::PointCloud2ConstPtr&)> take_moving = [&](const auto& cloud) {
    moving = cloud;
  };
  const boost::function<void(const sensor_msgs::PointCloud2ConstPtr&)> take_still = [&](const auto& cloud) {
    still = cloud;
  };
  auto a = nh_.subscribe<sensor_msgs::PointCloud2>("donex/dynamic_points", 5, take_moving);
  auto b = nh_.subscribe<sensor_msgs::PointCloud2>("donex/static_points", 5, take_still);
  ASSERT_TRUE(waitFor([&] { return a.getNumPublishers() == 1 && b.getNumPublishers() == 1; }));
  send(100.0);
  ASSERT_TRUE(waitFor([&] { return moving && still; }));
  EXPECT_EQ(moving->width + still->width, 36U);
  EXPECT_EQ(still->fields.size(), 4U);
}

TEST_F(Manager, BadCloudsAreCountedAndTheNextOneIsLabelled) {
  load();
  const auto good = [] { return CloudBuilder().xyz().size(4).build(); };
  auto truncated = good(), huge = good(), no_step = good();
  truncated->data.resize(7);
  huge->width = 4000000000U;
  no_step->point_step = 0;
  const auto no_z = CloudBuilder().field("x", PointField::FLOAT32).field("y", PointField::FLOAT32).size(4).build();
  const auto integers = CloudBuilder().xyz(PointField::INT32).size(4).build();
  for (const auto& cloud : {truncated, huge, no_step, no_z, integers}) clouds_.publish(cloud);
  ASSERT_TRUE(waitForDiagnostic("dropped: unreadable cloud", "5"));
  EXPECT_NE(diagnostic("last drop").find("datatype"), std::string::npos) << diagnostic("last drop");
  send(100.0);
  EXPECT_TRUE(waitForLabeled(1));
}

TEST_F(Manager, MissingTransformIsTold) {
  load();
  sendOdometry(100.0);
  clouds_.publish(test::plainCloud(test::ring(), 100.0, "unmounted"));
  ASSERT_TRUE(waitForDiagnostic("dropped: no transform", "1"));
  EXPECT_NE(diagnostic("last drop").find("unmounted"), std::string::npos) << diagnostic("last drop");
  send(100.1);
  EXPECT_TRUE(waitForLabeled(1));
}

TEST_F(Manager, LateOdometryLosesNothing) {
  ros::param::set(nodeName() + "/odometry_timeout", 10.0);
  load();
  for (int i = 0; i < 8; ++i) sendCloud(100.0 + 0.1 * i);
  ASSERT_TRUE(waitForDiagnostic("clouds waiting", "8"));
  EXPECT_TRUE(received_.empty());
  for (int i = 0; i < 8; ++i) sendOdometry(100.0 + 0.1 * i);
  EXPECT_TRUE(waitForLabeled(8));
}

TEST_F(Manager, OdometryWithFaultsIsCounted) {
  load();
  auto nan = boost::make_shared<nav_msgs::Odometry>(test::odometryAt(100.0));
  nan->pose.pose.position.x = std::nan("");
  auto no_rotation = boost::make_shared<nav_msgs::Odometry>(test::odometryAt(100.0));
  no_rotation->pose.pose.orientation.w = 0.0;
  odometry_.publish(nan);
  odometry_.publish(no_rotation);
  ASSERT_TRUE(waitForDiagnostic("odometry refused: not finite", "1"));
  EXPECT_TRUE(waitForDiagnostic("odometry refused: quaternion not of unit length", "1"));
  send(100.0);
  EXPECT_TRUE(waitForLabeled(1));
}

TEST_F(Manager, ALoopedBagGoesOn) {
  usePapersRule(nodeName());
  load();
  for (std::size_t loop = 0; loop < 2; ++loop) {
    sendInside(100.0);
    for (int i = 1; i < 9; ++i) send(100.0 + 0.1 * i);
    sendInside(100.9);
    ASSERT_TRUE(waitForLabeled(10 * (loop + 1)));
    expectDynamic(*received_[10 * loop], false);
    expectDynamic(*received_[10 * loop + 9], true);
  }
}

TEST_F(Manager, ResetForgetsTheGrid) {
  usePapersRule(nodeName());
  load();
  for (int i = 0; i < 9; ++i) send(100.0 + 0.1 * i);
  sendInside(100.9);
  ASSERT_TRUE(waitForLabeled(10));
  for (int i = 10; i < 19; ++i) send(100.0 + 0.1 * i);
  ASSERT_TRUE(waitForLabeled(19));
  expectDynamic(*received_[9], true);
  std_srvs::Trigger call;
  ASSERT_TRUE(ros::service::call(nodeName() + "/reset", call));
  EXPECT_TRUE(call.response.success) << call.response.message;
  sendInside(101.9);
  ASSERT_TRUE(waitForLabeled(20));
  expectDynamic(*received_[19], false);
}

TEST_F(Manager, AnOverloadDropsTheOldestAndCountsThem) {
  load();
  for (int i = 0; i < 60; ++i) sendCloud(100.0 + 0.1 * i);
  ASSERT_TRUE(waitForDiagnostic("dropped: queue full", std::to_string(60 - NodeConfig().queue_size)));
  // Of those that wait each is labelled or counted, whether the odometry comes before their time is up or not.
  for (int i = 0; i < 60; ++i) sendOdometry(100.0 + 0.1 * i);
  ASSERT_TRUE(waitForDiagnostic("clouds waiting", "0"));
  const int labeled = std::stoi(diagnostic("clouds labelled")), dropped = std::stoi(diagnostic("clouds dropped"));
  EXPECT_EQ(labeled + dropped, 60);
}

TEST_F(Manager, ObjectsAreToldScanByScan) {
  load();
  std::vector<MovingObjectsConstPtr> told;
  const boost::function<void(const MovingObjectsConstPtr&)> take = [&](const auto& objects) {
    told.push_back(objects);
  };
  auto subscriber = nh_.subscribe<MovingObjects>("donex/objects", 5, take);
  ASSERT_TRUE(waitFor([&] { return subscriber.getNumPublishers() == 1; }));
  send(100.0);
  ASSERT_TRUE(waitFor([&] { return told.size() == 1; }));
  EXPECT_EQ(told[0]->header.frame_id, "odom");
  EXPECT_EQ(told[0]->header.stamp, ros::Time(100.0));
}

TEST_F(Manager, LayersForTheEyeComeWhileSomebodyLooks) {
  load();
  std::map<std::string, sensor_msgs::PointCloud2ConstPtr> shown;
  std::vector<ros::Subscriber> eyes;
  for (const std::string topic : {"explained_points", "shadowed_cells", "seen_through_cells"}) {
    const boost::function<void(const sensor_msgs::PointCloud2ConstPtr&)> take = [&shown, topic](const auto& cloud) {
      shown[topic] = cloud;
    };
    eyes.push_back(nh_.subscribe<sensor_msgs::PointCloud2>("donex/" + topic, 5, take));
  }
  ASSERT_TRUE(waitFor([&] {
    return std::all_of(eyes.begin(), eyes.end(), [](const auto& eye) { return eye.getNumPublishers() == 1; });
  }));
  send(100.0);
  ASSERT_TRUE(waitFor([&] { return shown.size() == 3; }));
  EXPECT_EQ(shown["explained_points"]->width, 36U);
  EXPECT_EQ(shown["explained_points"]->header.frame_id, "lidar");
  EXPECT_EQ(shown["shadowed_cells"]->header.frame_id, "odom");
}

/// Two LiDARs, each with a classifier, a mounting and a cloud of its own: what is new to the one is not to the other.
TEST_F(Manager, TwoLidarsInOneManager) {
  const std::string other = nh_.getNamespace() + "/right";
  setUpSmall(other);
  for (const std::string& node : {nodeName(), other}) {
    usePapersRule(node);
    ros::param::set(node + "/odometry_timeout", 10.0);
  }
  load();
  transforms_.sendTransform(test::transformAt(0.0, "base_link", "lidar_right", 0.5, 1.7));
  const ros::M_string remappings{{nh_.getNamespace() + "/points", other + "_points"}};
  ASSERT_TRUE(manager_.load(other, "donex/DonexNodelet", remappings, {}));
  auto clouds = nh_.advertise<sensor_msgs::PointCloud2>("right_points", 10);
  std::vector<sensor_msgs::PointCloud2ConstPtr> right;
  const boost::function<void(const sensor_msgs::PointCloud2ConstPtr&)> take = [&](const auto& cloud) {
    right.push_back(cloud);
  };
  auto subscriber = nh_.subscribe<sensor_msgs::PointCloud2>("right/labeled_points", 10, take);
  ASSERT_TRUE(waitFor([&] { return clouds.getNumSubscribers() == 1 && subscriber.getNumPublishers() == 1; }));
  for (int i = 0; i < 10; ++i) {
    const double stamp = 100.0 + 0.1 * i;
    i < 9 ? send(stamp) : sendInside(stamp);
    // All along where the other one's lines of sight pass.
    clouds.publish(test::plainCloud(test::ring(20, test::kInside), stamp, "lidar_right"));
  }
  ASSERT_TRUE(waitFor([&] { return right.size() == 10 && received_.size() == 10; })) << right.size();
  for (std::size_t i = 0; i < 10; ++i) {
    ASSERT_EQ(received_[i]->width, 36U);
    ASSERT_EQ(right[i]->width, 20U);
    EXPECT_EQ(received_[i]->header.frame_id, "lidar");
    EXPECT_EQ(right[i]->header.frame_id, "lidar_right");
    expectDynamic(*received_[i], i == 9);
    expectDynamic(*right[i], false);
  }
}

TEST_F(Manager, CanBeUnloadedAndLoadedWhileDataFlows) {
  for (int i = 0; i < 4; ++i) {
    load();
    for (int k = 0; k < 10; ++k) send(100.0 + i + 0.1 * k);
    ASSERT_TRUE(waitForLabeled(static_cast<std::size_t>(i) + 1));
    ASSERT_TRUE(manager_.unload(nodeName()));
    ASSERT_TRUE(waitFor([this] { return clouds_.getNumSubscribers() == 0; }));
  }
}

TEST_F(Manager, TheStatusLineSaysWhatIsWrong) {
  load();
  ASSERT_TRUE(waitFor([this] { return status_ == "WARN: no clouds yet, no odometry yet"; }));
  sendCloud(100.0);
  ASSERT_TRUE(waitFor([this] { return status_.find("no odometry in time") != std::string::npos; })) << status_;
  std::size_t sent = 0;
  EXPECT_TRUE(waitFor([&] {
    if (received_.size() == sent) send(101.0 + 0.1 * static_cast<double>(sent++));
    return status_.find("ms a scan") != std::string::npos;
  })) << status_;
}

/// A room of 10 m around the sensor, beam by beam; with `somebody` in it, who hides a part of the wall.
std::vector<Eigen::Vector3f> room(bool somebody) {
  constexpr float kDegree = 0.017453293F;
  std::vector<Eigen::Vector3f> echoes;
  for (int elevation = -12; elevation <= 12; ++elevation) {
    for (int azimuth = 0; azimuth < 360; ++azimuth) {
      const float angle = kDegree * (static_cast<float>(azimuth) + 0.3F);
      const bool hits = somebody && azimuth < 20;
      const float range = hits ? test::kInside : 10.0F, slope = std::tan(kDegree * static_cast<float>(elevation));
      echoes.emplace_back(range * std::cos(angle), range * std::sin(angle), range * slope);
    }
  }
  return echoes;
}

/// What config/at_rest.yaml says is enough: no odometry and no tf, and who comes in is dynamic within a second.
TEST_F(Manager, ASensorAtRestTellsWhoComesInTheFirstSecond) {
  XmlRpc::XmlRpcValue values;
  ASSERT_TRUE(ros::param::get("/at_rest", values)) << "manager.test loads config/at_rest.yaml";
  for (const auto& [name, value] : values) ros::param::set(nodeName() + "/" + name, value);
  load();
  constexpr int kEmpty = 10, kSecond = 10;  // scans
  std::vector<std::size_t> dynamic;
  for (int i = 0; i < kEmpty + kSecond; ++i) {
    const auto echoes = room(i >= kEmpty);
    clouds_.publish(test::plainCloud(echoes, 100.0 + 0.1 * i, "frame_that_nobody_knows"));
    ASSERT_TRUE(waitForLabeled(static_cast<std::size_t>(i) + 1)) << status_;
    dynamic.push_back(0);
    for (std::size_t k = 0; k < echoes.size(); ++k) {
      if (test::labelOf(*received_.back(), "dynamic", k) == 0) continue;
      ++dynamic.back();
      EXPECT_LT(echoes[k].head<2>().norm(), 6.0F) << "the wall, scan " << i;
    }
  }
  EXPECT_EQ(std::count(dynamic.begin(), dynamic.begin() + kEmpty, 0U), kEmpty) << "nobody is there yet";
  constexpr std::size_t kSomebody = 25 * 20;  // echoes
  EXPECT_GT(*std::max_element(dynamic.begin() + kEmpty, dynamic.end()), kSomebody / 2);
}

}  // namespace
}  // namespace donex

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "manager_test");
  ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
