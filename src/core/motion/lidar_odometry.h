// Ego motion from the scans alone: each is registered against a map of what stood in the scans before.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "core/motion/echo_selection.h"
#include "core/motion/gaussian_map.h"
#include "core/motion/scan_registration.h"
#include "donex/motion/ego_motion.h"

namespace donex {

enum class TrackingStatus {
  kStarting,    ///< the first scan of a track, and the second, which has no velocity to start from
  kTracking,    ///< the pose is determined
  kDegenerate,  ///< the scan leaves directions open, as a tunnel its axis: there the pose is predicted
  kLost,        ///< the pose is predicted altogether
};

/// "starting", "tracking", "degenerate", "lost".
const char* describe(TrackingStatus status);

/// Where one scan was measured.
struct TrackedScan {
  double moment = 0.0;                                                 ///< the middle of the scan's echoes [s]
  Eigen::Isometry3d odom_from_sensor = Eigen::Isometry3d::Identity();  ///< then
  TrackingStatus status = TrackingStatus::kStarting;
  bool is_new_track = true;  ///< poses before and from here on cannot be compared
  int undetermined = 0;      ///< directions left open, of six
  double fitting = 0.0;      ///< share of the echoes on known surfaces that fit them
  double least_information = 0.0;
};

/// LiDAR odometry. Predicts by constant velocity of its own and knows no other odometry. Echoes with times are moved by
/// the predicted velocity to the middle of their scan, where an error of it hardly matters: the earlier ones and the
/// later ones are off to either side. Memory and time a scan are bounded. Not thread-safe.
class LidarOdometry {
 public:
  struct Options {
    EchoSelection::Options selection;
    GaussianMap::Options map;
    RegistrationOptions registration = registrationOfScans();
    std::size_t least_echoes = 50;  ///< fewer are no scan to register
    double first_gate = 2.0;        ///< how far a prediction may be off at the start [m]
    double least_gate = 0.3;        ///< and when all goes well [m]
    double search_speed = 40.0;     ///< at the start a vehicle is no faster [m/s]
    double search_reach = 4.0;      ///< and has not come farther since the first scan [m]
    double search_step = 0.5;       ///< between starts that are tried [m]
    std::vector<double> search_yaws{-0.12, -0.08, -0.05, -0.025, 0.025, 0.05, 0.08, 0.12};  ///< tried as well [rad]
    /// A scan that fits about as well on average so far on [m], to the better side, tells nothing of that direction:
    /// where one barrier looks like the next, what holds it in place may be traffic that keeps pace.
    std::vector<double> slide_distances{2.0, 2.5, 3.0, 3.5, 4.0};
    double slide_fitness = 0.75;      ///< about as well: this share of how well it fits in place
    int scans_of_doubt = 2;           ///< after such a scan: as many that do not slide are not trusted yet
    double better_fitness = 1.02;     ///< what is found from elsewhere has to fit better by this factor
    double least_better = 0.002;      ///< and by so much: a few echoes on an open plain fit anywhere
    double usual_share = 0.93;        ///< with a smaller share of the usual fitting echoes other starts are tried
    double sound_share = 0.7;         ///< a smaller share of the usual fitting echoes is a loss
    double least_fitting = 0.4;       ///< a smaller share of fitting echoes is a loss
    double least_matched = 0.1;       ///< a smaller share of echoes on known surfaces is a loss
    double most_acceleration = 40.0;  ///< no vehicle brakes or turns in as hard: a loss [m/s^2]
    double most_turn = 0.35;          ///< nor turns by so much more than predicted between two scans [rad]
    int most_corrections = 2;         ///< of a scan that was straightened by a velocity it does not have,
    double least_correction = 0.02;   ///< where that has moved its first and last echoes so much [m]
    double new_track_after = 0.45;    ///< a loss lasts so long: a new track begins [s]
    double longest_prediction = 1.0;  ///< then a vehicle is taken to stand [s]
  };

  /// Little information is enough, since `slide_distances` are asked, too, and the ground tells nothing of x, y and
  /// yaw.
  static RegistrationOptions registrationOfScans();

  LidarOdometry() : LidarOdometry(Options()) {}
  explicit LidarOdometry(const Options& options);

  /// Registers a scan, of echoes in the sensor frame [m], as they were measured; non-finite ones are left out. `times`:
  /// of each echo after the stamp [s]; empty where all belong to the stamp. A moment [s] that is not later than the
  /// last one is taken for the same.
  const TrackedScan& locate(double stamp, const std::vector<Eigen::Vector3f>& echoes,
                            const std::vector<float>& times = {});

  /// What moves in the scan located last, 1 for each echo that does: the map is to hold what stands. Optional; without
  /// it the next scan finds all echoes in the map.
  void learn(const std::vector<std::uint8_t>& dynamic);

  void reset();
  std::size_t memoryBytes() const;

 private:
  struct Cloud {
    const std::vector<Eigen::Vector3f>& echoes;
    const std::vector<float>& times;
  };
  /// A motion in a time [s], in sensor axes.
  struct Step {
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    double time = 0.0;  // 0 where none is known

    bool isKnown() const { return time > 0.0; }
    Eigen::Isometry3d during(double duration) const;
  };

  void readTimes(double stamp, const std::vector<float>& times);
  void take(const Cloud& cloud, const std::vector<std::uint32_t>& from, const Step& step,
            std::vector<Eigen::Vector3f>& taken);
  void follow(const Cloud& cloud);
  void correct(const Cloud& cloud, double elapsed, Registration& registration);
  Eigen::Isometry3d predicted(double stamp) const;
  Registration registered(const Eigen::Isometry3d& prediction, double elapsed);
  void distrust(const Eigen::Isometry3d& prediction, Registration& registration);
  bool slides(const Registration& registration);
  void leaveOpen(const Eigen::Isometry3d& prediction, Registration& registration) const;
  bool isUsual(const Registration& registration) const;
  double fitnessAt(const Eigen::Isometry3d& pose, std::size_t stride);
  Eigen::Isometry3d searched(const Eigen::Isometry3d& prediction, double reach);
  bool isSound(const Registration& registration, const Eigen::Isometry3d& prediction, double elapsed) const;
  void startMap();
  void startTrack(double stamp, const Eigen::Isometry3d& pose);
  void accept(const Registration& registration, const Eigen::Isometry3d& prediction, double stamp);
  void lose(const Eigen::Isometry3d& prediction, double stamp);
  void adaptGate(const Eigen::Isometry3d& prediction);
  void keep();

  Options options_;
  GaussianMap map_;
  ScanRegistration registration_;
  EchoSelection selection_;
  TrackedScan last_;
  Step step_;  // the last one between two scans
  double last_stamp_ = 0.0;
  double squared_error_ = 0.0;        // of predictions, fading [m^2]
  double usual_fitting_ = 0.0;        // share of fitting echoes, fading
  std::optional<double> lost_since_;  // stamp of the first scan in a row [s]
  bool has_track_ = false;
  int doubt_ = 0;               // scans that are not trusted yet
  bool is_anchored_ = false;    // the velocity was found in scans that leave no doubt of it
  double determined_at_ = 0.0;  // stamp of the newest scan that left nothing open [s]
  // Of the scan in hand.
  double first_ = 0.0, last_time_ = 0.0;  // of its times [s]
  std::vector<Eigen::Vector3f> source_, to_keep_;
  std::vector<float> times_;  // of either, from the middle on [s]
};

}  // namespace donex
