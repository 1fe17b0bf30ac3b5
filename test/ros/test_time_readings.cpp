// Echo times that do not count from the stamp as they are written, clouds that carry none, and clouds that were
// de-skewed before: found from the scans of a vehicle that turns at 30 degrees a second, and labelled as well as if
// nobody had made a mistake.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <deque>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "donex/motion/deskew.h"
#include "ros/pipeline_rig.h"
#include "simulated_lidar/simulation_messages.h"
#include "support/simulated_drive.h"

namespace donex {
namespace {

using simulation::SimulatedScan;

constexpr double kTurn = 0.1;         // of the sensor [s]
constexpr int kScans = 120;           // of the drive
constexpr int kJudged = 15;           // the last ones: by then the reading is known
constexpr double kFarthestOff = 0.1;  // IoU below that of the drive without a mistake

/// What a cloud tells of its echoes' times: these, or by the order of the echoes.
enum class Order { kTimed, kFirings, kRings, kNone };

struct Mistake {
  const char* name;
  double stamp_shift;   ///< [s]; rightly, the stamp is the scan's end
  float factor, shift;  ///< of the times, which rightly end with 0 [s]
  bool is_deskewed_before;
  const char* finding;  ///< part of what is said; empty for nothing
  Order order = Order::kTimed;
};

class MistakenDrive {
 public:
  explicit MistakenDrive(const Mistake& mistake) : pipeline_({}, tf_, events()) {
    simulation::SimulatorOptions options;
    options.duration = kTurn * kScans;
    options.start_stamp = 10.0;
    options.distortion = true;
    options.beams = 32;
    simulation::Simulator simulator("turning", options);
    tf_.setTransform(mountingOf(simulator.baseFromSensor(), 1.0, {}), "test", true);
    SimulatedScan scan;
    while (simulator.next(scan)) {
      for (const OdometrySample& sample : scan.odometry) pipeline_.addOdometry(*toOdometry(sample, {}));
      arrange(scan, mistake.order);
      truth_.push_back({scan.coreScan(), scan.labels});
      if (mistake.is_deskewed_before) deskewBefore(simulator, scan);
      for (auto& echo : scan.echoes) echo.time = mistake.factor * echo.time + mistake.shift;
      scan.stamp += mistake.stamp_shift;
      pipeline_.addCloud(cloudOf(scan, mistake.order), scan.stamp);
      while (pipeline_.step(scan.stamp)) {
      }
    }
    pipeline_.finish();
  }

  double iou() const { return score_.iou(); }
  const std::string& finding() const { return finding_; }
  std::string deskewedBy() const { return pipeline_.deskewedBy(); }

 private:
  /// Ring by ring, as converters write, or without any order; else as they were measured.
  static void arrange(SimulatedScan& scan, Order order) {
    const SimulatedScan measured = scan;
    std::vector<std::size_t> from(scan.echoes.size());
    std::iota(from.begin(), from.end(), std::size_t{0});
    if (order == Order::kNone) std::shuffle(from.begin(), from.end(), std::minstd_rand());
    if (order == Order::kRings) {
      std::stable_sort(from.begin(), from.end(),
                       [&](std::size_t a, std::size_t b) { return measured.echoes[a].ring < measured.echoes[b].ring; });
    }
    for (std::size_t i = 0; i < from.size(); ++i) {
      scan.echoes[i] = measured.echoes[from[i]];
      scan.labels[i] = measured.labels[from[i]];
    }
  }

  static sensor_msgs::PointCloud2Ptr cloudOf(const SimulatedScan& scan, Order order) {
    const auto cloud = toCloud(scan, {});
    if (order == Order::kTimed) return cloud;
    for (auto& field : cloud->fields) field.name = field.name == "time" ? "unused" : field.name;
    return cloud;
  }

  static void deskewBefore(const simulation::Simulator& simulator, SimulatedScan& scan) {
    EgoMotion motion;
    for (double stamp = scan.stamp - 1.2 * kTurn; stamp < scan.stamp + 0.015; stamp += 0.01) {
      OdometrySample sample;
      sample.stamp = stamp;
      sample.odom_from_base = simulator.odomFromBase(stamp);
      motion.add(sample);
    }
    std::vector<Eigen::Vector3f> echoes;
    std::vector<float> times;
    for (const auto& echo : scan.echoes) {
      echoes.push_back(echo.position);
      times.push_back(echo.time);
    }
    ASSERT_EQ(deskew(motion, scan.stamp, simulator.baseFromSensor(), times, echoes), MotionFault::kNone);
    for (std::size_t i = 0; i < echoes.size(); ++i) scan.echoes[i].position = echoes[i];
  }

  PipelineEvents events() {
    PipelineEvents events;
    events.labeled = [this](const LabeledScan& scan) { judge(scan.labels); };
    events.dropped = [this](DropReason, const std::string&) { truth_.pop_front(); };  // the last, not covered
    events.refused = [](OdometryRefusal, const std::string&) {};
    events.forgotten = [](const std::string&) {};
    events.strange_times = [](const std::string&) {};
    events.reading_found = [this](const std::string& text) { finding_ = text; };
    return events;
  }

  void judge(const EchoLabels& labels) {
    if (++judged_ > kScans - kJudged) score_.add(truth_.front(), labels);
    truth_.pop_front();
  }

  tf2::BufferCore tf_;
  std::deque<testing::TrueScan> truth_;  // of the clouds that wait
  testing::Score score_;
  int judged_ = 0;
  std::string finding_;
  Pipeline pipeline_;
};

class Reading : public ::testing::TestWithParam<Mistake> {};

TEST_P(Reading, IsFoundAndTheLabelsAreRight) {
  static const double right = MistakenDrive({"", 0.0, 1.0F, 0.0F, false, ""}).iou();
  const Mistake& mistake = GetParam();
  const MistakenDrive drive(mistake);
  const bool is_said = *mistake.finding != '\0';
  EXPECT_EQ(is_said, !drive.finding().empty()) << drive.finding();
  EXPECT_NE(drive.finding().find(mistake.finding), std::string::npos) << drive.finding();
  EXPECT_GT(drive.iou(), right - kFarthestOff) << "without a mistake it is " << right;
}

TEST(ShuffledClouds, DoNotTellHowTheSensorTurned) {
  const MistakenDrive drive({"", 0.0, 1.0F, 0.0F, false, "", Order::kNone});
  EXPECT_EQ(drive.finding(), "");
  EXPECT_NE(drive.deskewedBy().find("the order of the echoes does not tell"), std::string::npos) << drive.deskewedBy();
}

constexpr float kSpan = static_cast<float>(kTurn);

INSTANTIATE_TEST_SUITE_P(
    OfATurningVehicle, Reading,
    ::testing::Values(Mistake{"none", 0.0, 1.0F, 0.0F, false, ""},
                      Mistake{"none, stamped at the begin", -kTurn, 1.0F, kSpan, false, ""},
                      Mistake{"stamp at the end, times from the begin", 0.0, 1.0F, kSpan, false, "earlier"},
                      Mistake{"stamp at the begin, times to the end", -kTurn, 1.0F, 0.0F, false, "later"},
                      Mistake{"times counted backwards", 0.0, -1.0F, 0.0F, false, "backwards"},
                      Mistake{"de-skewed before", 0.0, 1.0F, 0.0F, true, "undone already"},
                      Mistake{"no times", 0.0, 1.0F, 0.0F, false, "scan's end", Order::kFirings},
                      Mistake{"no times, stamped at the begin", -kTurn, 1.0F, 0.0F, false, "scan's begin",
                              Order::kFirings},
                      Mistake{"no times, ring by ring", 0.0, 1.0F, 0.0F, false, "scan's end", Order::kRings},
                      Mistake{"no times, de-skewed before", 0.0, 1.0F, 0.0F, true, "", Order::kFirings}),
    [](const auto& run) {
      std::string name;
      for (const char letter : std::string(run.param.name))
        name += std::isalpha(static_cast<unsigned char>(letter)) != 0 ? letter : '_';
      return name;
    });

}  // namespace
}  // namespace donex
