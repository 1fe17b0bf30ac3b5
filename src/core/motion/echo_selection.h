// Which of a scan's echoes are registered, and which go into the map.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/motion/echo_thinning.h"

namespace donex {

/// Leaves out the vehicle itself, what is far away and what is no number, and thins the rest. Keeps its memory.
class EchoSelection {
 public:
  struct Options {
    float farthest = 100.0F;          ///< echoes beyond are left out [m]
    float nearest_share = 0.25F;      ///< nearer than this share of the median range is the vehicle itself, within
    float nearest_least = 0.4F;       ///< this [m]
    float nearest_most = 2.5F;        ///< and this [m]
    float map_edge = 0.2F;            ///< one echo in each such voxel goes into the map [m]
    std::size_t least_source = 1000;  ///< echoes to register: the largest of the edges that leaves so many
    std::vector<float> source_edges{1.0F, 0.7F, 0.5F, 0.35F, 0.25F, 0.2F};  ///< falling [m]
  };

  EchoSelection() = default;
  explicit EchoSelection(const Options& options) : options_(options) {}

  void select(const std::vector<Eigen::Vector3f>& echoes);

  /// Indices of the echoes for the map, and of those of them to register.
  const std::vector<std::uint32_t>& forMap() const { return for_map_; }
  const std::vector<std::uint32_t>& toRegister() const { return to_register_; }

  /// Leaves out of `for_map`, the scan's echoes for the map in that order, those that are labelled as moving; `dynamic`
  /// has a label per echo of the scan. Throws std::invalid_argument for any other number of labels.
  void leaveOutMoving(const std::vector<std::uint8_t>& dynamic, std::vector<Eigen::Vector3f>& for_map) const;

  std::size_t memoryBytes() const;

 private:
  float nearestOf(const std::vector<Eigen::Vector3f>& echoes);

  Options options_;
  EchoThinning thinning_;
  std::size_t echoes_ = 0;  // of the scan
  std::vector<float> ranges_;
  std::vector<std::uint32_t> usable_, for_map_, to_register_;
};

}  // namespace donex
