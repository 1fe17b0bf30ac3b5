// How far a sensor saw in every direction during one turn: the space it proves to be free, read carefully.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/sight/beam_spacing.h"
#include "core/sight/sight_pixels.h"

namespace donex {

/// The lines of sight of a turn as an image of ranges around the sensor (algorithm: "Free
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

  /// Storage for the steps of reading carefully; it holds nothing in between.
  struct Workspace {
    std::vector<std::uint16_t> beams, between, upright;

    std::size_t memoryBytes() const {
      return (beams.capacity() + between.capacity() + upright.capacity()) * sizeof(std::uint16_t);
    }
  };

  SightImage() = default;
  /// Moved, never copied: with Eigen 3.3 a vector of what also holds a pose would copy its elements as it grows, and
  /// copies lack the reserved storage.
  SightImage(SightImage&&) = default;
  SightImage& operator=(SightImage&&) = default;

  /// Forgets everything.
  void clear();
  /// Adds what a cloud saw, given in the image's own frame. A cloud may be any part of what the sensor sees: directions
  /// that no cloud covers say nothing, and parts that are added one by one make the same image as all of them at once.
  void add(const SightPixels& seen, const Reading& reading, Workspace& workspace);

  /// The turn is over: how far apart its beams lie is known from now on. While single lines of sight are asked.
  void measureBeams() { beams_.measure(hit_, first_row_, rows_); }
  const BeamSpacing& beams() const { return beams_; }
  /// Columns that anything came back from, or beside one.
  std::size_t coveredColumns() const;
  /// How far apart the two beams lie that a place is between [m]; 0 before they are measured.
  float beamsApart(const SightPixels::Pixel& pixel) const { return pixel.range * beams_.at(pixel.row); }

  /// Whether anything came back from about the direction of a point of the image's frame [m].
  bool looksAt(const Eigen::Vector3f& point) const;
  /// Whether a pixel is in the field of view, from the lowest beam to the highest; to be asked when the turn is over.
  bool sees(const SightPixels::Pixel& pixel) const {
    const SightPixels::Span rows = beams_.span();
    return pixel.valid && covered_[static_cast<std::size_t>(pixel.column)] != 0 && pixel.row >= rows.lowest &&
           pixel.row <= rows.highest;
  }

  /// Single lines of sight are not asked for any more: gives their storage to a later image. False where it has none.
  bool handOn(SightImage& later) {
    if (hit_.capacity() == 0) return false;
    later.hit_.swap(hit_);
    hit_ = {};
    return true;
  }

  /// What is known lies in the order of the ranges seen, from beyond the point to before it.
  enum class Sight { kUnknown, kFree, kSurface, kHidden };

  /// What the scan says of a point of its sensor frame [m]: free where it saw at least `margin` [m]
  /// beyond, surface within the margin, hidden behind one, or nothing known.
  Sight at(const Eigen::Vector3f& point, float margin) const { return atPixel(SightPixels::of(point), margin); }
  Sight atPixel(const SightPixels::Pixel& pixel, float margin) const { return read(nearest_, pixel, margin); }

  /// The same of the single lines of sight, not read carefully; unknown once they were handed on.
  Sight throughGaps(const Eigen::Vector3f& point, float margin) const {
    return read(hit_, SightPixels::of(point), margin);
  }

  /// The same of the beam closest above or below, up to `rows` away: what it hits is seen to go on between beams.
  Sight ofNearestBeam(const Eigen::Vector3f& point, float margin, int rows) const;

  std::size_t memoryBytes() const;
  /// What an image's answers take, whatever the sensor covers [bytes]: it is reserved, and only what it covers is used.
  static double answerBytes();
  /// What a Workspace takes [bytes].
  static double workspaceBytes() { return 3.0 * answerBytes(); }

 private:
  using Range = std::uint16_t;  ///< [kRangeStep], rounded down; 0 where nothing is known
  using Columns = std::array<std::uint8_t, SightPixels::kColumns>;

  Sight read(const std::vector<Range>& image, const SightPixels::Pixel& pixel, float margin) const;
  bool makeRoomFor(const SightPixels& seen, Workspace& workspace);
  void layOut(std::vector<Range>& image, int first_row, int rows, std::vector<Range>& scratch) const;
  Columns collect(const SightPixels& seen);
  void readCarefully(const Columns& changed, int largest_gap, Workspace& workspace);
  void fillBetweenBeams(int column, int largest_gap, std::vector<Range>& beams) const;
  void fillBetweenColumns(int column, const std::vector<Range>& beams, std::vector<Range>& between) const;
  void erodeUpright(int column, const std::vector<Range>& between, std::vector<Range>& upright) const;
  void erodeAcross(int column, const std::vector<Range>& between, const std::vector<Range>& upright);
  /// Columns wrap around.
  std::ptrdiff_t startOf(int column) const {
    return static_cast<std::ptrdiff_t>(column & (SightPixels::kColumns - 1)) * rows_;
  }

  int first_row_ = 0, rows_ = 0;  ///< the part of the image that the sensor covers
  std::vector<Range> nearest_;    ///< by column, then row
  std::vector<Range> hit_;        ///< the same, of single lines of sight
  BeamSpacing beams_;
  Columns covered_{};  ///< 1 where an echo came back, or in a column beside
};

inline SightImage::Sight SightImage::read(const std::vector<Range>& image, const SightPixels::Pixel& pixel,
                                          float margin) const {
  const int row = pixel.row - first_row_;
  const bool is_covered = pixel.valid && row >= 0 && row < rows_ && !image.empty();
  if (!is_covered) return Sight::kUnknown;
  const Range nearest = image[static_cast<std::size_t>(startOf(pixel.column) + row)];
  const float beyond = static_cast<float>(nearest) * SightPixels::kRangeStep - pixel.range;
  // No branch to guess, so that answers of several images are waited for together.
  const int before =
      static_cast<int>(Sight::kHidden) - static_cast<int>(beyond > -margin) - static_cast<int>(beyond > margin);
  return static_cast<Sight>(static_cast<int>(nearest != 0) * before);
}

}  // namespace donex
