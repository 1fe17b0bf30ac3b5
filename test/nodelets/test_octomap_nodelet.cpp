// donex/OctomapNodelet in the manager of this process: parameters that cannot be meant.
#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <nodelet/loader.h>
#include <ros/ros.h>

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

}  // namespace
}  // namespace donex

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_octomap_nodelet");
  const ros::NodeHandle alive;
  return RUN_ALL_TESTS();
}
