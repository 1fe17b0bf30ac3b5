// De-skewing proved where it matters: scans distorted by a fast turn are labelled as well as undistorted ones.
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "ros/pipeline_rig.h"
#include "simulated_lidar/simulation_messages.h"
#include "simulation/disturbance.h"
#include "simulation/sensor_model.h"
#include "simulation/sweep.h"
#include "support/simulated_drive.h"

namespace donex {
namespace {

using simulation::Fixture;
using simulation::Mover;
using simulation::Path;
using simulation::Scene;
using simulation::SimulatedScan;

constexpr double kSpeed = 15.0;                    // [m/s]
constexpr double kTurnRate = 30.0 * M_PI / 180.0;  // [rad/s]
constexpr double kRadius = kSpeed / kTurnRate;     // of the ego vehicle's circle [m]
constexpr double kPeriod = 0.1;                    // of a turn of the sensor [s]
constexpr int kBeams = 32;
constexpr int kScans = 60;
constexpr int kWarmUp = 5;
constexpr double kOdometryStep = 0.01;  // [s]

std::shared_ptr<const Path> circle(double radius) {
  return std::make_shared<Path>(Path({radius, 0.0}, 0.5 * M_PI).arc(radius, 2.0 * M_PI).wrap());
}

void addBox(Scene& scene, const Eigen::Vector2d& place, const Eigen::Vector3f& half) {
  Fixture fixture;
  fixture.center = {place.x(), place.y(), static_cast<double>(half.z())};
  fixture.shape.half = half;
  fixture.label = 50;
  scene.fixtures.push_back(fixture);
}

void addCar(Scene& scene, const std::shared_ptr<const Path>& path, double start, double speed) {
  simulation::Random random(static_cast<std::uint64_t>(start));
  Mover mover;
  mover.model = simulation::makeCar(random);
  mover.course.path = path;
  mover.course.start = start;
  mover.course.speed = simulation::SpeedProfile(speed);
  scene.movers.push_back(mover);
}

/// A roundabout: the vehicle turns at 15 m/s and 30 deg/s between pillars and houses, cars on two other circles.
Scene roundabout() {
  Scene scene;
  simulation::GroundStyle style;
  style.waves = style.roughness = style.kerb_height = 0.0;
  scene.ground = simulation::Ground(style);
  scene.ego.course.path = circle(kRadius);
  scene.ego.course.speed = simulation::SpeedProfile(kSpeed);
  scene.ego.suspension = false;
  scene.ego.base_from_sensor.translation().z() = 1.8;
  for (int i = 0; i < 16; ++i) {
    const double angle = 2.0 * M_PI * i / 16.0;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    addBox(scene, 9.0 * direction, {0.3F, 0.3F, 1.5F});
    addBox(scene, 55.0 * direction, {5.0F, 5.0F, 4.0F});
  }
  for (int i = 0; i < 4; ++i) {
    addCar(scene, circle(20.0), 30.0 * i, 9.0);
    addCar(scene, circle(38.0), 55.0 * i + 10.0, 11.0);
  }
  return scene;
}

/// A drive through it as messages, labelled by the pipeline as a node's would be.
struct Drive {
  Drive(bool distortion, bool deskew, OdometrySource source = OdometrySource::kPose,
        const simulation::DisturbanceOptions& disturbance = {}) {
    const Scene scene = roundabout();
    const auto sensor = simulation::makeSensorModel(kBeams);
    simulation::SensorOptions options;
    options.distortion = distortion;
    simulation::Sweep sweep(scene, scene.ego.base_from_sensor, sensor, options);
    Config config;
    config.motion.deskew = deskew;
    config.motion.source = source;
    config.motion.odometry_refine = false;  // the poses are true
    tf2::BufferCore tf;
    tf.setTransform(mountingOf(scene.ego.base_from_sensor, 1.0, {}), "test", true);
    Pipeline pipeline(config, tf, events());
    for (int i = 0; i < kScans; ++i) {
      const double stamp = 10.0 + kPeriod * i;
      scan_.stamp = stamp;
      sweep.measure(stamp, static_cast<std::size_t>(i), scan_.echoes, scan_.labels);
      simulation::Disturbance(disturbance, 1).apply(static_cast<std::size_t>(i), scan_.echoes, scan_.labels);
      for (double time = stamp - kPeriod; time < stamp + 0.5 * kOdometryStep; time += kOdometryStep) {
        OdometrySample sample;
        sample.stamp = time;
        sample.odom_from_base = poseOf(scene.ego, scene.ground, time);
        pipeline.addOdometry(*toOdometry(sample, {}));
      }
      const auto cloud = toCloud(scan_, {});
      sent_ = *cloud;
      pipeline.addCloud(cloud, stamp);
      EXPECT_TRUE(pipeline.step(stamp)) << "scan " << i;
    }
    EXPECT_EQ(pipeline.counts().clouds_labeled, static_cast<std::size_t>(kScans));
  }

  testing::Score score;
  int moving = 0;  ///< echoes of moving objects

 private:
  PipelineEvents events() {
    PipelineEvents events;
    events.labeled = [this](const LabeledScan& scan) { judge(scan); };
    events.dropped = [](DropReason, const std::string& text) { ADD_FAILURE() << text; };
    events.refused = [](OdometryRefusal, const std::string&) {};  // scans share an odometry at their border
    events.forgotten = events.strange_times = [](const std::string& text) { ADD_FAILURE() << text; };
    return events;
  }

  void judge(const LabeledScan& scan) {
    expectOwnBytes(scan);
    if (++judged_ <= kWarmUp) return;
    testing::TrueScan truth{scan_.coreScan(), scan_.labels};
    score.add(truth, scan.labels);
    moving = score.right + score.missed;
  }

  void expectOwnBytes(const LabeledScan& scan) const {
    const auto out = labelCloud(*scan.cloud, scan.layout, scan.labels);
    ASSERT_EQ(out->width, sent_.width);
    for (std::size_t i = 0; i < out->width; ++i) {
      const bool same =
          std::memcmp(&out->data[i * out->point_step], &sent_.data[i * sent_.point_step], sent_.point_step) == 0;
      ASSERT_TRUE(same) << "echo " << i;
    }
  }

  SimulatedScan scan_;
  sensor_msgs::PointCloud2 sent_;  // a copy: what is published is compared with it
  int judged_ = 0;
};

TEST(DeskewedLabels, AreThoseOfUndistortedScans) {
  const Drive undistorted(false, true), deskewed(true, true), distorted(true, false);
  RecordProperty("iou_undistorted", std::to_string(undistorted.score.iou()));
  RecordProperty("iou_deskewed", std::to_string(deskewed.score.iou()));
  RecordProperty("iou_distorted", std::to_string(distorted.score.iou()));
  EXPECT_GT(undistorted.moving, 5000) << "echoes to be right about";
  EXPECT_GT(undistorted.score.iou(), 0.7);
  EXPECT_NEAR(deskewed.score.iou(), undistorted.score.iou(), 0.01);
  EXPECT_LT(distorted.score.iou(), deskewed.score.iou() - 0.05) << "the distortion matters";
}

TEST(DeskewedLabels, AreThoseOfUndistortedScansByAMotionFoundInThem) {
  constexpr OdometrySource kFromScans = OdometrySource::kLidar;
  const Drive undistorted(false, true), deskewed(true, true, kFromScans), distorted(true, false, kFromScans);
  RecordProperty("iou_deskewed", std::to_string(deskewed.score.iou()));
  RecordProperty("iou_distorted", std::to_string(distorted.score.iou()));
  EXPECT_NEAR(deskewed.score.iou(), undistorted.score.iou(), 0.02);
  EXPECT_LT(distorted.score.iou(), deskewed.score.iou() - 0.05) << "the distortion matters";
}

TEST(DeskewedLabels, SecondReturnsAreFoundBeforeTheirBeamsAreTurnedApart) {
  simulation::DisturbanceOptions dual;
  dual.dual_returns = 0.2;
  const Drive plain(true, true), disturbed(true, true, OdometrySource::kPose, dual);
  EXPECT_NEAR(disturbed.score.iou(), plain.score.iou(), 1e-3);
}

}  // namespace
}  // namespace donex
