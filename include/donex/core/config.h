// Everything a user can set, with its default, unit, range and meaning: the one place for it.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace donex {

enum class Method { kDonex3d, kDonex2d };
enum class Compensation { kScroll, kResample };
enum class OdometrySource { kPose, kTwist, kTf, kNone };

inline const std::vector<std::string>& namesOf(Method) {
  static const std::vector<std::string> names{"donex_3d", "donex_2d"};
  return names;
}
inline const std::vector<std::string>& namesOf(Compensation) {
  static const std::vector<std::string> names{"scroll", "resample"};
  return names;
}
inline const std::vector<std::string>& namesOf(OdometrySource) {
  static const std::vector<std::string> names{"pose", "twist", "tf", "none"};
  return names;
}

/// Region of interest in the vehicle frame [m]; an echo on the lower face is inside, on the upper outside.
struct Region {
  double x_min = -50.0, x_max = 50.0;
  double y_min = -50.0, y_max = 50.0;
  double z_min = -4.0, z_max = 6.0;
};

/// Where the ego motion comes from, and how long a cloud waits for it.
struct MotionConfig {
  OdometrySource source = OdometrySource::kPose;
  std::string fixed_frame = "odom";
  std::string base_frame = "base_link";
  double max_extrapolation = 0.02;  // [s]
  double odometry_timeout = 0.5;    // [s]
  bool deskew = true;
};

/// What the node does beside labelling.
struct NodeConfig {
  int queue_size = 10;
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
  MotionConfig motion;
  NodeConfig node;

  /// Every fault, a sentence each; empty when the configuration can be used.
  std::vector<std::string> faults() const;
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
  visit(ParameterInfo{"method", "", "classifier", true}, config.method);
  visit(ParameterInfo{"voxel_size", "m", "edge length of a voxel", true}, config.voxel_size, 0.02, 2.0);
  Region& r = config.region;
  visit(ParameterInfo{"x_min", "m", "region of interest, vehicle frame, rear", true}, r.x_min, -500.0, 500.0);
  visit(ParameterInfo{"x_max", "m", "region of interest, vehicle frame, front", true}, r.x_max, -500.0, 500.0);
  visit(ParameterInfo{"y_min", "m", "region of interest, vehicle frame, right", true}, r.y_min, -500.0, 500.0);
  visit(ParameterInfo{"y_max", "m", "region of interest, vehicle frame, left", true}, r.y_max, -500.0, 500.0);
  visit(ParameterInfo{"z_min", "m", "region of interest, vehicle frame, bottom", true}, r.z_min, -100.0, 100.0);
  visit(ParameterInfo{"z_max", "m", "region of interest, vehicle frame, top", true}, r.z_max, -100.0, 100.0);
  visit(ParameterInfo{"compensation", "", "voxel shift: scroll the grid in the odometry frame's axes, or resample its contents into the vehicle frame", true},
        config.compensation);

  MotionConfig& m = config.motion;
  visit(ParameterInfo{"odometry_source", "", "ego motion: odometry pose, odometry twist integrated, tf, or none for a sensor at rest", false}, m.source);
  visit(ParameterInfo{"fixed_frame", "", "frame of the motion with odometry_source tf; otherwise the odometry's own frame is used", false}, m.fixed_frame);
  visit(ParameterInfo{"base_frame", "", "vehicle frame; the odometry's child frame where it names one", false}, m.base_frame);
  visit(ParameterInfo{"max_extrapolation", "s", "how far beyond the newest odometry a pose may be extrapolated", false}, m.max_extrapolation, 0.0, 0.5);
  visit(ParameterInfo{"odometry_timeout", "s", "how long a cloud waits for odometry that covers its stamp", false}, m.odometry_timeout, 0.0, 10.0);
  visit(ParameterInfo{"deskew", "", "move each echo to the cloud's stamp by its own time, where the cloud carries one", false}, m.deskew);

  NodeConfig& n = config.node;
  visit(ParameterInfo{"queue_size", "clouds", "clouds that may wait for odometry; the oldest is dropped beyond", false}, n.queue_size, 1, 1000);
  visit(ParameterInfo{"markers", "", "publish ~markers at all", true}, n.markers);
  visit(ParameterInfo{"marker_cells", "", "markers of dynamic cells", true}, n.marker_cells);
  visit(ParameterInfo{"marker_objects", "", "markers of objects and their velocities", true}, n.marker_objects);
  visit(ParameterInfo{"marker_grid", "", "marker of the grid's outline", true}, n.marker_grid);
}

}  // namespace donex
