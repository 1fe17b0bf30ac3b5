// Inside one manager clouds travel as the very objects that were published: counted in allocations and in owners.
#include "ros/manager_rig.h"
#include "ros/sized_allocations.h"

namespace donex {
namespace {

using test::CloudBuilder;
using test::PointField;
using test::waitFor;

// Sizes that nothing but the data of these clouds has.
constexpr std::size_t kEchoes = 4001, kPointStep = 37, kLabeledPointStep = 39;
constexpr std::size_t kInputBytes = kEchoes * kPointStep, kOutputBytes = kEchoes * kLabeledPointStep;

boost::shared_ptr<sensor_msgs::PointCloud2> oddCloud(double stamp, std::uint32_t seq) {
  auto cloud = CloudBuilder().stamp(stamp).xyz().padding(kPointStep - 12).size(kEchoes).build();
  cloud->header.seq = seq;
  return cloud;
}

class ZeroCopy : public test::ManagerTest {
 protected:
  void SetUp() override {
    ros::param::set(nodeName() + "/odometry_timeout", 10.0);
    load();
    second_ = nh_.subscribe("donex/labeled_points", 200, &ZeroCopy::onSecond, this);
    ASSERT_TRUE(waitFor([this] { return second_.getNumPublishers() == 1; }));
  }
  void onSecond(const sensor_msgs::PointCloud2ConstPtr& cloud) { second_received_.push_back(cloud); }

  ros::Subscriber second_;
  std::vector<sensor_msgs::PointCloud2ConstPtr> second_received_;
};

TEST_F(ZeroCopy, TheNodeletHoldsThePublishersOwnObject) {
  const sensor_msgs::PointCloud2ConstPtr cloud = oddCloud(100.0, 1);
  clouds_.publish(cloud);
  ASSERT_TRUE(waitForDiagnostic("clouds waiting", "1"));
  EXPECT_EQ(cloud.use_count(), 2) << "this test and the nodelet, which waits for odometry";
  sendOdometry(100.0);
  ASSERT_TRUE(waitForLabeled(1));
  EXPECT_TRUE(waitFor([&] { return cloud.use_count() == 1; })) << "and it is let go";
}

TEST_F(ZeroCopy, OneAllocationAScanAndEveryoneGetsIt) {
  // The first scans bring every buffer to its size.
  for (std::uint32_t i = 0; i < 3; ++i) {
    sendOdometry(100.0 + 0.1 * i);
    clouds_.publish(oddCloud(100.0 + 0.1 * i, 1000 + i));
    ASSERT_TRUE(waitForLabeled(i + 1));
  }
  for (std::uint32_t i = 3; i < 13; ++i) {
    const sensor_msgs::PointCloud2ConstPtr cloud = oddCloud(100.0 + 0.1 * i, 1000 + i);
    sendOdometry(100.0 + 0.1 * i);
    test::countAllocationsOf(kInputBytes, kOutputBytes);
    clouds_.publish(cloud);
    ASSERT_TRUE(waitForLabeled(i + 1));
    ASSERT_TRUE(waitFor([&] { return second_received_.size() == i + 1; }));
    EXPECT_EQ(test::firstAllocations(), 0) << "the input was copied";
    EXPECT_EQ(test::secondAllocations(), 1) << "the output is made once and handed on as it is";
    ASSERT_EQ(received_.back()->data.size(), kOutputBytes);
    EXPECT_EQ(received_.back(), second_received_.back());
    // roscpp numbers what it serialises: the input's own number shows that nothing was.
    EXPECT_EQ(received_.back()->header.seq, cloud->header.seq);
  }
}

}  // namespace
}  // namespace donex

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "zero_copy");
  ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
