// How far a line of sight proves free space: not into the surface that it ends on (Schauer & Nüchter 2018).
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace donex {

/// Point shadows, the publication's remedy against false positives near surfaces. Echoes are taken from the nearest
/// on. One that is in no shadow yet gets a plane, fitted to the echoes under the angle of a voxel and raised towards
/// the sensor by a voxel's diagonal and `fuzz`; its own line of sight, and those of all echoes under that angle that
/// lie behind the plane, end where they meet it.
class PointShadows {
 public:
  PointShadows(float diagonal, float fuzz) : diagonal_(diagonal), fuzz_(fuzz) {}

  /// `echoes` in the sensor's frame [m]; those with `is_echo` 0 are left out. One entry per echo: how far its line of
  /// sight may be followed [m], 0 for not at all.
  const std::vector<float>& cast(const std::vector<Eigen::Vector3f>& echoes, const std::vector<std::uint8_t>& is_echo);

  /// The angle around an echo `range` away under which the other echoes are taken [rad]: twice that of a voxel's
  /// diagonal at the near side of the voxel's circumsphere; the whole sphere where the sensor lies in it.
  static double angleAt(double range, double diagonal);

  std::size_t memoryBytes() const;

 private:
  void sortByDirection(const std::vector<Eigen::Vector3f>& echoes, const std::vector<std::uint8_t>& is_echo);
  void search(std::uint32_t echo, double angle);
  Eigen::Vector3d normalOf(const std::vector<Eigen::Vector3f>& echoes, std::uint32_t echo) const;
  void shade(const std::vector<Eigen::Vector3f>& echoes, std::uint32_t echo, const Eigen::Vector3d& normal);

  float diagonal_, fuzz_;
  std::vector<Eigen::Vector3d> directions_;
  std::vector<double> ranges_;
  std::vector<std::uint32_t> first_, sorted_, bin_of_;  ///< echoes by bins of direction
  std::vector<std::uint32_t> by_range_;
  std::vector<std::uint32_t> found_;  ///< by the last search, in rising order
  std::vector<float> most_;
};

}  // namespace donex
