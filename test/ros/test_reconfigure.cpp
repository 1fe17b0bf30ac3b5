// Parameters: what keeps the classifier from loading, what it takes or refuses while data flows, and what shows at
// once.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include <dynamic_reconfigure/Reconfigure.h>
#include <visualization_msgs/MarkerArray.h>

#include "ros/manager_rig.h"

namespace donex {
namespace {

using test::ManagerTest;
using test::waitFor;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArrayConstPtr;

class ReconfigureTest : public ManagerTest {
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

  /// Keeps what is on screen up to date in shown_.
  void watchMarkers() {
    const boost::function<void(const MarkerArrayConstPtr&)> take = [this](const MarkerArrayConstPtr& array) {
      for (const Marker& marker : array->markers) {
        if (marker.action == Marker::ADD) shown_[marker.ns] = marker;
        if (marker.action == Marker::DELETE) shown_.erase(marker.ns);
      }
    };
    markers_ = nh_.subscribe<visualization_msgs::MarkerArray>("donex/markers", 20, take);
    ASSERT_TRUE(waitFor([this] { return markers_.getNumPublishers() == 1; }));
  }
  /// The grid's outline of that scan ends `front` [m] before the vehicle; grids are made of bricks of 8 voxels.
  void expectFront(double stamp, double front) {
    ASSERT_TRUE(waitFor([&] { return isShown("grid", stamp); }));
    double foremost = -1e9;
    for (const auto& point : shown_.at("grid").points) foremost = std::max(foremost, point.x);
    EXPECT_GE(foremost, front);
    EXPECT_LE(foremost, front + 2.0 * 8.0 * Config().voxel_size);
  }
  /// From nothing to dynamic cells on screen, as the paper's rule has them.
  void showCells(double begin) {
    const std::size_t before = received_.size();
    for (int i = 0; i < 9; ++i) send(begin + 0.1 * i);
    sendInside(begin + 0.9);
    ASSERT_TRUE(waitForLabeled(before + 10));
    ASSERT_TRUE(waitFor([&] { return isShown("dynamic_cells", begin + 0.9); }));
  }
  bool isShown(const std::string& name, double stamp) const {
    const auto found = shown_.find(name);
    return found != shown_.end() && std::abs(found->second.header.stamp.toSec() - stamp) < 1e-6;
  }

  std::map<std::string, Marker> shown_;  // the newest of each namespace
  ros::Subscriber markers_;
};

TEST_F(ReconfigureTest, BadParametersKeepItFromLoading) {
  ros::param::set(nodeName() + "/voxel_size", "small");
  EXPECT_FALSE(tryLoad());
  ros::param::set(nodeName() + "/voxel_size", 0.3);
  EXPECT_TRUE(tryLoad());
}

TEST_F(ReconfigureTest, RefusedValuesLeaveTheOldOnes) {
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

TEST_F(ReconfigureTest, ChangesWhileDataFlowsLoseNoScan) {
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

TEST_F(ReconfigureTest, MarkersComeAndGo) {
  load();
  watchMarkers();
  send(100.0);
  ASSERT_TRUE(waitFor([this] { return shown_.count("grid") == 1; }));
  change([](dynamic_reconfigure::Config& config) {
    config.bools.resize(1);
    config.bools[0].name = "markers";
    config.bools[0].value = 0;
  });
  send(100.1);
  EXPECT_TRUE(waitFor([this] { return shown_.empty(); }));
}

/// A grid that scrolls holds the region however the vehicle turns.
TEST_F(ReconfigureTest, ANewRegionShowsWithTheNextScan) {
  load();
  watchMarkers();
  send(100.0);
  expectFront(100.0, std::hypot(15.0, 15.0));
  changeNumber("x_max", 25.0);
  send(100.1);
  expectFront(100.1, std::hypot(25.0, 15.0));
}

TEST_F(ReconfigureTest, ANewRegionOfAGridThatTurnsWithTheVehicleShowsWithTheNextScan) {
  usePapersRule(nodeName());
  ros::param::set(nodeName() + "/compensation", "resample");
  load();
  watchMarkers();
  send(100.0);
  expectFront(100.0, 15.0);
  changeNumber("x_max", 9.0);
  send(100.1);
  expectFront(100.1, 9.0);
}

TEST_F(ReconfigureTest, ANewVoxelSizeShowsInTheCells) {
  usePapersRule(nodeName());
  load();
  watchMarkers();
  showCells(100.0);
  EXPECT_EQ(shown_["dynamic_cells"].scale.x, Config().voxel_size);
  changeNumber("voxel_size", 0.45);
  showCells(101.0);
  EXPECT_EQ(shown_["dynamic_cells"].scale.x, 0.45);
  EXPECT_FALSE(shown_["dynamic_cells"].points.empty());
}

}  // namespace
}  // namespace donex

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "reconfigure_test");
  ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
