// What the times of a stream's echoes mean, told by which of several readings lets the scans fit one another best.
#pragma once

#include <cmath>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/motion/gaussian_map.h"
#include "core/motion/scan_registration.h"
#include "donex/motion/ego_motion.h"

namespace donex {

/// What is made of an echo's time t in a scan whose times span `span`: factor * t + spans * span.
struct TimeReading {
  double factor = 1.0;
  double spans = 0.0;
  const char* meaning = "";
  /// Times that count from the scan's begin go round by so much first, in spans: the turn began elsewhere.
  double around = 0.0;

  bool undoesNothing() const { return factor == 0.0; }
  double operator()(double time, double span) const {
    return scaled(around > 0.0 && span > 0.0 ? std::fmod(time + around * span, span) : time, span);
  }
  /// Going round leaves the ends of the times where they are.
  double scaled(double time, double span) const { return factor * time + spans * span; }
};

/// Compares pairs of scans that are some way apart, in every reading, as the odometry places them. Where the vehicle
/// hardly moves within a scan, readings do not differ, and nothing is compared.
class DeskewChoice {
 public:
  struct Options {
    std::size_t sampled_echoes = 8000;  ///< of a scan
    std::size_t least_echoes = 3000;    ///< of a scan; fewer fit by chance
    float nearest = 2.0F;               ///< echoes nearer than this may lie on the vehicle itself [m]
    float farthest = 60.0F;             ///< echoes farther away lie too thinly to be compared [m]
    double apart = 0.25;                ///< from one scan of a pair to the other [s]
    double slow_period = 10.0;          ///< between two pairs, once the choice is clear or many have been compared [s]
    std::size_t many = 24;              ///< pairs
    double least_turn = 0.008;          ///< within a scan [rad]: 0.25 m at 30 m
    double least_way = 0.5;             ///< within a scan [m]
    std::size_t asked = 3;              ///< one of so many of the later scan's echoes is compared
    double kernel = 0.15;               ///< an echo so far from a surface weighs a quarter [m]
    std::size_t window = 10;            ///< newest pairs that count
    std::size_t least_pairs = 6;        ///< of these, before another reading is believed
    double most_lost = 0.1;             ///< of the pairs, in which it may fit worse,
    double lost = 0.0;                  ///< by more than this share
    double least_gain = 0.02;           ///< by which another reading has to fit better, on average
    double lost_after = 2.0;            ///< a pair whose scans the track does not reach by then is given up [s]
  };

  explicit DeskewChoice(std::vector<TimeReading> readings) : DeskewChoice(std::move(readings), Options()) {}
  /// The first reading holds until another one fits better.
  DeskewChoice(std::vector<TimeReading> readings, const Options& options);

  /// Whether the echoes of a scan of this stamp [s] would be of use.
  bool wants(double stamp) const;
  /// These, before they are de-skewed: in the sensor's frame [m], with their times as they are read [s].
  void take(double stamp, const std::vector<Eigen::Vector3f>& echoes, const std::vector<float>& times);

  /// Where the sensor was at each scan's stamp; true when another reading holds from now on.
  bool follow(double stamp, const Eigen::Isometry3d& odom_from_sensor);

  const TimeReading& reading() const { return readings_[chosen_]; }
  /// How well each reading fits, on average over the newest pairs; for the tests and the log.
  std::vector<double> fits() const;
  std::size_t pairs() const { return pairs_; }
  /// By how much the reading fitted better than the one before, when it was chosen; in shares.
  double gain() const { return gain_; }

  /// Stamps ran back, or poses cannot be compared with those before. What was chosen stays.
  void reset();

 private:
  struct Sample {
    double stamp = 0.0, first = 0.0, last = 0.0;  // [s]
    std::vector<Eigen::Vector3f> echoes;
    std::vector<float> times;
  };

  bool isMoving(const Sample& sample) const;
  bool isCovered(const Sample& sample) const;
  bool place(const Sample& sample, const TimeReading& reading, std::vector<Eigen::Vector3f>& echoes,
             Eigen::Isometry3d& odom_from_sensor) const;
  bool compare();
  bool fitsBetter(std::size_t reading, std::size_t other) const;
  bool choose();

  std::vector<TimeReading> readings_;
  Options options_;
  ScanRegistration registration_;
  std::optional<GaussianMap> map_;  // from the first pair on
  EgoMotion track_;                 // of the sensor
  Sample before_, after_;           // the pair in hand
  std::size_t taken_ = 0;           // of the pair
  double next_ = 0.0;               // when a pair may begin [s]
  std::size_t pairs_ = 0, chosen_ = 0;
  double gain_ = 0.0;
  std::deque<std::vector<double>> fits_;   // of the newest pairs, by reading
  std::vector<Eigen::Vector3f> straight_;  // for its memory
};

}  // namespace donex
