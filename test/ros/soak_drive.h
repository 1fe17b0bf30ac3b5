// What both soaks share: how long, over which drive, and how the memory is watched.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>

#include "simulated_lidar/simulation_messages.h"
#include "simulation/simulator.h"

namespace donex::test {

/// As DONEX_SOAK_SCANS says (scripts/soak: 36,000), else `usual`.
inline std::size_t soakScans(std::size_t usual) {
  const char* text = std::getenv("DONEX_SOAK_SCANS");
  return text == nullptr ? usual : std::stoul(text);
}

/// A simulated street drive, forwards, backwards, forwards: the vehicle never jumps.
class SoakDrive {
 public:
  /// A thinned scan and the vehicle's pose at it.
  struct Piece {
    sensor_msgs::PointCloud2Ptr cloud;
    Eigen::Isometry3d odom_from_base;
  };

  SoakDrive(std::size_t scans, const SimulationFrames& frames) {
    simulation::SimulatorOptions options;
    options.beams = 16;
    options.duration = 0.0;
    simulation::Simulator simulator("street", options);
    simulation::SimulatedScan scan;
    while (pieces_.size() < std::clamp<std::size_t>(scans / 4, 2, 400) && simulator.next(scan)) {
      thin(scan);
      pieces_.push_back({toCloud(scan, frames), scan.odom_from_base});
    }
  }

  const Piece& at(std::size_t scan) const {
    const std::size_t turn = 2 * (pieces_.size() - 1), at = scan % turn;
    return pieces_[at < pieces_.size() ? at : turn - at];
  }

 private:
  static void thin(simulation::SimulatedScan& scan) {
    constexpr std::size_t kStride = 12;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < scan.echoes.size(); i += kStride, ++kept) {
      scan.echoes[kept] = scan.echoes[i];
      scan.labels[kept] = scan.labels[i];
    }
    scan.echoes.resize(kept);
    scan.labels.resize(kept);
  }

  std::vector<Piece> pieces_;
};

/// Resident memory over a soak. Large blocks go back to the system when they are freed: what stays resident is what is
/// held. (glibc would keep more and more of them for later, as the grid is built anew, which hides and imitates leaks.)
class MemoryWatch {
 public:
  MemoryWatch() { mallopt(M_MMAP_THRESHOLD, 128 * 1024); }

  /// Looks every hundredth time.
  void look() {
    if (looks_++ % 100 == 0) samples_.push_back(residentMegabytes());
  }
  /// Flat within 5 % from half-way on: before, what has the size of the largest scan or queue so far may grow.
  void expectFlat() const {
    constexpr std::size_t kLeast = 10000;  // looks; in fewer nothing has settled
    if (looks_ < kLeast) return;
    const double early = median(0.4, 0.5), late = median(0.9, 1.0);
    std::cout << "resident memory " << early << " MB half-way, " << late << " MB in the end\n";
    EXPECT_NEAR(late, early, 0.05 * early);
  }

 private:
  static double residentMegabytes() {
    std::ifstream statm("/proc/self/statm");
    double total = 0.0, resident = 0.0;
    statm >> total >> resident;
    return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
  }
  double median(double from, double to) const {
    const auto at = [&](double share) {
      return samples_.begin() + static_cast<long>(share * static_cast<double>(samples_.size()));
    };
    std::vector<double> part(at(from), at(to));
    std::nth_element(part.begin(), part.begin() + static_cast<long>(part.size() / 2), part.end());
    return part.at(part.size() / 2);
  }

  std::size_t looks_ = 0;
  std::vector<double> samples_;
};

}  // namespace donex::test
