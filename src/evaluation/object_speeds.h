// How fast the labelled objects of a sequence move, from their instances alone.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "io/sequence.h"

namespace donex {

/// SemanticKITTI's instance of an echo; 0: no instance.
inline std::uint32_t instanceOfLabel(std::uint32_t label) { return label >> 16U; }

/// Speeds of instances over ground, from the centres of their echoes in the odometry frame. A whole label is an
/// instance: SemanticKITTI counts instances by class.
class ObjectSpeeds {
 public:
  ObjectSpeeds() = default;
  /// Reads each labelled scan once that the speeds in the first `scans` need. Throws DataError from the reader.
  ObjectSpeeds(const SequenceReader& sequence, std::size_t scans);

  /// Scans in the order of their stamps; echoes in the sensor frame.
  void add(double stamp, const Pose& odom_from_sensor, const std::vector<Eigen::Vector3f>& echoes,
           const std::vector<std::uint32_t>& labels);

  /// Speed [m/s] of the object with this label at a stamp: from its first to its last centre within kReach before and
  /// after. Empty for instance 0, an instance seen in only one scan, or a stamp at which it was not seen.
  std::optional<double> at(std::uint32_t label, double stamp) const;

  static constexpr double kReach = 0.55;  ///< [s]

 private:
  std::map<std::uint32_t, std::vector<std::pair<double, Eigen::Vector3d>>> centers_;  ///< by label: stamp, centre
};

}  // namespace donex
