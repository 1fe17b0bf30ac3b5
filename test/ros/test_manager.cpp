// The nodelet in a manager, with everything that happens to it while data flows.
#include <donex/MovingObjects.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <std_srvs/Trigger.h>
#include <visualization_msgs/MarkerArray.h>

#include "ros/manager_rig.h"

namespace donex {
namespace {

using test::CloudBuilder;
using test::ManagerTest;
using test::PointField;
using test::waitFor;

class Manager : public ManagerTest {
 protected:
  /// What the server shows after it was asked for these values.
  dynamic_reconfigure::Config change(const std::function<void(dynamic_reconfigure::Config&)>& fill) {
    dynamic_reconfigure::Reconfigure call;
    fill(call.request.config);
    EXPECT_TRUE(ros::service::call(nodeName() + "/set_parameters", call));
    return call.response.config;
  }
  dynamic_reconfigure::Config changeNumber(const std::string& name, double value) {
    return change([&](dynamic_reconfigure::Config& config) {
      config.doubles.resize(1);
      config.doubles[0].name = name;
      config.doubles[0].value = value;
    });
  }
  dynamic_reconfigure::Config changeText(const std::string& name, const std::string& value) {
    return change([&](dynamic_reconfigure::Config& config) {
      config.strs.resize(1);
      config.strs[0].name = name;
      config.strs[0].value = value;
    });
  }
  static double numberIn(const dynamic_reconfigure::Config& config, const std::string& name) {
    for (const auto& parameter : config.doubles) {
      if (parameter.name == name) return parameter.value;
    }
    return std::nan("");
  }
  static std::string textIn(const dynamic_reconfigure::Config& config, const std::string& name) {
    for (const auto& parameter : config.strs) {
      if (parameter.name == name) return parameter.value;
    }
    return "";
  }
  /// The paper's rule alone: whatever is new is dynamic at once, also a single echo.
  void usePapersRule() {
    for (const auto* step :
         {"free_evidence", "careful_sight", "birth_age", "neighbourhood", "ground", "objects", "object_motion"})
      ros::param::set(nodeName() + "/" + step, false);
  }
  /// Where the lines of sight to the usual ring have been: new, unless the grid is.
  void sendInside(double stamp) {
    sendOdometry(stamp);
    clouds_.publish(test::plainCloud(test::ring(36, test::kInside), stamp));
  }
  static void expectDynamic(const sensor_msgs::PointCloud2& cloud, bool dynamic) {
    for (std::size_t i = 0; i < cloud.width; ++i) EXPECT_EQ(test::labelOf(cloud, "dynamic", i), dynamic ? 1 : 0);
  }
};

TEST_F(Manager, labelsEveryCloudInItsFrame) {
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

TEST_F(Manager, thePartsDivideTheCloudWhileSomebodyListens) {
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

TEST_F(Manager, badCloudsAreCountedAndTheNextOneIsLabelled) {
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

TEST_F(Manager, missingTransformIsTold) {
  load();
  sendOdometry(100.0);
  clouds_.publish(test::plainCloud(test::ring(), 100.0, "unmounted"));
  ASSERT_TRUE(waitForDiagnostic("dropped: no transform", "1"));
  EXPECT_NE(diagnostic("last drop").find("unmounted"), std::string::npos) << diagnostic("last drop");
  send(100.1);
  EXPECT_TRUE(waitForLabeled(1));
}

TEST_F(Manager, lateOdometryLosesNothing) {
  load();
  for (int i = 0; i < 8; ++i) sendCloud(100.0 + 0.1 * i);
  ASSERT_TRUE(waitFor([this] { return clouds_.getNumSubscribers() == 1; }));
  for (int i = 0; i < 8; ++i) sendOdometry(100.0 + 0.1 * i);
  EXPECT_TRUE(waitForLabeled(8));
}

TEST_F(Manager, odometryWithFaultsIsCounted) {
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

TEST_F(Manager, aLoopedBagGoesOn) {
  usePapersRule();
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

TEST_F(Manager, resetForgetsTheGrid) {
  usePapersRule();
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

TEST_F(Manager, badParametersKeepItFromLoading) {
  ros::param::set(nodeName() + "/voxel_size", "small");
  EXPECT_FALSE(tryLoad());
  ros::param::set(nodeName() + "/voxel_size", 0.3);
  EXPECT_TRUE(tryLoad());
}

TEST_F(Manager, refusedValuesLeaveTheOldOnes) {
  load();
  EXPECT_EQ(numberIn(changeNumber("voxel_size", 0.4), "voxel_size"), 0.4);
  EXPECT_EQ(numberIn(changeNumber("voxel_size", 5.0), "voxel_size"), 0.4) << "neither taken nor bent into range";
  EXPECT_EQ(numberIn(changeNumber("voxel_size", std::nan("")), "voxel_size"), 0.4);
  EXPECT_EQ(numberIn(changeNumber("x_max", -20.0), "x_max"), 15.0) << "behind x_min";
  EXPECT_EQ(textIn(changeText("method", "oracle"), "method"), "donex_3d");
  EXPECT_EQ(textIn(changeText("method", "donex_2d"), "method"), "donex_2d");
  double on_server = 0.0;
  EXPECT_TRUE(ros::param::get(nodeName() + "/voxel_size", on_server));
  EXPECT_EQ(on_server, 0.4);
}

TEST_F(Manager, changesWhileDataFlowsLoseNoScan) {
  load();
  constexpr int kScans = 150;
  for (int i = 0; i < kScans; ++i) {
    send(100.0 + 0.1 * i);
    if (i % 3 != 0) continue;
    switch (i / 3 % 5) {
      case 0: changeNumber("voxel_size", i % 2 == 0 ? 0.3 : 0.6); break;
      case 1: changeNumber("x_max", 10.0 + i % 7); break;
      case 2: changeText("method", i % 2 == 0 ? "donex_2d" : "donex_3d"); break;
      case 3: changeNumber("voxel_size", -1.0); break;
      default: changeText("compensation", i % 2 == 0 ? "scroll" : "resample"); break;
    }
    // No more in flight than the queue holds: what is lost is then lost by the change.
    ASSERT_TRUE(waitForLabeled(static_cast<std::size_t>(std::max(0, i - 5))));
  }
  ASSERT_TRUE(waitForLabeled(kScans));
  ASSERT_TRUE(waitForDiagnostic("clouds labelled", std::to_string(kScans)));
  EXPECT_EQ(diagnostic("clouds dropped"), "0");
}

TEST_F(Manager, anOverloadDropsTheOldestAndCountsThem) {
  load();
  for (int i = 0; i < 60; ++i) sendCloud(100.0 + 0.1 * i);
  ASSERT_TRUE(waitForDiagnostic("dropped: queue full", std::to_string(60 - NodeConfig().queue_size)));
  // Of those that wait each is labelled or counted, whether the odometry comes before their time is up or not.
  for (int i = 0; i < 60; ++i) sendOdometry(100.0 + 0.1 * i);
  ASSERT_TRUE(waitForDiagnostic("clouds waiting", "0"));
  const int labeled = std::stoi(diagnostic("clouds labelled")), dropped = std::stoi(diagnostic("clouds dropped"));
  EXPECT_EQ(labeled + dropped, 60);
}

TEST_F(Manager, markersComeAndGo) {
  load();
  std::set<std::string> shown;
  const boost::function<void(const visualization_msgs::MarkerArrayConstPtr&)> take = [&](const auto& array) {
    for (const auto& marker : array->markers) {
      if (marker.action == visualization_msgs::Marker::ADD) shown.insert(marker.ns);
      if (marker.action == visualization_msgs::Marker::DELETE) shown.erase(marker.ns);
    }
  };
  auto subscriber = nh_.subscribe<visualization_msgs::MarkerArray>("donex/markers", 20, take);
  ASSERT_TRUE(waitFor([&] { return subscriber.getNumPublishers() == 1; }));
  send(100.0);
  ASSERT_TRUE(waitFor([&] { return shown.count("grid") == 1; }));
  change([](dynamic_reconfigure::Config& config) {
    config.bools.resize(1);
    config.bools[0].name = "markers";
    config.bools[0].value = 0;
  });
  send(100.1);
  EXPECT_TRUE(waitFor([&] { return shown.empty(); }));
}

TEST_F(Manager, objectsAreToldScanByScan) {
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

TEST_F(Manager, layersForTheEyeComeWhileSomebodyLooks) {
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

TEST_F(Manager, twoLidarsInOneManager) {
  load();
  const std::string other = nh_.getNamespace() + "/right";
  const ros::M_string remappings{{nh_.getNamespace() + "/points", other + "_points"}};
  ASSERT_TRUE(manager_.load(other, "donex/DonexNodelet", remappings, {}));
  auto clouds = nh_.advertise<sensor_msgs::PointCloud2>("right_points", 10);
  std::size_t labeled = 0;
  const boost::function<void(const sensor_msgs::PointCloud2ConstPtr&)> take = [&](const auto&) { ++labeled; };
  auto subscriber = nh_.subscribe<sensor_msgs::PointCloud2>("right/labeled_points", 10, take);
  ASSERT_TRUE(waitFor([&] { return clouds.getNumSubscribers() == 1 && subscriber.getNumPublishers() == 1; }));
  for (int i = 0; i < 5; ++i) {
    send(100.0 + 0.1 * i);
    clouds.publish(test::plainCloud(test::ring(), 100.0 + 0.1 * i));
  }
  EXPECT_TRUE(waitFor([&] { return labeled == 5 && received_.size() == 5; })) << labeled << ", " << received_.size();
}

TEST_F(Manager, canBeUnloadedAndLoadedWhileDataFlows) {
  for (int i = 0; i < 4; ++i) {
    load();
    for (int k = 0; k < 10; ++k) send(100.0 + i + 0.1 * k);
    ASSERT_TRUE(waitForLabeled(static_cast<std::size_t>(i) + 1));
    ASSERT_TRUE(manager_.unload(nodeName()));
    ASSERT_TRUE(waitFor([this] { return clouds_.getNumSubscribers() == 0; }));
  }
}

TEST_F(Manager, theStatusLineSaysWhatIsWrong) {
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

}  // namespace
}  // namespace donex

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "manager_test");
  ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
