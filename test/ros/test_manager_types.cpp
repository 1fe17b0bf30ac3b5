// What may be published on the topic of the clouds, and what is said of a message that may not.
#include <std_msgs/String.h>

#include "ros/livox_message.h"
#include "ros/manager_rig.h"

namespace donex {
namespace {

/// A publisher that no test has tied to PointCloud2.
class ManagerTypes : public test::ManagerTest {
 protected:
  void load(const ros::Publisher& publisher) {
    others_ = publisher;
    loadOn(others_);
  }
  static topic_tools::ShapeShifter livoxMessage(double stamp) {
    return test::messageOf(test::livoxBytes(test::livoxPoints(test::ring()), stamp), "livox_ros_driver2/CustomMsg");
  }

  ros::Publisher others_;
};

TEST_F(ManagerTypes, LivoxMessagesAreLabelled) {
  load(livoxMessage(100.0).advertise(nh_, "livox", 50));
  constexpr std::size_t kScans = 5;
  for (std::size_t i = 0; i < kScans; ++i) {
    const double stamp = 100.0 + 0.1 * static_cast<double>(i);
    sendOdometry(stamp);
    sendOdometry(stamp + 0.05);
    others_.publish(livoxMessage(stamp));
    ASSERT_TRUE(waitForLabeled(i + 1)) << diagnostic("last drop");
  }
  const auto& cloud = *received_.back();
  std::vector<std::string> names;
  for (const auto& field : cloud.fields) names.push_back(field.name);
  EXPECT_EQ(names, (std::vector<std::string>{"x", "y", "z", "intensity", "tag", "line", "offset_time", "dynamic",
                                             "observed"}));
  EXPECT_EQ(cloud.width, test::ring().size());
  EXPECT_EQ(test::labelOf(cloud, "tag", 5), 5);
}

TEST_F(ManagerTypes, CutOffLivoxMessagesAreRefusedAndTheNextIsLabelled) {
  load(livoxMessage(100.0).advertise(nh_, "livox", 50));
  auto bytes = test::livoxBytes(test::livoxPoints(test::ring()), 100.0);
  bytes.resize(bytes.size() / 2);
  others_.publish(test::messageOf(bytes, "livox_ros_driver2/CustomMsg"));
  sendOdometry(100.1);
  sendOdometry(100.2);
  others_.publish(livoxMessage(100.1));
  ASSERT_TRUE(waitForLabeled(1));
  ASSERT_TRUE(waitForDiagnostic("dropped: unreadable cloud", "1"));
  EXPECT_NE(diagnostic("last drop").find("a livox_ros_driver2/CustomMsg of "), std::string::npos)
      << diagnostic("last drop");
}

TEST_F(ManagerTypes, AnotherTypeIsNamedWithThoseThatAreRead) {
  load(nh_.advertise<std_msgs::String>("chatter", 50));
  std_msgs::String text;
  text.data = "no cloud";
  others_.publish(text);
  ASSERT_TRUE(waitForDiagnostic("dropped: unreadable cloud", "1"));
  const std::string said = diagnostic("last drop");
  EXPECT_NE(said.find("/chatter: messages of type std_msgs/String"), std::string::npos) << said;
  EXPECT_NE(said.find("read are sensor_msgs/PointCloud2, livox_ros_driver/CustomMsg"), std::string::npos) << said;
}

}  // namespace
}  // namespace donex
