// Ego motion from the clouds themselves, for who has neither odometry nor tf.
#pragma once

#include <optional>
#include <vector>

#include "core/motion/lidar_odometry.h"
#include "core/sight/sight_pixels.h"
#include "core/sight/turns.h"
#include "donex/motion/ego_motion.h"

namespace donex {

/// LidarOdometry with a mounting for each sensor, and with the poses found so far as a track to de-skew by. Whole scans
/// are registered as they come. A part of a turn leaves too much open: the clouds of a turn, of all sensors, are
/// registered together when it is over, and until then the motion of the turns before goes on.
class ScanOdometry {
 public:
  ScanOdometry();

  /// Where the scan was measured. `echoes` in the sensor frame [m], as they were measured; `times` of each after the
  /// stamp [s], empty where there are none. Each sensor's mounting must stay until reset().
  const TrackedScan& locate(double stamp, const std::vector<Eigen::Vector3f>& echoes, const std::vector<float>& times,
                            const Eigen::Isometry3d& base_from_sensor);

  /// Of the scan located last: 1 for each echo that moves.
  void learn(const std::vector<std::uint8_t>& dynamic);

  /// Of the scan located last [s].
  double stamp() const { return stamp_; }
  /// At the stamp of the scan located last.
  Eigen::Isometry3d odomFromBase() const { return odom_from_base_; }
  /// The poses of the vehicle; covers some tenths of a second beyond the newest scan, by constant velocity.
  const EgoMotion& track() const { return track_; }

  void reset();

 private:
  /// A part of the turn, in the axes of the first sensor.
  struct Part {
    double stamp = 0.0;
    std::vector<Eigen::Vector3f> echoes;
    std::vector<float> times;
    std::vector<std::uint8_t> dynamic;  ///< empty where nobody has told
  };

  TurnPart partOf(double stamp, const std::vector<Eigen::Vector3f>& echoes, const Eigen::Isometry3d& base_from_sensor);
  void forgetTrack();
  void registerTurn();
  void follow(const TrackedScan& tracked);
  Eigen::Isometry3d odomFromBaseAt(double stamp) const;
  const std::vector<Eigen::Vector3f>& asFirstSensor(const std::vector<Eigen::Vector3f>& echoes,
                                                    const Eigen::Isometry3d& base_from_sensor);

  LidarOdometry odometry_;  // in the axes of the sensor that came first
  std::optional<Eigen::Isometry3d> base_from_first_;
  std::vector<Eigen::Vector3f> moved_;
  Turns turns_;
  SightPixels pixels_;
  std::vector<std::uint8_t> is_echo_;
  std::size_t clouds_ = 0;   // so far
  int whole_in_a_row_ = 0;   // clouds that were turns
  bool is_wide_ = false;     // the newest cloud, by what it sees
  bool is_whole_ = true;     // the newest cloud
  std::size_t in_turn_ = 0;  // echoes and clouds of turn_
  std::vector<Part> turn_;   // what is not registered yet
  Part merged_;
  TrackedScan tracked_;
  EgoMotion track_;
  double stamp_ = 0.0;
  Eigen::Isometry3d odom_from_base_ = Eigen::Isometry3d::Identity();
};

}  // namespace donex
