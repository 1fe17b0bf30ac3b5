// Which clouds make up one turn (algorithm: "Parts of scans").
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/sight/sight_pixels.h"
#include "donex/scan.h"

namespace donex {

/// Where in a turn a cloud comes (algorithm: "Parts of scans").
enum class TurnPart {
  kWhole,       ///< the turn before was one cloud, and this one is taken for another
  kFirst,       ///< it begins a turn, after one that came in parts
  kContinuing,  ///< it goes on with the turn
};

/// A turn is the clouds from one on until a sensor looks again where it has looked since. Whole scans are a turn each;
/// a sensor that publishes sectors, and several sensors on one vehicle, have turns of several clouds, in whatever order
/// they come. All of that is measured in the directions of the echoes, in azimuth and, where a cloud
/// reaches over less than most of what its sensor sees, in elevation; nothing tells what a cloud is. A handful of
/// echoes does not tell that scans come in parts.
class Turns {
 public:
  /// Takes the next cloud. `seen`: its pixels in its own frame.
  TurnPart arrive(const Scan& scan, const SightPixels& seen, const Workers& workers = Workers::alone());
  /// Whether two mountings are one sensor's.
  static bool areOne(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b);
  using Columns = std::array<std::uint8_t, SightPixels::kColumns>;  ///< 1 where they are looked at
  static constexpr int kBands = 64;                                 ///< of elevation, over what the rows reach
  using Bands = std::uint64_t;                                      ///< of elevation, a bit each from the lowest on
  using Directions = std::array<Bands, SightPixels::kColumns>;      ///< by column
  static constexpr Bands kAllBands = ~Bands{0};
  static int bandOf(int row) { return row * kBands / SightPixels::kRows; }
  /// A column and a band.
  class Direction {
   public:
    Direction(int column, int row) : number_(static_cast<std::uint16_t>(column * kBands + bandOf(row))) {}
    std::size_t column() const { return number_ / kBands; }
    bool isIn(const Directions& directions) const { return (directions[column()] >> (number_ % kBands) & 1U) != 0; }

   private:
    std::uint16_t number_;
  };
  /// What the newest cloud looks at; valid until the next one.
  const Columns& newest() const { return newest_; }
  /// ... in these bands: all of them where it reaches over most of what its sensor sees.
  Bands newestBands() const { return newest_bands_; }
  /// What its sensor has looked at in the turn so far.
  const Directions& lookedAt() const { return sensors_[newest_sensor_].looked; }
  /// Of this turn so far or of the one before, whichever has more.
  std::size_t cloudsPerTurn() const { return std::max({clouds_, clouds_before_, std::size_t{1}}); }
  /// The next cloud begins a turn, after none.
  void reset() {
    sensors_.clear();
    reaches_.clear();
    clouds_ = clouds_before_ = 0;
  }

  std::size_t memoryBytes() const {
    return in_stretch_.capacity() * sizeof(Columns) + sensors_.capacity() * sizeof(Sensor) +
           reaches_.capacity() * sizeof(Reach);
  }

  static constexpr double kLongest = 0.3;         ///< [s] what parts see in longer turns is not of one place any more
  static constexpr double kSamePlace = 0.05;      ///< [m] between two mountings of one sensor,
  static constexpr double kSameAxes = 0.02;       ///< [rad] and between their axes
  static constexpr std::size_t kMostSensors = 8;  ///< in a turn

 private:
  /// What a sensor has looked at in this turn.
  struct Sensor {
    Eigen::Isometry3d base_from_sensor;
    Directions looked;
  };
  /// The bands from the lowest to the highest one with an echo, of a sensor's clouds of a turn.
  struct Reach {
    Eigen::Isometry3d base_from_sensor;
    Bands before, now;  ///< in the turn before, and in this one so far
  };

  bool looksAgain(const Sensor& sensor, Bands bands) const;
  Columns columnsOf(const SightPixels& seen, const Workers& workers);
  Bands bandsOf(const Eigen::Isometry3d& base_from_sensor, const SightPixels::Span& span);
  Reach& reachOf(const Eigen::Isometry3d& base_from_sensor);
  Sensor* sensorAt(const Eigen::Isometry3d& base_from_sensor);

  double begin_ = 0.0;                          ///< [s]
  std::size_t clouds_ = 0, clouds_before_ = 0;  ///< of the turn, and of the one before
  bool newest_has_enough_ = false;              ///< echoes to tell that its scan comes in parts
  std::vector<Sensor> sensors_;
  std::vector<Reach> reaches_;
  std::vector<Columns> in_stretch_;  ///< of the newest cloud: with an echo of that stretch
  Columns newest_{};
  Bands newest_bands_ = kAllBands;
  std::size_t newest_sensor_ = 0;
};

}  // namespace donex
