// Directions as pixels: where in a sight image an echo lies.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "core/azimuth.h"
#include "core/grid/simd.h"
#include "core/grid/storage.h"
#include "core/grid/workers.h"
#include "core/pi.h"

namespace donex {

/// The pixels of the echoes of a cloud, around the origin of the frame they are given in.
class SightPixels {
 public:
  static constexpr int kColumns = 1024;        ///< a power of two: azimuth wraps by masking
  static constexpr float kRowHeight = 0.006F;  ///< tangent of the elevation
  static constexpr float kSteepest = 1.2F;     ///< tangent beyond which nothing is asked
  static constexpr float kNearest = 0.3F;      ///< [m] nothing is asked nearer to the sensor's axis
  static constexpr float kFarthest = 1e6F;     ///< [m] nor farther away: infinity has no azimuth
  static constexpr float kRangeStep = 0.02F;   ///< [m]
  static constexpr int kRows = static_cast<int>(2.0F * kSteepest / kRowHeight) + 1;

  /// Of one point [m]. Column and row are 0 where it is not valid: nothing is asked so near to the sensor's axis, so
  /// far from it, or so steeply.
  struct Pixel {
    bool valid;
    int column, row;
    float range;  ///< [m]
  };
  static Pixel of(float x, float y, float z);
  static Pixel of(const Eigen::Vector3f& point) { return of(point.x(), point.y(), point.z()); }

  /// Takes the echoes [m] of a cloud; those with `is_echo` 0 are left out.
  void project(const std::vector<Eigen::Vector3f>& echoes, const std::vector<std::uint8_t>& is_echo,
               const Workers& workers = Workers::alone());
  /// The same in another frame.
  void project(const std::vector<Eigen::Vector3f>& echoes, const std::vector<std::uint8_t>& is_echo,
               const Eigen::Isometry3f& frame_from_echoes);

  std::size_t size() const { return columns_.size(); }
  int column(std::size_t echo) const { return columns_[echo]; }
  int row(std::size_t echo) const { return rows_[echo]; }        ///< -1 where the echo lies nowhere
  float range(std::size_t echo) const { return ranges_[echo]; }  ///< [kRangeStep], 1 to 65535
  /// From the lowest to the highest row that holds an echo; where there is none, the lowest one is above the highest.
  struct Span {
    int lowest, highest;
  };
  Span span() const;

  std::size_t memoryBytes() const {
    return 3 * columns_.capacity() * sizeof(float) + moved_.capacity() * sizeof(Eigen::Vector3f);
  }
  /// What memoryBytes will be for so many echoes of whole turns [bytes].
  static double bytesFor(double echoes) { return roomFor(3.0 * sizeof(float) * echoes); }

 private:
  void resize(std::size_t count) {
    resizeTo(columns_, count);
    resizeTo(rows_, count);
    resizeTo(ranges_, count);
  }

  std::vector<std::int32_t> columns_, rows_;
  std::vector<float> ranges_;
  std::vector<Eigen::Vector3f> moved_;  ///< echoes of a part, in the frame of its turn
};

/// Loops over it are wide only where nothing in it is a branch: compilers make branches of what is computed in one case
/// alone, so that everything here is computed in any case.
inline SightPixels::Pixel SightPixels::of(float x, float y, float z) {
  const float horizontal = std::sqrt(x * x + y * y);
  const float slope = z / horizontal;
  const bool valid = static_cast<int>(horizontal > kNearest) & static_cast<int>(horizontal < kFarthest) &
                     static_cast<int>(std::abs(slope) < kSteepest);
  const float turn = (azimuthOf(y, x) + kPiF) * (kColumns / (2.0F * kPiF));
  const float rise = (slope + kSteepest) / kRowHeight;
  const int column = static_cast<int>(clampedTo(0.0F, kColumns, turn)) & (kColumns - 1);
  const int row = static_cast<int>(clampedTo(0.0F, kRows, rise));
  const int everything = -static_cast<int>(valid);  // all bits, or none
  return {valid, column & everything, row & everything, std::sqrt(horizontal * horizontal + z * z)};
}

}  // namespace donex
