// The vehicle's own body among the echoes (algorithm: "The own body").
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "core/sight/turns.h"
#include "donex/config.h"
#include "donex/scan.h"

namespace donex {

/// Echoes that stay with the sensor while the vehicle moves are the vehicle's own. Cells around the sensor, in the
/// vehicle's frame, count how often they were hit from one place of the vehicle to the next: what the world holds moves
/// through them, the body stays. Only so near to the sensor that no other vehicle comes there. A place is looked at for
/// a turn, in however many clouds that comes.
class OwnBody {
 public:
  struct Options {
    double reach = 2.5;        ///< ahead of and behind the sensor [m]
    double half_width = 1.3;   ///< half as wide as a vehicle may be: what drives alongside is farther away [m]
    double half_height = 2.0;  ///< no vehicle reaches farther below or above a sensor on its roof or bonnet [m]
    double cell = 0.15;        ///< beams are no farther apart within the reach, and a body's echoes stay in it [m]
    double step = 0.4;         ///< that the vehicle moves between two counts: the world has left its cells [m]
    int gain = 2;              ///< of a cell that is hit: beams between two cells hit each every other time,
    int loss = 1;              ///< so one that is missed loses less
    int body = 8;              ///< count from which a cell is the body's: hit from four places in a row
    int suspect = 4;           ///< the same in the first places: hit from all of them, two at least
    int most = 20;             ///< a count grows no further: what has gone is forgotten after thirteen places
  };

  explicit OwnBody(const SelfConfig& config) : OwnBody(config, Options()) {}
  OwnBody(const SelfConfig& config, const Options& options);

  /// Sets `is_solid` to 0 where an echo from `first` to `last` (not included) is the body's, as far as it is known from
  /// earlier scans or named as a box.
  void leaveOut(const Scan& scan, std::size_t first, std::size_t last, std::vector<std::uint8_t>& is_solid) const;

  /// Learns from a scan; `heights` of its echoes above ground [m], from `lowest` on they count: the ground also stays
  /// with the sensor.
  void learn(TurnPart part, const Scan& scan, const std::vector<std::uint8_t>& is_echo,
             const std::vector<float>& heights, float lowest);
  void reset();

  std::size_t memoryBytes() const { return counts_.capacity() + hit_.capacity(); }
  /// What memoryBytes will be [bytes].
  static double bytesFor(const SelfConfig& config);

 private:
  static constexpr int kNone = -1;

  bool detects() const { return !counts_.empty(); }
  bool hasBox() const { return config_.x_min < config_.x_max; }
  bool isInBox(const Eigen::Vector3f& in_vehicle) const;
  /// Cells lie around the first cloud's sensor.
  int cellOf(const Eigen::Vector3f& in_vehicle) const;
  float farthestFrom(const Eigen::Vector3f& mounting) const;
  void beginTurn(const Scan& scan);
  void count();
  int leastOfBody() const;
  bool isBody(int cell) const;

  SelfConfig config_;
  Options options_;
  Eigen::Array3f half_;               ///< of the cells' box [m]
  Eigen::Vector3i size_;              ///< [cells]
  std::vector<std::uint8_t> counts_;  ///< by cell
  std::vector<std::uint8_t> hit_;     ///< by cell: in this turn
  bool has_place_ = false, is_counting_ = false;
  int places_ = 0;                                        ///< that were counted
  bool is_found_ = false;                                 ///< some cell is the body's
  Eigen::Vector3f center_ = Eigen::Vector3f::Zero();      ///< of the cells, in the vehicle [m]
  Eigen::Vector3d last_place_ = Eigen::Vector3d::Zero();  ///< of the vehicle, counted last, in the odometry frame [m]
};

}  // namespace donex
