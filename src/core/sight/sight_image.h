// How far one scan saw in every direction: the space it proves to be free, read carefully.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/grid/storage.h"

namespace donex {

/// The lines of sight of a scan as an image of ranges around the sensor (algorithm: "Free
/// evidence", "Careful sight"). A pixel holds the nearest range of its direction; "free" needs a surface behind the
/// asked point, never the mere absence of an echo (the sky, a dark car).
///
/// Careful reading, as one minimum per pixel:
///  - between two beams the nearer one counts, up to `largest_gap` apart: sparse sensors leave no holes;
///  - the nearest range among the pixels around counts: a line of sight that grazes a surface frees nothing there.
class SightImage {
 public:
  struct Reading {
    bool careful = true;
    double largest_gap = 0.038;  ///< tangent of the angle between two beams that are read as neighbours
  };

  /// `echoes` in the sensor's frame [m]; those with `is_echo` 0 are left out.
  void build(const std::vector<Eigen::Vector3f>& echoes, const std::vector<std::uint8_t>& is_echo,
             const Reading& reading);

  /// Hands on to a later scan's image what its build needs: storage that answers do not, and that for single lines of
  /// sight, which this one is not asked for any more.
  void handOn(SightImage& later) {
    later.scratch_ = std::move(scratch_);
    later.pixels_ = std::move(pixels_);
    later.hit_ = std::move(hit_);
  }

  enum class Sight { kUnknown, kFree, kSurface, kHidden };

  /// What the scan says of a point of its sensor frame [m]: free where it saw at least `margin` [m]
  /// beyond, surface within the margin, hidden behind one, or nothing known.
  Sight at(const Eigen::Vector3f& point, float margin) const;

  /// The same of the single lines of sight, not read carefully; unknown once they were handed on.
  Sight throughGaps(const Eigen::Vector3f& point, float margin) const;

  std::size_t memoryBytes() const;
  /// What an image's answers take, whatever the sensor covers [bytes]: it is reserved, and only what it covers is used.
  static double answerBytes();
  /// What the newest image has besides for so many echoes [bytes].
  static double workspaceBytes(double echoes);

 private:
  /// By echo: where it lies in the image; row -1 where nowhere.
  struct Pixels {
    std::vector<std::int32_t> columns, rows;
    std::vector<float> ranges;  ///< [kRangeStep]

    void resize(std::size_t count) {
      resizeTo(columns, count);
      resizeTo(rows, count);
      resizeTo(ranges, count);
    }
    std::size_t bytes() const { return 3 * columns.capacity() * sizeof(float); }
  };

  using Range = std::uint16_t;  ///< [kRangeStep], rounded down; 0 where nothing is known

  Sight read(const std::vector<Range>& image, const Eigen::Vector3f& point, float margin) const;
  void collect(const std::vector<Eigen::Vector3f>& echoes, const std::vector<std::uint8_t>& is_echo);
  void fillBetweenBeams(int largest_gap);
  void fillBetweenColumns();
  void erode();

  int first_row_ = 0, rows_ = 0;  ///< the part of the image that the sensor covers
  std::vector<Range> nearest_;    ///< by column, then row
  std::vector<Range> hit_;        ///< the same, of single lines of sight
  std::vector<Range> scratch_;
  Pixels pixels_;
};

}  // namespace donex
