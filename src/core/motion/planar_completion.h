// Planar odometry completed: height, roll and pitch come from the scans; x and y stay as given, and so does yaw where
// the scans do not contradict it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "core/motion/echo_selection.h"
#include "core/motion/gaussian_map.h"
#include "core/motion/scan_registration.h"

namespace donex {

/// Whether an odometry has stayed in the plane it began in, as that of wheels does.
class PlaneWatch {
 public:
  struct Options {
    double height = 1e-4;  ///< out of the plane is beyond that [m]: what rounding makes is far below
    double tilt = 1e-4;    ///< and turned out of it by more than this [rad]
    double way = 0.5;      ///< an odometry that has moved less could still be any [m]
  };

  PlaneWatch() = default;
  explicit PlaneWatch(const Options& options) : options_(options) {}

  void follow(const Eigen::Isometry3d& odom_from_base);
  /// Has moved, and never out of its plane.
  bool isPlanar() const { return !left_ && has_moved_; }
  void reset() { *this = PlaneWatch(options_); }

 private:
  Options options_;
  Eigen::Isometry3d first_ = Eigen::Isometry3d::Identity();
  bool has_first_ = false, has_moved_ = false, left_ = false;
};

/// Each scan is registered against a map of those before in three directions alone, and once in all six for its yaw.
/// Memory and time per scan are bounded. Not thread-safe.
class PlanarCompletion {
 public:
  struct Options {
    GaussianMap::Options map;
    RegistrationOptions registration;
    PlaneWatch::Options plane;
    /// Echoes beyond are left out [m]: ground is hit there so flatly that its height is known worse than by the map.
    float near_ground = 40.0F;
    float kept_edge = 0.4F;               ///< one echo in each such voxel goes into the map [m]
    std::size_t least_to_register = 500;  ///< echoes to register: three directions ask for half of those of six
    double gate = 0.3;                    ///< the prediction is off by no more, at the echoes [m]
    std::size_t least_echoes = 50;        ///< fewer are no scan to register
    double least_matched = 0.1;           ///< with a smaller share of echoes on known surfaces the prediction stands
    double least_fitting = 0.4;           ///< with a smaller share of these that fit, too
    double most_lift = 0.3;               ///< no vehicle is so much higher than predicted, from scan to scan [m]
    double most_tilt = 0.1;               ///< nor tilted by so much more [rad]
    /// Yaw stays as given where the scans differ by less [rad]: 3 cm at 50 m, as much as a range errs by. What a
    /// registration errs by is to turn no odometry that is right.
    double least_yaw = 6e-4;
    /// And it is turned by no more, whatever the scans say [rad]: the check of odometry tells of more.
    double most_yaw = 1e-2;
    double new_map_after = 0.45;  ///< scans do not fit for so long: a new map begins [s]
  };

  PlanarCompletion() : PlanarCompletion(Options()) {}
  explicit PlanarCompletion(const Options& options);

  /// The vehicle's pose at a scan of this stamp [s]. `echoes` in the sensor frame [m], `odom_from_base` as the odometry
  /// has it. Once the odometry leaves its plane, what it lacked until then stays added: poses never step.
  Eigen::Isometry3d complete(double stamp, const std::vector<Eigen::Vector3f>& echoes,
                             const Eigen::Isometry3d& base_from_sensor, const Eigen::Isometry3d& odom_from_base);

  /// What moves in that scan, 1 for each echo that does: the rest goes into the map, now or with the next scan.
  void learn(const std::vector<std::uint8_t>& dynamic);

  /// Whether the odometry is completed: where it has been planar so far.
  bool isActive() const { return plane_.isPlanar(); }

  /// The odometry begins anew, in a plane of its own.
  void reset();

 private:
  void begin();
  void select(const std::vector<Eigen::Vector3f>& echoes, const Eigen::Isometry3d& base_from_sensor);
  bool isSound(const Registration& registration, const Eigen::Isometry3d& prediction) const;
  void climb(const Eigen::Isometry3d& odom_from_base);
  void find(double stamp);
  double yawToMend(const Eigen::Isometry3d& prediction);
  void take(const Eigen::Isometry3d& found);
  Eigen::Isometry3d completed() const;
  void keep();

  Options options_;
  PlaneWatch plane_;
  EchoSelection selection_;
  std::optional<GaussianMap> map_;                      // once it is needed
  ScanRegistration registration_, whole_registration_;  // out of the plane, and in all directions
  // What the odometry lacks, in its own axes.
  Eigen::Vector3d tilt_ = Eigen::Vector3d::Zero();  // axis times angle [rad], along the ground
  double lift_ = 0.0;                               // [m]
  double yaw_ = 0.0;                                // [rad]
  bool has_map_ = false;
  std::optional<double> predicted_since_;  // stamp of the first scan in a row that does not fit [s]
  Eigen::Isometry3d completed_from_given_ = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d given_ = Eigen::Isometry3d::Identity();  // of the newest scan
  // Of the scan in hand, in the vehicle's frame.
  std::vector<Eigen::Vector3f> source_, to_keep_;
};

}  // namespace donex
