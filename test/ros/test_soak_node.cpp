// The same drive through the nodelet in a manager, with its queues, timers, tf and diagnostics, under random faults: as
// many scans as DONEX_SOAK_SCANS says, six times as fast as a vehicle sends them.
#include <random>

#include "ros/faults_rig.h"
#include "ros/soak_drive.h"

namespace donex {
namespace {

using test::SoakDrive;

class SoakOfNode : public test::FaultsTest {
 protected:
  void run(std::size_t scans) {
    const SoakDrive drive(scans, {"odom", "base_link", "lidar"});
    for (std::size_t scan = 0; scan < scans; ++scan) {
      jumpInTime();
      advance();
      disturb();
      sendOdometry(drive.at(scan));
      sendScan(drive.at(scan));
      labeled_so_far_ += received_.size();
      received_.clear();
      memory_.look();
    }
  }
  std::size_t labeled() const { return labeled_so_far_ + received_.size(); }
  const test::MemoryWatch& memory() const { return memory_; }

 private:
  bool chance(double probability) { return std::uniform_real_distribution<double>(0.0, 1.0)(random_) < probability; }

  void jumpInTime() {
    if (chance(0.001)) setClock(now_ - 5.0);
    if (chance(0.001)) setClock(now_ + 5.0);
    if (chance(0.003)) without_odometry_ = 30;
  }
  void disturb() {
    std_srvs::Trigger reset;
    if (chance(0.005)) {
      ASSERT_TRUE(ros::service::call(nodeName() + "/reset", reset));
    }
    if (chance(0.005)) reconfigure();
    if (chance(0.005)) take(test::plainCloud(test::ring(), now_, "nobody_knows"));
    if (chance(0.005)) take(test::plainCloud(test::ring(), now_ - 0.25));
    if (chance(0.005)) take(test::CloudBuilder().field("x", test::PointField::INT8).size(3).build());
    for (int i = chance(0.003) ? 40 : 0; i > 0; --i) take(test::plainCloud(test::ring(), now_ - 1e-4 * i));
  }
  void reconfigure() {
    dynamic_reconfigure::Reconfigure change;
    change.request.config.doubles.resize(1);
    change.request.config.doubles[0].name = "voxel_size";
    change.request.config.doubles[0].value = chance(0.5) ? 0.3 : 0.25;
    ASSERT_TRUE(ros::service::call(nodeName() + "/set_parameters", change));
  }
  void sendOdometry(const SoakDrive::Piece& piece) {
    if (without_odometry_ > 0) return void(--without_odometry_);
    OdometrySample sample;
    sample.stamp = now_ - (chance(0.02) ? 0.3 : 0.0);
    sample.odom_from_base = piece.odom_from_base;
    if (chance(0.01)) sample.odom_from_base.translation().x() = std::nan("");
    odometry_.publish(toOdometry(sample, {}));
  }
  void sendScan(const SoakDrive::Piece& piece) {
    const auto cloud = boost::make_shared<sensor_msgs::PointCloud2>(*piece.cloud);
    cloud->header.stamp.fromSec(now_);
    if (chance(0.01)) cloud->data.resize(cloud->data.size() / 2);
    take(cloud);
    if (chance(0.01)) take(cloud);
  }
  void take(const sensor_msgs::PointCloud2ConstPtr& cloud) {
    ++clouds_sent_;
    clouds_.publish(cloud);
  }

  std::mt19937 random_{11};
  std::size_t labeled_so_far_ = 0;
  int without_odometry_ = 0;  // scans
  test::MemoryWatch memory_;
};

TEST_F(SoakOfNode, EveryScanIsAccountedForAndMemoryStaysFlat) {
  const std::size_t scans = test::soakScans(300);
  load();
  driveWell();
  run(scans);
  recover();  // what is held back as suspect is settled by the scans that follow
  ASSERT_TRUE(waitForDiagnostic("clouds in", std::to_string(clouds_sent_)));
  ASSERT_TRUE(waitForDiagnostic("clouds waiting", "0"));
  EXPECT_EQ(count("clouds labelled") + count("clouds dropped"), clouds_sent_);
  EXPECT_EQ(count("clouds labelled"), labeled()) << "what is labelled is published";
  EXPECT_EQ(diagnostic("internal errors"), "0") << diagnostic("last internal error");
  EXPECT_GT(count("clouds labelled"), scans / 2);
  std::cout << clouds_sent_ << " scans in, " << count("clouds labelled") << " labelled, dropped: " << counted() << "\n";
  memory().expectFlat();
}

}  // namespace
}  // namespace donex

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "soak_node_test");
  ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
