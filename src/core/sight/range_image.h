// Ranges by direction: one scan as its sensor saw it, the nearest echo of each pixel.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace donex {

/// A spherical image around an origin. Every length is in the unit of the points that are added.
class RangeImage {
 public:
  struct Resolution {
    double column = 0.17578125;  ///< [deg] 2048 columns, as the range images of the learned methods have
    double row = 0.4375;         ///< [deg] 64 rows over the 28 degrees of an HDL-64E
  };

  RangeImage() : RangeImage(Resolution()) {}
  explicit RangeImage(const Resolution& resolution);

  void clear();

  /// Keeps the nearest point of each pixel. Points that are not finite, in the origin or steeper than
  /// kSteepestElevation are left out.
  void add(const Eigen::Vector3f& point);

  /// Range of the pixel in which `point` lies; 0 where nothing was seen.
  float rangeTowards(const Eigen::Vector3f& point) const;

  std::size_t memoryBytes() const { return (ranges_.capacity() + used_.capacity()) * sizeof(float); }

  static constexpr double kSteepestElevation = 60.0;  ///< elevation, up or down [deg]

 private:
  static constexpr int kNone = -1;
  int pixelOf(const Eigen::Vector3f& point) const;

  int columns_, rows_;
  float columns_a_radian_, rows_a_radian_;
  std::vector<float> ranges_;  ///< by row, then column
  std::vector<int> used_;
};

}  // namespace donex
