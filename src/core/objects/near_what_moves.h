// The echoes around what moves, by place (algorithm: "Low parts").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/objects/segment.h"

namespace donex {

/// Tells of an echo near the ground what is nearest to it, something that moves or something that stands. Only places
/// close to what moves are looked at, where something moves at all. In each part of a cell, the quarter of an edge, the
/// lowest echo that moves and the lowest that stands count alone: what is above them is no nearer to the ground.
class NearWhatMoves {
 public:
  /// A square of `reach` [m] around the sensor; echoes count as near up to `within` [m], horizontally.
  NearWhatMoves(double reach, float within);

  /// Takes the segments' echoes that move, and beside them those that connect but have no proof. `proofs`: one per
  /// entry of the scan, which is asked until forget(). False where nothing moves in the square.
  bool take(const JudgedScan& scan, const Segments& segments, const Verdicts& verdicts,
            const std::vector<Proof>& proofs);
  void forget();

  /// How far a place is from what moves, in cells of `within`.
  enum class Nearness : std::uint8_t {
    kOutside,  ///< of the square
    kFar,
    kBeside,  ///< two cells: what stands there may be nearer to an echo that is near
    kNear,    ///< it moves there, or one cell away
  };
  Nearness of(std::size_t echo) const { return nearness_[cellOf(x_[echo], y_[echo])]; }
  Nearness at(const Eigen::Vector2f& from_sensor) const;

  struct Nearest {
    int segment;             ///< kStands where nothing that moves is near, or something that stands is nearer
    float squared_distance;  ///< [m^2], horizontally
  };
  static constexpr int kStands = -1;
  /// Of one of the scan's echoes that is near.
  Nearest nearestTo(std::size_t echo) const;

  std::size_t memoryBytes() const;
  /// What memoryBytes will be, for scans of so many echoes [bytes], about.
  static double bytesFor(double reach, float within, double echoes);

 private:
  static constexpr int kNone = -1;
  static constexpr std::uint32_t kParts = 4;  ///< of a cell's edge
  static constexpr std::uint32_t kRim = 2;    ///< cells around the square, so that there are some beside each in it

  struct Lowest {
    int echo = kNone;
    int segment = kStands;
  };
  /// Those of a cell.
  struct Cell {
    std::uint32_t x, y;
    std::array<Lowest, kParts * kParts> moving, standing;  ///< by part
  };

  static std::uint32_t widthOf(double reach, float within);
  /// Of a place, in parts of cells.
  std::size_t cellOf(std::uint32_t x, std::uint32_t y) const { return std::size_t{y / kParts} * width_ + x / kParts; }
  void place(const JudgedScan& scan);
  void takeMoving(const Segments& segments, const Verdicts& verdicts, const std::vector<Proof>& proofs);
  void takeStanding(const std::vector<Proof>& proofs);
  void add(std::uint32_t echo, int segment);
  void mark(std::uint32_t away, Nearness nearness);

  float within_, per_part_;  ///< [m], [1/m]
  std::uint32_t width_;      ///< cells along an edge
  const JudgedScan* scan_ = nullptr;
  std::vector<std::uint16_t> x_, y_;  ///< by echo: its part of a cell; at the rim where it is outside
  std::vector<Nearness> nearness_;    ///< by cell
  std::vector<int> number_of_;        ///< by cell: of cells_, or kNone
  std::vector<Cell> cells_;           ///< that have an echo
  std::size_t moving_cells_ = 0;      ///< the first ones of these
};

}  // namespace donex
