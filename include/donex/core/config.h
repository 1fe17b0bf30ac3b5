// Everything a user can set, with its default, unit, range and meaning: the one place for it.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace donex {

/// DONEX in its forms, and the systems it is compared with (algorithm section 6).
enum class Method {
  kDonex3d,
  kDonex2d,
  kDonex3dZBuffer,
  kMotionVoxelGrid,
  kRayTracing,
  kRangeResidual,
  kPeopleremover,
};
enum class Compensation { kScroll, kResample };
enum class OdometrySource { kPose, kTwist, kTf, kNone };
/// How a cloud says when each echo was measured: relative to its stamp or absolute, in which unit.
enum class TimeEncoding {
  kAuto,
  kRelativeSeconds,
  kRelativeMicroseconds,
  kRelativeNanoseconds,
  kAbsoluteSeconds,
  kAbsoluteNanoseconds,
};

inline const std::vector<std::string>& namesOf(Method) {
  static const std::vector<std::string> names{"donex_3d",    "donex_2d",       "donex_3d_zbuffer", "motion_voxel_grid",
                                              "ray_tracing", "range_residual", "peopleremover"};
  return names;
}
inline const std::string& nameOf(Method method) { return namesOf(method).at(static_cast<std::size_t>(method)); }

inline const std::vector<std::string>& namesOf(Compensation) {
  static const std::vector<std::string> names{"scroll", "resample"};
  return names;
}
inline const std::vector<std::string>& namesOf(OdometrySource) {
  static const std::vector<std::string> names{"pose", "twist", "tf", "none"};
  return names;
}
inline const std::vector<std::string>& namesOf(TimeEncoding) {
  static const std::vector<std::string> names{"auto",        "relative_s", "relative_us",
                                              "relative_ns", "absolute_s", "absolute_ns"};
  return names;
}

/// Region of interest in the vehicle frame [m]; an echo on the lower face is inside, on the upper outside.
struct Region {
  double x_min = -50.0, x_max = 50.0;
  double y_min = -50.0, y_max = 50.0;
  double z_min = -4.0, z_max = 6.0;
};

/// Evidence beyond the paper's rule (algorithm section 5); each step can be switched off alone.
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
  double birth_window = 1.5;  // [s]
  bool neighbourhood = true;
  bool ground = true;
  double ground_clearance = 0.25;  // [m]

  bool any() const { return free_evidence || careful_sight || birth_age || neighbourhood || ground; }
};

/// Connected echoes are judged together and followed over time.
struct ObjectConfig {
  bool enabled = true;
  double cell = 0.3;         // [m]
  double height = 4.5;       // [m]
  int min_echoes = 5;
  double new_share = 0.4;
  double stop_time = 0.5;    // [s]
};

/// Where the ego motion comes from, and how long a cloud waits for it.
struct MotionConfig {
  OdometrySource source = OdometrySource::kPose;
  std::string fixed_frame = "odom";
  std::string base_frame = "base_link";
  double max_extrapolation = 0.02;  // [s]
  double odometry_timeout = 0.6;    // [s]
  bool deskew = true;
};

/// What a driver's clouds need to be told about where they cannot tell it themselves.
struct CloudConfig {
  std::string time_field;  // empty: found by its name
  TimeEncoding time_encoding = TimeEncoding::kAuto;
  double origin_x = 0.0, origin_y = 0.0, origin_z = 0.0;  // [m], the sensor in the clouds' frame
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
  int threads = 1;
  EvidenceConfig evidence;
  ObjectConfig objects;
  MotionConfig motion;
  CloudConfig cloud;
  NodeConfig node;

  /// Every fault, a sentence each; empty when the configuration can be used.
  std::vector<std::string> faults() const;

  /// Memory that region and voxel size ask for before the first scan [bytes]; what is held only where
  /// something is hit comes on top (Detector::memoryBytes tells it).
  double gridBytes() const;
};

/// How a parameter is called and what it means.
struct ParameterInfo {
  const char* name;
  const char* unit;     ///< empty where there is none
  const char* meaning;  ///< one sentence
  bool reconfigurable;  ///< also in dynamic_reconfigure
};

/// Shows `visit` every parameter, in the order of the documentation, as one of
///   visit(info, double&, min, max)   visit(info, int&, min, max)   visit(info, bool&)
///   visit(info, std::string&)        visit(info, Enum&)  with namesOf(Enum) as its values.
template <class Visitor>
void visitParameters(Config& config, Visitor&& visit) {
  visit(ParameterInfo{"method", "", "classifier: DONEX, the paper's 3D rule with a z-buffer for its see-through, or a system it is compared with (peopleremover judges whole drives only, never live)", true}, config.method);
  visit(ParameterInfo{"voxel_size", "m", "edge length of a voxel", true}, config.voxel_size, 0.02, 2.0);
  Region& r = config.region;
  visit(ParameterInfo{"x_min", "m", "region of interest, vehicle frame, rear", true}, r.x_min, -500.0, 500.0);
  visit(ParameterInfo{"x_max", "m", "region of interest, vehicle frame, front", true}, r.x_max, -500.0, 500.0);
  visit(ParameterInfo{"y_min", "m", "region of interest, vehicle frame, right", true}, r.y_min, -500.0, 500.0);
  visit(ParameterInfo{"y_max", "m", "region of interest, vehicle frame, left", true}, r.y_max, -500.0, 500.0);
  visit(ParameterInfo{"z_min", "m", "region of interest, vehicle frame, bottom", true}, r.z_min, -100.0, 100.0);
  visit(ParameterInfo{"z_max", "m", "region of interest, vehicle frame, top", true}, r.z_max, -100.0, 100.0);
  visit(ParameterInfo{"compensation", "", "voxel shift of the paper's rule: scroll the grid in the odometry frame's axes, or resample its contents into the vehicle frame; with evidence the grid always scrolls", true},
        config.compensation);
  visit(ParameterInfo{"memory_limit", "MB", "largest grid that is accepted; region and voxel size decide what a grid needs", true}, config.memory_limit, 10, 100000);
  visit(ParameterInfo{"threads", "", "threads that the paper's 3D grid may use; labels do not depend on it", true}, config.threads, 1, 64);

  EvidenceConfig& e = config.evidence;
  visit(ParameterInfo{"free_evidence", "", "a place counts as new only where earlier scans saw it free", true}, e.free_evidence);
  visit(ParameterInfo{"free_scans", "scans", "scans that must have seen a place free", true}, e.free_scans, 1, 20);
  visit(ParameterInfo{"history_length", "s", "how long a scan's lines of sight are remembered", true}, e.history_length, 0.1, 10.0);
  visit(ParameterInfo{"sight_margin", "m", "how far behind a place a line of sight must end to see it free", true}, e.sight_margin, 0.0, 5.0);
  visit(ParameterInfo{"careful_sight", "", "read the nearest of neighbouring lines of sight, so grazed surfaces are not seen free, and several scans to free a settled voxel", true}, e.careful_sight);
  visit(ParameterInfo{"sight_gap", "deg", "largest angle between two beams that are read as neighbours", true}, e.sight_gap, 0.1, 10.0);
  visit(ParameterInfo{"settled_free_scans", "scans", "scans that must have seen a settled voxel free before it counts as new again", true}, e.settled_free_scans, 1, 50);
  visit(ParameterInfo{"birth_age", "", "a voxel stays new for a while after its birth, not for one scan only", true}, e.birth_age);
  visit(ParameterInfo{"birth_window", "s", "how long a voxel stays new; older ones are settled", true}, e.birth_window, 0.0, 10.0);
  visit(ParameterInfo{"neighbourhood", "", "a new voxel that touches settled ones is a surface on a voxel border", true}, e.neighbourhood);
  visit(ParameterInfo{"ground", "", "echoes on the local ground are never dynamic", true}, e.ground);
  visit(ParameterInfo{"ground_clearance", "m", "height above the local ground below which an echo is ground", true}, e.ground_clearance, 0.0, 2.0);

  ObjectConfig& o = config.objects;
  visit(ParameterInfo{"objects", "", "connected echoes are judged together and followed over time", true}, o.enabled);
  visit(ParameterInfo{"object_cell", "m", "edge of the cells whose touching connects echoes", true}, o.cell, 0.1, 2.0);
  visit(ParameterInfo{"object_height", "m", "echoes higher above ground belong to no object", true}, o.height, 0.5, 20.0);
  visit(ParameterInfo{"object_min_echoes", "echoes", "new echoes that an object must have to be dynamic", true}, o.min_echoes, 1, 1000);
  visit(ParameterInfo{"object_new_share", "", "share of new among the new and settled echoes of a dynamic object", true}, o.new_share, 0.0, 1.0);
  visit(ParameterInfo{"object_stop_time", "s", "an object without evidence of motion stays dynamic for this long", true}, o.stop_time, 0.0, 30.0);

  MotionConfig& m = config.motion;
  visit(ParameterInfo{"odometry_source", "", "ego motion: odometry pose, odometry twist integrated, tf, or none for a sensor at rest", false}, m.source);
  visit(ParameterInfo{"fixed_frame", "", "frame of the motion with odometry_source tf; otherwise the odometry's own frame is used", false}, m.fixed_frame);
  visit(ParameterInfo{"base_frame", "", "vehicle frame; the odometry's child frame where it names one", false}, m.base_frame);
  visit(ParameterInfo{"max_extrapolation", "s", "how far beyond the newest odometry a pose may be extrapolated", false}, m.max_extrapolation, 0.0, 0.5);
  visit(ParameterInfo{"odometry_timeout", "s", "how long a cloud waits for odometry that covers its stamp", false}, m.odometry_timeout, 0.0, 10.0);
  visit(ParameterInfo{"deskew", "", "move each echo to the cloud's stamp by its own time, where the cloud carries one", false}, m.deskew);

  CloudConfig& c = config.cloud;
  visit(ParameterInfo{"time_field", "", "field of the clouds that holds each echo's own time; empty: time, t, offset_time or timestamp, whichever is there", false}, c.time_field);
  visit(ParameterInfo{"time_encoding", "", "what time_field holds; auto: as the known drivers write it", false}, c.time_encoding);
  visit(ParameterInfo{"origin_x", "m", "where the sensor sits in the frame of the clouds: lines of sight begin here; other than 0 only for clouds that were merged or transformed", false}, c.origin_x, -100.0, 100.0);
  visit(ParameterInfo{"origin_y", "m", "as origin_x", false}, c.origin_y, -100.0, 100.0);
  visit(ParameterInfo{"origin_z", "m", "as origin_x", false}, c.origin_z, -100.0, 100.0);

  NodeConfig& n = config.node;
  visit(ParameterInfo{"queue_size", "clouds", "clouds that may wait for odometry; the oldest is dropped beyond", false}, n.queue_size, 1, 1000);
  visit(ParameterInfo{"markers", "", "publish ~markers at all", true}, n.markers);
  visit(ParameterInfo{"marker_cells", "", "markers of dynamic cells", true}, n.marker_cells);
  visit(ParameterInfo{"marker_objects", "", "markers of objects and their velocities", true}, n.marker_objects);
  visit(ParameterInfo{"marker_grid", "", "marker of the grid's outline", true}, n.marker_grid);
}

}  // namespace donex
