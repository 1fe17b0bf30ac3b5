// How a spinning sensor took a cloud that carries no times: told by the order its echoes come in.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace donex {

/// Looks at one cloud after the other. What is measured of a cloud holds until the next one.
class Spin {
 public:
  struct Options {
    std::size_t slices = 128;       ///< of a cloud in its order, and of a turn where rings begin
    float least_bundled = 0.9F;     ///< of the directions in a slice: the length of their mean
    float longest_step = 0.3F;      ///< between slices that follow one another, where something hides the world [turns]
    float most_detour = 0.1F;       ///< steps back and forth again, in shares of the way
    float least_turned = 0.5F;      ///< parts of a turn are short [turns]
    float most_turned = 1.25F;      ///< clouds may overlap [turns]
    float small_step = 0.02F;       ///< between echoes of one ring that follow one another [turns]
    float least_steady = 0.95F;     ///< of these, in one direction
    float least_rings = 3.0F;       ///< turns in one cloud
    float least_ring_gap = 0.002F;  ///< slope from one ring to the next: 0.1 degrees
    float least_begun = 0.5F;       ///< of the rings, in the slice of a turn where the cloud begins
  };

  Spin() : Spin(Options()) {}
  explicit Spin(const Options& options) : options_(options) {}

  /// Of a cloud as it came, with `columns` echoes in a row: firing by firing, row by row or ring by ring. False where
  /// its order tells nothing. Echoes in the sensor's frame; not finite where there are none.
  bool look(const std::vector<Eigen::Vector3f>& echoes, std::size_t columns);

  /// Whether the cloud has its echoes in the order they were measured in: converters that write ring by ring, or that
  /// project into images, begin where they like.
  bool isByFirings() const { return order_ == Order::kFirings; }
  bool isClockwise() const { return sign_ < 0.0F; }
  /// Where the cloud begins: azimuth, counter-clockwise from straight ahead [turns], -0.5 to 0.5.
  float start() const { return start_; }
  /// From the cloud's begin to its end [turns].
  float turned() const { return turned_; }
  /// From the cloud's begin to each of its echoes, those that `look` was shown [turns]; a number for those without a
  /// direction, too.
  void turnsOf(const std::vector<Eigen::Vector3f>& echoes, std::vector<float>& turns) const;

 private:
  enum class Order { kFirings, kRows, kRings };
  struct Directions {
    Eigen::Vector2f sum = Eigen::Vector2f::Zero();
    int count = 0;
  };
  struct Knot {
    float place;  // in the cloud's order [slices]
    float turns;  // from the cloud's begin
  };

  bool isInOrder(const std::vector<Eigen::Vector3f>& echoes);
  void slice(const std::vector<Eigen::Vector3f>& echoes);
  bool tie();
  void reachToTheEnds();
  bool isRingByRing(const std::vector<Eigen::Vector3f>& echoes);
  void beginRing(float azimuth, const Eigen::Vector2f& direction);
  bool findBegin(float rings);
  float placeOf(std::size_t echo) const;

  Options options_;
  Order order_ = Order::kFirings;
  std::size_t columns_ = 0, count_ = 0;  // echoes in a row, and in all
  float sign_ = 1.0F, start_ = 0.0F, turned_ = 0.0F;
  std::vector<Directions> slices_;  // of the cloud in its order; of a turn, those of the echoes that begin a ring
  std::vector<Knot> knots_;         // the middles of slices with echoes
};

}  // namespace donex
