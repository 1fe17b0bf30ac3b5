// The local ground: which echoes lie on it (algorithm: "Ground").
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "core/sight/turns.h"

namespace donex {

struct GroundOptions {
  float cell = 0.8F;          ///< of the height map: some echoes of a sparse sensor lie in each nearby [m]
  float roughness = 0.15F;    ///< ground may fall this much from cell to cell anyway: kerbs [m]
  float fall = 0.08F;         ///< and this much per metre since it was last seen
  float kerb = 0.14F;         ///< it may rise less: where a vehicle hides the ground, its sill is the lowest echo [m]
  float rise = 0.03F;         ///< and this much per metre since it was last seen
  float largest_step = 0.4F;  ///< from cell to cell, however far away it was last seen [m]
  float start_uncertainty = 4.0F;  ///< around the sensor, as if the ground had been seen last this far away [m]
  float start_radius = 7.0F;       ///< the cells in it tell where the ground starts [m],
  std::size_t start_cells = 24;    ///< but never fewer than these
  int start_trials = 3;       ///< each with twice the radius: a sensor that hardly looks down sees no ground nearby
  float on = 0.1F;            ///< a lowest echo so near to the ground speaks for it [m]
  float beneath = 0.3F;       ///< one that far beneath speaks against it [m]
  float most_beneath = 0.1F;  ///< of the cells on it; with more the ground may have started somewhere else
  std::array<float, 3> start_reach = {0.6F, 0.3F, 0.15F};  ///< off the plane so far, one fit after another [m]
  double levelling = 50.0;                                 ///< as if so much spoke for level ground [m^2]
};

/// A height map of one turn. Cells take their lowest echo where it continues the ground of the cells
/// nearer to the sensor, and their neighbours' height where it does not: then the cell holds an object only.
class Ground {
 public:
  /// A square of `reach` [m] around the sensor.
  explicit Ground(double reach, const GroundOptions& options = {});

  /// `echoes` [m] in a frame whose z points up; those with `is_echo` 0 are left out.
  void estimate(const Eigen::Vector3f& sensor, const std::vector<Eigen::Vector3f>& echoes,
                const std::vector<std::uint8_t>& is_echo) {
    estimate(TurnPart::kWhole, Eigen::Vector3d::Zero(), sensor, echoes, is_echo);
  }
  /// The same from a part of a turn, where earlier parts and the turn before tell what this one does not show.
  /// `origin`: where the frame lies in one that never moves and has the same axes [m].
  void estimate(TurnPart part, const Eigen::Vector3d& origin, const Eigen::Vector3f& sensor,
                const std::vector<Eigen::Vector3f>& echoes, const std::vector<std::uint8_t>& is_echo);

  /// Height above the ground [m]; infinite outside the map, or where no ground was found at all.
  float heightOf(const Eigen::Vector3f& point) const;

  /// The same of an echo of the last estimate, by its number there and its height `z` in the frame [m].
  float heightOfEcho(std::size_t echo, float z) const { return heightIn(cell_of_[echo], z); }
  /// The same of `echoes`, those from `first` to `last` (not included).
  void heightsOf(const std::vector<Eigen::Vector3f>& echoes, std::size_t first, std::size_t last,
                 std::vector<float>& heights) const;

  std::size_t memoryBytes() const;
  /// What memoryBytes will be, for scans of so many echoes [bytes].
  static double bytesFor(double reach, double echoes, const GroundOptions& options = {});

 private:
  static constexpr float kNone = std::numeric_limits<float>::infinity();

  /// A bit per direction, in sectors of equal azimuth.
  using Sectors = std::uint64_t;
  /// The number of one of them.
  using Sector = std::uint8_t;
  static constexpr Sector kInAll = 255;  ///< the cells around the sensor lie in all of them
  struct Cell {
    std::int16_t x, y;     ///< from the sensor's
    std::uint16_t nearer;  ///< which of nearer_
    Sector sector;
    int squaredDistance() const { return x * x + y * y; }
  };
  struct Neighbour {
    int x, y;
    int offset;   ///< of its index
    float away;   ///< [m]
    float climb;  ///< how far the plane around the sensor rises to it [m]
  };

  /// Of two neighbours on opposite sides one at most is nearer.
  static constexpr std::size_t kMostNearer = 12;
  /// The neighbours that are nearer to the sensor, and in the map, by their number in around_. Behind them comes the
  /// first one again, infinitely far away, where it has no weight: all cells ask as many, so that no loop's end is to
  /// be guessed.
  struct Nearer {
    std::uint32_t mask;  ///< a bit per neighbour
    std::array<int, kMostNearer> number, offset;
    std::array<float, kMostNearer> away, climb;
  };

  static int widthOf(double reach, float cell);
  static Sector sectorOf(int x, int y);
  void beginMap(TurnPart part, const Eigen::Vector3d& origin, const Eigen::Vector3f& sensor);
  void moveMap(int x, int y, float up);
  void moveMap(std::vector<float>& map, int x, int y, float up);
  void collect(const std::vector<Eigen::Vector3f>& echoes, const std::vector<std::uint8_t>& is_echo);
  Sectors sectorsHit() const;
  void continueOutwards(Sectors sectors);
  std::size_t indexOf(int x, int y) const {
    const int middle = width_ / 2;
    return static_cast<std::size_t>(y + middle) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x + middle);
  }
  float heightIn(int cell, float z) const {
    const float ground = ground_[static_cast<std::size_t>(std::max(cell, 0))];  // read in any case: nothing to guess
    return z + shift_.z() - (cell < 0 || ground == kNone ? -kNone : ground);    // infinitely far below where unknown
  }
  Eigen::Vector2f offsetOf(const Cell& cell) const;  ///< from the sensor's cell [m]
  /// In this turn, or in the one before where this one has none yet.
  float lowestIn(std::size_t cell) const { return std::isinf(lowest_[cell]) ? before_[cell] : lowest_[cell]; }
  bool findStart(float radius);  ///< false where no echo is near
  bool continueFrom(float radius, Sectors sectors);
  float shareBeneath() const;
  Eigen::Vector3f fitStart(float reach) const;
  /// As Nearer::mask.
  std::uint32_t neighboursNearerTo(int x, int y) const;
  Nearer nearerOf(std::uint32_t mask) const;
  std::uint16_t findNearer(std::uint32_t mask);
  void climbAround();
  /// Height of the plane around the sensor, `offset` [m] from there.
  float startAt(const Eigen::Vector2f& offset) const { return start_.head<2>().dot(offset) + start_.z(); }
  /// What the ground of nearer cells lets expect.
  struct Continuation {
    float height;
    float unseen;  ///< how far away the ground was last seen [m]
  };
  Continuation continueTo(const Cell& cell) const;

  GroundOptions options_;
  int width_;                                         ///< cells along an edge
  Eigen::Vector3f sensor_ = Eigen::Vector3f::Zero();  ///< at the map's centre, or less than a cell from it [m]
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();  ///< of the map's frame [m]
  Eigen::Vector3f shift_ = Eigen::Vector3f::Zero();   ///< of the present cloud's frame against the map's [m]
  bool is_known_ = false;                             ///< all cells have a ground, if only continued
  std::vector<Cell> outwards_;                        ///< by distance from the sensor
  std::vector<Neighbour> around_;
  std::vector<Nearer> nearer_;                       ///< each once
  std::vector<int> cell_of_;                         ///< by echo, -1 outside
  std::vector<float> lowest_, ground_;               ///< by cell [m]
  std::vector<float> before_;                        ///< by cell: the lowest echo in the turn before [m]
  std::vector<float> moved_;                         ///< storage for moving a map
  std::vector<Sector> sector_of_;                    ///< by cell
  std::vector<float> unseen_;                        ///< by cell: how far the ground is only continued [m]
  std::vector<Eigen::Vector3f> near_;                ///< lowest echoes of the cells around the sensor, from there [m]
  Eigen::Vector3f start_ = Eigen::Vector3f::Zero();  ///< slopes along x, y, and the height under the sensor [m]
};

}  // namespace donex
