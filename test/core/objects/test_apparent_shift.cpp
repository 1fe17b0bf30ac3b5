// What the poses got wrong, read from what stands.
#include <random>

#include <gtest/gtest.h>

#include "core/objects/apparent_shift.h"
#include "core/pi.h"

namespace donex {
namespace {

const Eigen::Vector3d kSensor(200.0, -50.0, 1.8);

/// Boxes around the sensor in two scans.
class Boxes {
 public:
  Boxes(std::size_t count, double noise, unsigned seed = 1) : random_(seed), noise_(0.0, noise) {
    std::uniform_real_distribution<double> around(-30.0, 30.0), size(0.5, 4.0);
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3d low = kSensor + Eigen::Vector3d(around(random_), around(random_), -1.5);
      Trace then;
      then.low = low;
      then.high = low + Eigen::Vector3d(size(random_), size(random_), 1.5);
      boxes_.push_back(then);
    }
  }

  /// The first of them have moved by themselves.
  ApparentShift seenAfter(const Eigen::Isometry3d& world, std::size_t moving = 0,
                          const Eigen::Vector3d& motion = Eigen::Vector3d(0.3, 0.0, 0.0)) {
    ApparentShift shift;
    shift.begin(kSensor);
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      const Trace& then = boxes_[i];
      const Eigen::Vector3d by =
          world * then.center() - then.center() + (i < moving ? motion : Eigen::Vector3d::Zero());
      Segment now;
      now.low = then.low + by + fray();
      now.high = then.high + by + fray();
      shift.add(then, now);
    }
    shift.solve();
    return shift;
  }

 private:
  Eigen::Vector3d fray() { return {noise_(random_), noise_(random_), noise_(random_)}; }

  std::mt19937 random_;
  std::normal_distribution<double> noise_;
  std::vector<Trace> boxes_;
};

/// About the sensor [m, degrees].
Eigen::Isometry3d worldShift(double x, double y, double yaw) {
  Eigen::Isometry3d shift = Eigen::Isometry3d::Identity();
  shift.translate(kSensor + Eigen::Vector3d(x, y, 0.0));
  shift.rotate(Eigen::AngleAxisd(yaw * kRadiansPerDegree, Eigen::Vector3d::UnitZ()));
  shift.translate(-kSensor);
  return shift;
}

TEST(ApparentShift, IsWhatMostBoxesAgreeOn) {
  for (const double yaw : {-0.4, 0.0, 0.3}) {
    const Eigen::Isometry3d world = worldShift(0.11, -0.08, yaw);
    const ApparentShift shift = Boxes(30, 0.02).seenAfter(world, 6);
    EXPECT_TRUE(shift.isKnown());
    for (const Eigen::Vector3d& away : {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(20.0, 10.0, 1.0)}) {
      const Eigen::Vector3d place = kSensor + away;
      EXPECT_LT((shift.nowFromThen() * place - world * place).norm(), 0.03) << yaw << " degrees, " << away.transpose();
    }
  }
}

TEST(ApparentShift, IsNoneWhereThePosesAreRight) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const ApparentShift shift = Boxes(20, 0.03, seed).seenAfter(Eigen::Isometry3d::Identity(), 5);
    EXPECT_TRUE(shift.isKnown());
    EXPECT_TRUE(shift.nowFromThen().isApprox(Eigen::Isometry3d::Identity(), 1e-12)) << "seed " << seed;
  }
}

TEST(ApparentShift, AQueueThatCreepsIsNotTheWorld) {
  const ApparentShift shift = Boxes(30, 0.02).seenAfter(Eigen::Isometry3d::Identity(), 12);
  EXPECT_TRUE(shift.isKnown());
  EXPECT_TRUE(shift.nowFromThen().isApprox(Eigen::Isometry3d::Identity(), 1e-12));
}

TEST(ApparentShift, IsNotKnownFromFewBoxesNorWhereNoneAgree) {
  EXPECT_FALSE(Boxes(5, 0.02).seenAfter(worldShift(0.1, 0.0, 0.0)).isKnown());
  const ApparentShift shift = Boxes(30, 0.3).seenAfter(worldShift(0.1, 0.0, 0.0));
  EXPECT_FALSE(shift.isKnown());
  EXPECT_TRUE(shift.nowFromThen().isApprox(Eigen::Isometry3d::Identity(), 1e-12));
}

TEST(ApparentShift, BeginsAnew) {
  ApparentShift shift = Boxes(30, 0.02).seenAfter(worldShift(0.2, 0.0, 0.0));
  ASSERT_TRUE(shift.isKnown());
  shift.begin(kSensor);
  shift.solve();
  EXPECT_FALSE(shift.isKnown());
  EXPECT_TRUE(shift.nowFromThen().isApprox(Eigen::Isometry3d::Identity(), 1e-12));
}

}  // namespace
}  // namespace donex
