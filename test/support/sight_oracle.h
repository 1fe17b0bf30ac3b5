// Careful sight as sight_image.h words it, pixel by pixel on a std::map.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "core/sight/sight_image.h"

namespace donex::oracle {

class Sights {
 public:
  static constexpr int kColumns = 1024;
  static constexpr double kRowHeight = 0.006;  ///< tangent of the elevation
  static constexpr double kSteepest = 1.2;     ///< tangent beyond which nothing is asked
  static constexpr double kNearest = 0.3;      ///< [m] from the sensor's axis

  using Pixel = std::array<int, 2>;  // column, row
  using Image = std::map<Pixel, double>;

  Sights(const std::vector<Eigen::Vector3f>& echoes, const std::vector<std::uint8_t>& is_echo,
         const SightImage::Reading& reading) {
    Image image;
    for (std::size_t i = 0; i < echoes.size(); ++i) {
      const auto pixel = pixelOf(echoes[i]);
      if (is_echo[i] == 0 || !pixel) continue;
      const double range = echoes[i].cast<double>().norm();
      const auto known = image.find(*pixel);
      image[*pixel] = known == image.end() ? range : std::min(range, known->second);
    }
    single_ = image;
    if (reading.careful) {
      image = filledBetweenBeams(image, static_cast<int>(reading.largest_gap / kRowHeight));
      image = filledBetweenColumns(image);
      image = nearestAround(image);
    }
    image_ = image;
  }

  /// Nothing where the direction is never asked.
  static std::optional<Pixel> pixelOf(const Eigen::Vector3f& point) {
    const Eigen::Vector3d p = point.cast<double>();
    const double horizontal = p.head<2>().norm();
    if (!(horizontal > kNearest) || !(std::abs(p.z() / horizontal) < kSteepest)) return std::nullopt;
    const double turn = (std::atan2(p.y(), p.x()) + kPi) / (2.0 * kPi);
    return Pixel{static_cast<int>(turn * kColumns) % kColumns,
                 static_cast<int>((p.z() / horizontal + kSteepest) / kRowHeight)};
  }

  /// Middle of a pixel's directions, shifted by up to half a pixel each way.
  static Eigen::Vector3f pointIn(const Pixel& pixel, double off_column, double off_row, double range) {
    const double azimuth = (pixel[0] + 0.5 + off_column) * 2.0 * kPi / kColumns - kPi;
    const double slope = (pixel[1] + 0.5 + off_row) * kRowHeight - kSteepest;
    return (range * Eigen::Vector3d(std::cos(azimuth), std::sin(azimuth), slope).normalized()).cast<float>();
  }

  /// How far the scan saw in this pixel [m], not rounded; nothing where it is unknown.
  std::optional<double> rangeAt(const Pixel& pixel) const { return rangeIn(image_, pixel); }
  /// The same of its single lines of sight: the nearest echo in the pixel itself, however carefully the rest is read.
  std::optional<double> rangeThroughGaps(const Pixel& pixel) const { return rangeIn(single_, pixel); }

 private:
  static constexpr double kPi = 3.14159265358979323846;

  static std::optional<double> rangeIn(const Image& image, const Pixel& pixel) {
    const auto known = image.find(pixel);
    return known == image.end() ? std::nullopt : std::optional<double>(known->second);
  }

  static Image filledBetweenBeams(const Image& image, int largest_gap) {
    Image filled = image;
    for (const auto& [lower, lower_range] : image) {
      int above = lower[1] + 1;
      while (above - lower[1] <= largest_gap && image.count({lower[0], above}) == 0) ++above;
      const auto upper = image.find({lower[0], above});
      if (upper == image.end() || above - lower[1] > largest_gap) continue;
      for (int row = lower[1] + 1; row < above; ++row) filled[{lower[0], row}] = std::min(lower_range, upper->second);
    }
    return filled;
  }

  static Image filledBetweenColumns(const Image& image) {
    Image filled = image;
    for (const auto& [left, left_range] : image) {
      const Pixel between{(left[0] + 1) % kColumns, left[1]};
      const auto right = image.find({(left[0] + 2) % kColumns, left[1]});
      const bool is_single_gap = image.count(between) == 0 && right != image.end();
      if (is_single_gap) filled[between] = std::min(left_range, right->second);
    }
    return filled;
  }

  static Image nearestAround(const Image& image) {
    Image nearest;
    for (const auto& [pixel, own] : image) {
      double range = own;
      for (int column = -1; column <= 1; ++column) {
        for (int row = -1; row <= 1; ++row) {
          const auto around = image.find({(pixel[0] + column + kColumns) % kColumns, pixel[1] + row});
          if (around != image.end()) range = std::min(range, around->second);
        }
      }
      nearest[pixel] = range;
    }
    return nearest;
  }

  Image image_, single_;
};

}  // namespace donex::oracle
