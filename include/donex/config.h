// Everything a user can set, with its default and unit; ranges and meanings stand in parameters.h.
#pragma once

#include <cstddef>
#include <string>
#include <type_traits>
#include <vector>

#include "donex/method.h"

namespace donex {

enum class Compensation { kScroll, kResample };
enum class OdometrySource { kPose, kTwist, kTf, kNone, kLidar, kAuto };
/// How a cloud says when each echo was measured: relative to its stamp or absolute, in which unit.
enum class TimeEncoding {
  kAuto,
  kRelativeSeconds,
  kRelativeMicroseconds,
  kRelativeNanoseconds,
  kAbsoluteSeconds,
  kAbsoluteNanoseconds,
};

inline const std::vector<std::string>& namesOf(Compensation) {
  static const std::vector<std::string> names{"scroll", "resample"};
  return names;
}
inline const std::vector<std::string>& namesOf(OdometrySource) {
  static const std::vector<std::string> names{"pose", "twist", "tf", "none", "lidar", "auto"};
  return names;
}
inline const std::vector<std::string>& namesOf(TimeEncoding) {
  static const std::vector<std::string> names{"auto",        "relative_s", "relative_us",
                                              "relative_ns", "absolute_s", "absolute_ns"};
  return names;
}

/// What the parameter's value is called.
template <class Enum>
std::enable_if_t<std::is_enum_v<Enum>, const std::string&> nameOf(Enum value) {
  return namesOf(value).at(static_cast<std::size_t>(value));
}

/// Region of interest in the vehicle frame [m]; an echo on the lower face is inside, on the upper outside.
struct Region {
  double x_min = -50.0, x_max = 50.0;
  double y_min = -50.0, y_max = 50.0;
  double z_min = -4.0, z_max = 6.0;
};

/// Evidence beyond the paper's rule (algorithm: "Evidence"); each step can be switched off alone.
/// With all of them off a method is the paper's.
struct EvidenceConfig {
  bool free_evidence = true;
  int free_scans = 2;
  double history_length = 2.0;  // [s]
  double sight_margin = 0.5;    // [m]
  bool careful_sight = true;
  double sight_gap = 2.2;  // [deg]
  int settled_free_scans = 4;
  bool birth_age = true;
  double birth_window = 1.0;  // [s]
  bool neighbourhood = true;
  bool ground = true;
  double ground_clearance = 0.25;  // [m]

  bool any() const { return free_evidence || careful_sight || birth_age || neighbourhood || ground; }
};

/// The vehicle's own body (algorithm: "The own body"): found by itself, and a box in the vehicle frame [m], empty by
/// default.
struct SelfConfig {
  bool detection = true;
  double x_min = 0.0, x_max = 0.0;
  double y_min = 0.0, y_max = 0.0;
  double z_min = 0.0, z_max = 0.0;
};

/// Connected echoes are judged together and followed over time.
struct ObjectConfig {
  bool enabled = true;
  double cell = 0.3;    // [m]
  double height = 4.5;  // [m]
  int min_echoes = 5;
  double new_share = 0.4;
  bool motion = true;
  double stop_time = 0.5;  // [s]
};

/// Whether the ego motion comes as messages of odometry.
constexpr bool usesOdometry(OdometrySource source) {
  return source == OdometrySource::kPose || source == OdometrySource::kTwist;
}

/// Where the ego motion comes from, and how long a cloud waits for it.
struct MotionConfig {
  OdometrySource source = OdometrySource::kPose;
  std::string fixed_frame = "odom";
  std::string base_frame = "base_link";
  double max_extrapolation = 0.02;  // [s]
  double odometry_timeout = 0.6;    // [s]
  bool deskew = true;
  bool publish_tf = false;
  bool odometry_check = true;
  bool odometry_refine = true;
};

/// What the clouds of a driver do not say themselves.
struct CloudConfig {
  std::string time_field;  // empty: found by its name
  TimeEncoding time_encoding = TimeEncoding::kAuto;
  double origin_x = 0.0, origin_y = 0.0, origin_z = 0.0;  // [m], the sensor in the clouds' frame
  std::string sensor_frame;                               // empty: the clouds' own
};

/// What the node does beside labelling.
struct NodeConfig {
  int queue_size = 12;
  bool markers = true;
  bool marker_cells = true;
  bool marker_objects = true;
  bool marker_grid = true;
};

struct Config {
  Method method = Method::kDonex3d;
  double voxel_size = 0.2;  // [m]
  Region region;
  Compensation compensation = Compensation::kScroll;
  int memory_limit = 1000;  // [MB]
  int threads = 1;  ///< that judge a scan together: of donex_2d and donex_3d, by evidence and by the paper's rule
  EvidenceConfig evidence;
  SelfConfig self;
  ObjectConfig objects;
  MotionConfig motion;
  CloudConfig cloud;
  NodeConfig node;

  /// Every value out of its range, one sentence each. Whether the grid fits into memory says faultsOf (memory_bound.h),
  /// which asks this first.
  std::vector<std::string> faults() const;

  /// One of DONEX's grids, with at least one step beyond the paper.
  bool hasEvidence() const;
  /// The paper's rule alone, on whichever grid.
  bool isPaper() const;
  /// The same with a grid that scrolls.
  Config scrolling() const;
};

/// Whether every parameter has the same value.
bool operator==(const Config& a, const Config& b);
inline bool operator!=(const Config& a, const Config& b) { return !(a == b); }

/// The paper's rule on this method's grid: every step beyond it off. In the paper the grid is resampled.
Config paperConfig(Method method, Compensation compensation = Compensation::kScroll);

}  // namespace donex
