// What a planner reads of the objects.
#include <gtest/gtest.h>

#include "ros/object_messages.h"

namespace donex {
namespace {

class TwoObjects : public Detector {
 public:
  void process(const Scan&, EchoLabels&) override {}
  void reset() override { objects_.clear(); }
  const std::vector<Object>& objects() const override { return objects_; }
  std::vector<Eigen::Vector3f> dynamicCells() const override { return {}; }
  GridOutline outline() const override { return {}; }
  std::size_t memoryBytes() const override { return 0; }

  std::vector<Object> objects_ = std::vector<Object>(2);
};

TEST(ObjectMessages, SayWhatTheDetectorKnows) {
  TwoObjects detector;
  Object& car = detector.objects_[1];
  car.id = 7;
  car.dynamic = true;
  car.odom_from_box.translation() << 10.0, -3.0, 0.8;
  car.odom_from_box.rotate(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()));
  car.size << 4.2, 1.8, 1.5;
  car.velocity << 8.0, 4.0, 0.0;
  car.age = 2.5;
  car.echoes = 321;
  car.proof = Proof::kRearReceded;
  const MovingObjectsPtr message = toMessage(detector, ros::Time(100.5), "odom", Eigen::Isometry3d::Identity());
  EXPECT_EQ(message->header.frame_id, "odom");
  EXPECT_EQ(message->header.stamp, ros::Time(100.5));
  ASSERT_EQ(message->objects.size(), 2U);
  EXPECT_FALSE(message->objects[0].dynamic);
  EXPECT_EQ(message->objects[0].pose.orientation.w, 1.0);
  const MovingObject& moving = message->objects[1];
  EXPECT_EQ(moving.id, 7U);
  EXPECT_TRUE(moving.dynamic);
  EXPECT_EQ(moving.pose.position.y, -3.0);
  EXPECT_NEAR(moving.pose.orientation.z, std::sin(0.25), 1e-12);
  EXPECT_EQ(moving.size.x, 4.2);
  EXPECT_EQ(moving.velocity.y, 4.0);
  EXPECT_EQ(moving.age, ros::Duration(2.5));
  EXPECT_EQ(moving.echoes, 321U);
  EXPECT_EQ(moving.proof, "rear_receded");
  EXPECT_EQ(message->objects[0].proof, "none");
}

TEST(ObjectMessages, AreToldWhereTheOdometryHasTheVehicle) {
  TwoObjects detector;
  detector.objects_[1].odom_from_box.translation() << 10.0, -3.0, 0.8;
  detector.objects_[1].velocity << 8.0, 4.0, 0.0;
  Eigen::Isometry3d odom_from_world(Eigen::AngleAxisd(M_PI_2, Eigen::Vector3d::UnitY()));
  odom_from_world.pretranslate(Eigen::Vector3d(0.0, 0.0, 2.0));
  const MovingObject object = toMessage(detector, ros::Time(1.0), "odom", odom_from_world)->objects.at(1);
  EXPECT_NEAR(object.pose.position.x, 0.8, 1e-12);
  EXPECT_NEAR(object.pose.position.z, -8.0, 1e-12);
  EXPECT_NEAR(object.pose.orientation.y, std::sin(M_PI_4), 1e-12);
  EXPECT_NEAR(object.velocity.z, -8.0, 1e-12);
  EXPECT_EQ(object.velocity.y, 4.0);
}

TEST(ObjectMessages, SayAlsoThatNothingMoves) {
  TwoObjects detector;
  detector.reset();
  EXPECT_TRUE(toMessage(detector, ros::Time(1.0), "odom", Eigen::Isometry3d::Identity())->objects.empty());
}

}  // namespace
}  // namespace donex
