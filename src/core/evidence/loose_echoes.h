// Echoes that stand alone among their neighbours: drops, flakes, dust, second returns (algorithm: "Loose echoes").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/evidence/judged_scan.h"
#include "core/sight/sight_pixels.h"
#include "core/sight/turns.h"
#include "donex/proof.h"

namespace donex {

/// A surface fills directions: most rays beside one that hits it hit it, too, at about the same range. An echo is loose
/// where only few of the echoes beside it, by direction, are. How far "beside" reaches follows from the cloud: as many
/// pixels as it takes to find neighbours, so that 16 and 128 beams are judged alike; where there are none, nothing is
/// said. A part of a turn is judged by itself.
///
/// Twigs, mirrors, fingertips and the edges of people are loose, too. So loose echoes are told apart only while the air
/// is seen to be full of them, and those close to what moves move with it.
class LooseEchoes {
 public:
  struct Options {
    double like = 0.1;             ///< difference in range within which neighbours are of one surface [m]
    double like_angle = 0.01;      ///< and as much more per metre of range: surfaces at an angle
    double share = 0.2;            ///< of the neighbours that are alike: fewer beside drops and in dust
    int neighbours = 12;           ///< enough to judge by: more than a row of 32 beams has beside an echo
    int farthest = 3;              ///< neighbours are looked for up to here [pixels]
    double close_by = 0.5;         ///< difference in range within which echoes share what they are [m]
    int close_pixels = 2;          ///< and in direction [pixels]
    double loose_spreads = 0.375;  ///< of the echoes close by that are loose: with more, one that is not is loose, too
    double loose_stays = 0.5;      ///< with fewer, one that is loose is not
    /// Of the echoes beside those of a plume that are alike: 0.05 in spray, 0.3 in dust; vehicles have 0.86 and more.
    double plume_share = 0.4;
    std::size_t plume_sample = 500;  ///< echoes of a thing that are asked for it
    /// Of the solid echoes close by: with more that move, a loose one is their object's.
    double moving_share = 1.0 / 3.0;
    /// Of the echoes up to a range, those beside which none is alike and all are farther, or all nearer.
    struct ThickAir {
      double range;  ///< [m]
      double share;
    };
    /// Drops and second returns are everywhere: clear air has 0.44 % at most, light rain 0.9 % at least. Plumes are
    /// beside the vehicle: clear air has 0.26 % at most there (in foliage 0.57 %), spray 0.55 % at least.
    std::array<ThickAir, 2> thick_air = {ThickAir{20.0, 0.005}, ThickAir{8.0, 0.004}};
    double clears = 0.75;    ///< of that share: with fewer, air that was thick is clear again
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
  /// Hands the proof of what moves to the loose echoes close by: its edges. `seen` and `roles` as for loosen().
  void join(const SightPixels& seen, const std::vector<ClusterRole>& roles, std::vector<Proof>& proofs);
  /// While the air is not clear: whether echoes that were connected, given by number, are a plume or a piece of one
  /// rather than a thing; then they are loose. Most of them lie within the shorter range of the air, and few echoes
  /// beside them are alike.
  bool loosenPlume(const SightPixels& seen, const std::uint32_t* echoes, std::size_t count,
                   std::vector<ClusterRole>& roles) const;
  void reset() {
    air_ = {};
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

  /// An echo, and the one of a moving object that it belongs to.
  struct Joined {
    std::uint32_t echo, of;
  };

  /// What was seen of the air up to a range, fading.
  struct Air {
    double echoes = 0.0, alone = 0.0;
    bool is_thick = false;
  };

  bool isAirClear() const { return !air_[0].is_thick && !air_[1].is_thick; }
  void beginTurn(double stamp);
  void smooth(const SightPixels& seen, std::vector<ClusterRole>& roles);
  void learnAir(float range, bool is_alone);
  void judgeAir();
  void sort(const SightPixels& seen);
  std::size_t pixelOf(int column, int row) const;
  /// None where there are too few.
  Count neighboursOf(const SightPixels& seen, std::size_t echo) const;
  Count countAround(const SightPixels& seen, std::size_t echo, int reach) const;
  /// Calls visit(number) for all echoes close by, with itself.
  template <class Visit>
  void forEachCloseBy(const SightPixels& seen, std::size_t echo, Visit&& visit) const;
  /// Calls visit(number) for all echoes so near to one by direction, with itself.
  template <class Visit>
  void forEachAround(const SightPixels& seen, std::size_t echo, int reach, Visit&& visit) const;

  Options options_;
  std::array<Air, 2> air_{};
  double looked_ = -std::numeric_limits<double>::infinity();  ///< when the air was looked at last [s]
  bool looks_ = true;                                         ///< in this turn
  int lowest_row_ = 0, rows_ = 0;                             ///< that the cloud has
  std::vector<std::uint32_t> first_in_;                       ///< by pixel: its first place in order_
  std::vector<std::uint32_t> order_;                          ///< the echoes by pixel
  std::vector<std::uint32_t> turned_;                         ///< echoes that become loose, or solid
  std::vector<Joined> joined_;
};

}  // namespace donex
