// Echoes that stand alone among their neighbours: drops, flakes, dust, second returns (algorithm: "Loose echoes").
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/evidence/judged_scan.h"
#include "core/sight/sight_pixels.h"
#include "core/sight/turns.h"

namespace donex {

/// A surface fills directions: most rays beside one that hits it hit it, too, at about the same range. An echo is loose
/// where only few of the echoes beside it, by direction, are. How far "beside" reaches follows from the cloud: as many
/// pixels as it takes to find neighbours, so that 16 and 128 beams are judged alike; where there are none, nothing is
/// said. A part of a turn is judged by itself.
///
/// Twigs, mirrors and fingertips are loose, too. So loose echoes are told apart only while the air is seen to be full
/// of them.
class LooseEchoes {
 public:
  struct Options {
    double like = 0.3;         ///< difference in range within which neighbours are of one surface [m]
    double like_angle = 0.02;  ///< and as much more per metre of range: surfaces at an angle
    double share = 0.1;        ///< of the neighbours that are alike: fewer beside drops, more at the edges of people
    int neighbours = 12;       ///< enough to judge by: more than a row of 32 beams has beside an echo
    int farthest = 3;          ///< neighbours are looked for up to here [pixels]
    double near = 20.0;        ///< the air is judged up to here: drops and dust return little from farther away [m]
    /// Of the near echoes, those beside which none is alike and all are farther, or all nearer: 0.3 % at most in clear
    /// air, 0.65 % at least in light rain.
    double thick_air = 0.005;
    double least = 10.0;     ///< of those, before anything is said: fewer are chance
    double interval = 0.5;   ///< clear air is looked at so often [s]: rain takes longer to begin
    double memory = 1.0;     ///< what was seen of the air fades to 1/e in this time [s]: two looks at clear air
    std::size_t sample = 7;  ///< every so manieth echo tells of clear air; odd, or it were always the same beams
  };

  explicit LooseEchoes(const Options& options) : options_(options) {}
  LooseEchoes() : LooseEchoes(Options()) {}

  /// Finds the loose ones among the echoes that connect, while the air is not clear, and gives them their role. `seen`:
  /// the cloud's pixels, one entry per echo.
  void loosen(TurnPart part, double stamp, const SightPixels& seen, std::vector<ClusterRole>& roles);
  void reset() {
    near_ = alone_ = 0.0;
    looked_ = -std::numeric_limits<double>::infinity();
  }

  std::size_t memoryBytes() const;
  /// What memoryBytes will be, for scans of so many echoes [bytes].
  static double bytesFor(double echoes);

 private:
  struct Count {
    int neighbours = 0;  ///< without the echo itself
    int alike = 0;
    int nearer = 0;

    /// A drop stands before all that is beside it, a second return behind it; a leaf mostly between others.
    bool isAlone() const { return neighbours > 0 && alike == 0 && (nearer == 0 || nearer == neighbours); }
  };

  bool isAirClear() const { return alone_ < options_.least || alone_ <= options_.thick_air * near_; }
  void beginTurn(double stamp);
  void sort(const SightPixels& seen);
  std::size_t pixelOf(int column, int row) const;
  /// None where there are too few.
  Count neighboursOf(const SightPixels& seen, std::size_t echo) const;
  Count countAround(const SightPixels& seen, std::size_t echo, int reach) const;

  Options options_;
  double near_ = 0.0, alone_ = 0.0;  ///< echoes that tell of the air, and those of them that stand alone
  double looked_ = -std::numeric_limits<double>::infinity();  ///< when the air was looked at last [s]
  bool looks_ = true;                                         ///< in this turn
  int lowest_row_ = 0, rows_ = 0;                             ///< that the cloud has
  std::vector<std::uint32_t> first_in_;                       ///< by pixel: its first place in ranges_
  std::vector<float> ranges_;                                 ///< by pixel [SightPixels::kRangeStep]
};

}  // namespace donex
