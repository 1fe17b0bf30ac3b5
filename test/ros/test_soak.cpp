// Hours of driving in minutes: a simulated drive again and again, with whatever goes wrong in a vehicle thrown in at
// random. No crash, every scan accounted for, memory flat. DONEX_SOAK_SCANS says how many (scripts/soak: 36,000).
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <numeric>
#include <random>

#include <gtest/gtest.h>
#include <unistd.h>

#include "donex/ros/simulation_messages.h"
#include "donex/simulation/simulator.h"
#include "ros/pipeline_rig.h"

namespace donex {
namespace {

using test::PipelineRig;

constexpr double kPeriod = 0.1;                 // [s]
constexpr std::size_t kStride = 12;             // every so many-th echo
constexpr std::size_t kLeastForMemory = 10000;  // scans; before, memory is still being warmed up

std::size_t scansWanted() {
  const char* text = std::getenv("DONEX_SOAK_SCANS");
  return text == nullptr ? 500 : std::stoul(text);
}

double residentMegabytes() {
  std::ifstream statm("/proc/self/statm");
  double total = 0.0, resident = 0.0;
  statm >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

/// A piece of the drive: a thinned scan and the vehicle's pose at it.
struct Piece {
  sensor_msgs::PointCloud2Ptr cloud;
  Eigen::Isometry3d odom_from_base;
};

std::vector<Piece> drivePieces(std::size_t scans) {
  simulation::SimulatorOptions options;
  options.beams = 16;
  options.duration = 0.0;
  simulation::Simulator simulator("street", options);
  std::vector<Piece> pieces;
  simulation::SimulatedScan scan;
  while (pieces.size() < scans && simulator.next(scan)) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < scan.echoes.size(); i += kStride, ++kept) {
      scan.echoes[kept] = scan.echoes[i];
      scan.labels[kept] = scan.labels[i];
    }
    scan.echoes.resize(kept);
    scan.labels.resize(kept);
    pieces.push_back({toCloud(scan, {}), scan.odom_from_base});
  }
  return pieces;
}

class Soak {
 public:
  explicit Soak(std::size_t scans)
      : scans_(scans), pieces_(drivePieces(std::clamp<std::size_t>(scans / 4, 2, 400))), rig_(configOf(0.3), false) {
    rig_.tf.setTransform(mountingOf(Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 1.8)), 1.0, {}), "soak", true);
  }

  void run() {
    for (std::size_t scan = 0; scan < scans_; ++scan) {
      now_ += kPeriod;
      jumpInTime();
      disturb();
      sendOdometry(pieceOf(scan));
      sendCloud(pieceOf(scan));
      if (!chance(0.02)) rig_.run(now_);  // else it is busy, and the next ones pile up
      forgetNotes();
      if (scan % 100 == 0) memory_.push_back(residentMegabytes());
    }
    rig_.pipeline.finish();
  }

  const PipelineCounts& counts() const { return rig_.pipeline.counts(); }
  std::size_t sent() const { return sent_; }
  /// Median of a part of the samples of resident memory [MB].
  double memory(double from, double to) const {
    const auto at = [&](double share) {
      return memory_.begin() + static_cast<long>(share * static_cast<double>(memory_.size()));
    };
    std::vector<double> part(at(from), at(to));
    std::nth_element(part.begin(), part.begin() + static_cast<long>(part.size() / 2), part.end());
    return part.at(part.size() / 2);
  }

 private:
  static Config configOf(double voxel_size) {
    Config config;
    config.region = {-30.0, 30.0, -30.0, 30.0, -3.0, 5.0};
    config.voxel_size = voxel_size;
    return config;
  }
  bool chance(double probability) { return std::uniform_real_distribution<double>(0.0, 1.0)(random_) < probability; }

  /// Forwards, backwards, forwards: the vehicle never jumps.
  const Piece& pieceOf(std::size_t scan) const {
    const std::size_t turn = 2 * (pieces_.size() - 1), at = scan % turn;
    return pieces_[at < pieces_.size() ? at : turn - at];
  }
  void jumpInTime() {
    if (chance(0.001)) now_ -= 50.0;
    if (chance(0.001)) now_ += 50.0;
    if (chance(0.003)) odometry_lost_until_ = now_ + 3.0;
  }
  void disturb() {
    if (chance(0.002)) rig_.pipeline.reset();
    if (chance(0.002)) rig_.pipeline.configure(configOf(0.35));
    if (chance(0.01)) rig_.pipeline.configure(configOf(0.3));
    if (chance(0.005)) add(test::CloudBuilder().field("x", test::PointField::INT8).size(3).build());
    if (chance(0.005)) add(test::plainCloud(test::ring(), now_, "nobody_knows"));
    if (chance(0.005)) add(test::plainCloud({}, now_ - 0.03, "velodyne"));
  }
  void sendOdometry(const Piece& piece) {
    const bool is_lost = now_ < odometry_lost_until_ && now_ > odometry_lost_until_ - 10.0;
    if (is_lost) return;
    OdometrySample sample;
    sample.stamp = now_ - (chance(0.02) ? 0.3 : 0.0);
    sample.odom_from_base = piece.odom_from_base;
    if (chance(0.01)) sample.odom_from_base.translation().x() = std::nan("");
    rig_.pipeline.addOdometry(*toOdometry(sample, {}));
    if (chance(0.02)) rig_.pipeline.addOdometry(*toOdometry(sample, {}));
  }
  void sendCloud(const Piece& piece) {
    auto cloud = boost::make_shared<sensor_msgs::PointCloud2>(*piece.cloud);
    cloud->header.stamp.fromSec(now_ - (chance(0.01) ? 0.25 : 0.0));
    if (chance(0.01)) cloud->data.resize(cloud->data.size() / 2);
    add(cloud);
    if (chance(0.01)) add(cloud);
  }
  void add(const sensor_msgs::PointCloud2ConstPtr& cloud) {
    ++sent_;
    rig_.pipeline.addCloud(cloud, now_);
  }
  /// The rig writes down everything: here that would be a leak of its own.
  void forgetNotes() {
    rig_.labeled.clear();
    for (auto* notes : {&rig_.drops, &rig_.refusals, &rig_.forgotten, &rig_.strange_times}) notes->clear();
  }

  std::size_t scans_, sent_ = 0;
  std::mt19937 random_{7};
  std::vector<Piece> pieces_;
  PipelineRig rig_;
  double now_ = 1e6, odometry_lost_until_ = 0.0;
  std::vector<double> memory_;
};

void printCounts(const PipelineCounts& counts) {
  std::cout << counts.clouds_in << " scans in, " << counts.clouds_labeled << " labelled, " << counts.dropped.total()
            << " dropped:\n";
  for (std::size_t i = 0; i < kDropReasons; ++i) {
    const auto reason = static_cast<DropReason>(i);
    std::cout << "  " << describe(reason) << ": " << counts.dropped.of(reason) << "\n";
  }
}

TEST(Soak, everyScanIsAccountedForAndMemoryStaysFlat) {
  const std::size_t scans = scansWanted();
  Soak soak(scans);
  soak.run();
  const PipelineCounts& counts = soak.counts();
  printCounts(counts);
  EXPECT_EQ(counts.clouds_in, soak.sent());
  EXPECT_EQ(counts.clouds_labeled + counts.dropped.total(), counts.clouds_in);
  EXPECT_EQ(counts.dropped.of(DropReason::kInternalError), 0U);
  EXPECT_GT(counts.clouds_labeled, scans / 2);
  if (scans < kLeastForMemory) return;
  const double early = soak.memory(0.1, 0.2), late = soak.memory(0.9, 1.0);
  std::cout << "resident memory " << early << " MB after a tenth, " << late << " MB in the end\n";
  EXPECT_NEAR(late, early, 0.05 * early);
}

}  // namespace
}  // namespace donex
