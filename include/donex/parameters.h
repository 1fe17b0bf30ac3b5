// Every parameter with its name, unit, range and meaning: the one place for them.
#pragma once

#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "donex/config.h"

namespace donex {

/// Parameters that are shown together.
enum class ParameterGroup { kClassifier, kRegion, kEvidence, kBody, kObjects, kMotion, kClouds, kNode };

inline const char* nameOf(ParameterGroup group) {
  constexpr const char* kNames[] = {"Classifier", "Region", "Evidence", "Body", "Objects", "Motion", "Clouds", "Node"};
  return kNames[static_cast<std::size_t>(group)];
}

/// How a parameter is called and what it means.
struct ParameterInfo {
  const char* name;
  const char* unit;                                    ///< empty where it has no unit
  const char* meaning;                                 ///< one sentence
  bool reconfigurable;                                 ///< also in dynamic_reconfigure
  ParameterGroup group = ParameterGroup::kClassifier;  ///< visitParameters knows it
};

template <class Visitor>
void visitClassifier(Config& config, Visitor& visit) {
  visit(ParameterInfo{"method", "",
                      "classifier: DONEX, the paper in 3D with a z-buffer for its see-through, or a system it is "
                      "compared with (the node refuses those that judge whole drives only)",
                      true},
        config.method);
  visit(ParameterInfo{"voxel_size", "m", "edge length of a voxel", true}, config.voxel_size, 0.02, 2.0);
  visit(ParameterInfo{"compensation", "",
                      "voxel shift of the paper: scroll the grid along the axes of the odometry frame, or resample its "
                      "contents into the vehicle frame; with evidence the grid always scrolls",
                      true},
        config.compensation);
  visit(ParameterInfo{"memory_limit", "MB",
                      "most that the grid may take with scans of 120,000 echoes; what it needs follows from region "
                      "and voxel size",
                      true},
        config.memory_limit, 10, 100000);
  visit(ParameterInfo{"threads", "",
                      "threads that judge a scan together (donex_2d, donex_3d); labels do not depend on it", true},
        config.threads, 1, 64);
}

template <class Visitor>
void visitRegion(Region& r, Visitor& visit) {
  visit(ParameterInfo{"x_min", "m", "region of interest, vehicle frame, rear", true}, r.x_min, -500.0, 500.0);
  visit(ParameterInfo{"x_max", "m", "region of interest, vehicle frame, front", true}, r.x_max, -500.0, 500.0);
  visit(ParameterInfo{"y_min", "m", "region of interest, vehicle frame, right", true}, r.y_min, -500.0, 500.0);
  visit(ParameterInfo{"y_max", "m", "region of interest, vehicle frame, left", true}, r.y_max, -500.0, 500.0);
  visit(ParameterInfo{"z_min", "m", "region of interest, vehicle frame, bottom", true}, r.z_min, -100.0, 100.0);
  visit(ParameterInfo{"z_max", "m", "region of interest, vehicle frame, top", true}, r.z_max, -100.0, 100.0);
}

template <class Visitor>
void visitEvidence(EvidenceConfig& e, Visitor& visit) {
  visit(ParameterInfo{"free_evidence", "", "a place counts as new only where earlier scans saw it free", true},
        e.free_evidence);
  visit(ParameterInfo{"free_scans", "scans", "scans that must have seen a place free", true}, e.free_scans, 1, 20);
  visit(ParameterInfo{"history_length", "s", "how long the lines of sight of a scan are remembered", true},
        e.history_length, 0.1, 10.0);
  visit(ParameterInfo{"sight_margin", "m", "how far behind a place a line of sight must end to see it free", true},
        e.sight_margin, 0.0, 5.0);
  visit(ParameterInfo{"careful_sight", "",
                      "read the nearest of neighbouring lines of sight, so grazed surfaces are not seen free, and "
                      "several scans to free a settled voxel",
                      true},
        e.careful_sight);
  visit(ParameterInfo{"sight_gap", "deg", "largest angle between two beams that are read as neighbours", true},
        e.sight_gap, 0.1, 10.0);
  visit(ParameterInfo{"settled_free_scans", "scans",
                      "scans that must have seen a settled voxel free before it counts as new again", true},
        e.settled_free_scans, 1, 50);
  visit(ParameterInfo{"birth_age", "", "a voxel stays new for a while after its birth, not for one scan only", true},
        e.birth_age);
  visit(ParameterInfo{"birth_window", "s", "how long a voxel stays new; older ones are settled", true}, e.birth_window,
        0.0, 10.0);
  visit(
      ParameterInfo{"neighbourhood", "", "a new voxel that touches settled ones is a surface on a voxel border", true},
      e.neighbourhood);
  visit(ParameterInfo{"ground", "", "echoes on the local ground are never dynamic", true}, e.ground);
  visit(ParameterInfo{"ground_clearance", "m",
                      "height above the local ground below which an echo is ground, but for low parts of what moves",
                      true},
        e.ground_clearance, 0.0, 2.0);
}

template <class Visitor>
void visitSelf(SelfConfig& s, Visitor& visit) {
  visit(ParameterInfo{"self_detection", "",
                      "echoes that stay near the sensor while the vehicle moves are its own body: never dynamic", true},
        s.detection);
  visit(ParameterInfo{"self_x_min", "m", "box of the own body, vehicle frame, rear; empty where min equals max", false},
        s.x_min, -100.0, 100.0);
  visit(ParameterInfo{"self_x_max", "m", "box of the own body, vehicle frame, front", false}, s.x_max, -100.0, 100.0);
  visit(ParameterInfo{"self_y_min", "m", "box of the own body, vehicle frame, right", false}, s.y_min, -100.0, 100.0);
  visit(ParameterInfo{"self_y_max", "m", "box of the own body, vehicle frame, left", false}, s.y_max, -100.0, 100.0);
  visit(ParameterInfo{"self_z_min", "m", "box of the own body, vehicle frame, bottom", false}, s.z_min, -100.0, 100.0);
  visit(ParameterInfo{"self_z_max", "m", "box of the own body, vehicle frame, top", false}, s.z_max, -100.0, 100.0);
}

template <class Visitor>
void visitObjects(ObjectConfig& o, Visitor& visit) {
  visit(ParameterInfo{"objects", "", "connected echoes are judged together and followed over time", true}, o.enabled);
  visit(ParameterInfo{"object_cell", "m", "edge of the cells whose touching connects echoes", true}, o.cell, 0.1, 2.0);
  visit(ParameterInfo{"object_height", "m", "echoes higher above ground belong to no object", true}, o.height, 0.5,
        20.0);
  visit(ParameterInfo{"object_min_echoes", "echoes", "new echoes that an object must have to be dynamic", true},
        o.min_echoes, 1, 1000);
  visit(
      ParameterInfo{"object_new_share", "", "share of new among the new and settled echoes of a dynamic object", true},
      o.new_share, 0.0, 1.0);
  visit(ParameterInfo{"object_motion", "",
                      "an object moves also where its former place is now seen free, or its former shape is found "
                      "elsewhere; off: only new echoes tell",
                      true},
        o.motion);
  visit(
      ParameterInfo{"object_stop_time", "s", "an object without evidence of motion stays dynamic for this long", true},
      o.stop_time, 0.0, 30.0);
}

template <class Visitor>
void visitMotion(MotionConfig& m, Visitor& visit) {
  visit(ParameterInfo{"odometry_source", "",
                      "ego motion: odometry pose, odometry twist integrated, tf, none for a sensor at rest, lidar for "
                      "the clouds alone, or auto: odometry where some comes, else tf, else the clouds",
                      false},
        m.source);
  visit(
      ParameterInfo{"fixed_frame", "",
                    "frame of the motion with odometry_source tf or lidar; otherwise the odometry's own frame is used",
                    false},
      m.fixed_frame);
  visit(ParameterInfo{"base_frame", "", "vehicle frame; the odometry's child frame where it names one", false},
        m.base_frame);
  visit(ParameterInfo{"max_extrapolation", "s", "how far beyond the newest odometry a pose may be extrapolated", false},
        m.max_extrapolation, 0.0, 0.5);
  visit(ParameterInfo{"odometry_timeout", "s", "how long a cloud waits for odometry that covers its stamp", false},
        m.odometry_timeout, 0.0, 10.0);
  visit(ParameterInfo{"deskew", "",
                      "move each echo to the cloud's stamp by its own time, or by its azimuth where a spinning "
                      "sensor's clouds carry none",
                      false},
        m.deskew);
  visit(ParameterInfo{"publish_tf", "",
                      "where the ego motion is found in the clouds: also publish it as tf, fixed_frame to the vehicle",
                      false},
        m.publish_tf);
  visit(ParameterInfo{"odometry_check", "",
                      "compare odometry and tf with the motion that the clouds show, on a thread of its own, and say "
                      "where they disagree and why; a jump forgets the grid",
                      false},
        m.odometry_check);
  visit(ParameterInfo{"odometry_refine", "",
                      "where odometry or tf never leave a plane, as those of wheels: take height, roll and pitch from "
                      "the clouds, and mend noise of yaw",
                      false},
        m.odometry_refine);
}

template <class Visitor>
void visitCloud(CloudConfig& c, Visitor& visit) {
  visit(ParameterInfo{"time_field", "",
                      "field of the clouds that holds each echo's own time; empty: time, t, offset_time or timestamp, "
                      "whichever is there",
                      false},
        c.time_field);
  visit(ParameterInfo{"time_encoding", "", "what time_field holds; auto: as the known drivers write it", false},
        c.time_encoding);
  visit(ParameterInfo{"origin_x", "m",
                      "where the sensor sits in the frame of the clouds: lines of sight begin here; other than 0 only "
                      "for clouds that were merged or transformed",
                      false},
        c.origin_x, -100.0, 100.0);
  visit(ParameterInfo{"origin_y", "m", "as origin_x", false}, c.origin_y, -100.0, 100.0);
  visit(ParameterInfo{"origin_z", "m", "as origin_x", false}, c.origin_z, -100.0, 100.0);
  visit(ParameterInfo{"sensor_frame", "",
                      "frame of the sensor that measured the clouds, where they are told in another one, as "
                      "base_link or the odometry frame: lines of sight begin where tf has it at their stamp",
                      false},
        c.sensor_frame);
}

template <class Visitor>
void visitNode(NodeConfig& n, Visitor& visit) {
  visit(ParameterInfo{"queue_size", "clouds",
                      "clouds that may wait for odometry, the parts of a turn for one; the oldest is dropped beyond",
                      false},
        n.queue_size, 1, 1000);
  visit(ParameterInfo{"markers", "", "publish ~markers at all", true}, n.markers);
  visit(ParameterInfo{"marker_cells", "", "markers of dynamic cells", true}, n.marker_cells);
  visit(ParameterInfo{"marker_objects", "", "markers of objects and their velocities", true}, n.marker_objects);
  visit(ParameterInfo{"marker_grid", "", "marker of the outline of the grid", true}, n.marker_grid);
}

/// Says in which group a parameter is, and hands it on.
template <class Visitor>
struct GroupVisitor {
  ParameterGroup group;
  Visitor& visit;

  template <class Value, class... Range>
  void operator()(ParameterInfo info, Value& value, Range... range) {
    info.group = group;
    visit(info, value, range...);
  }
};

/// Shows `visit` every parameter, in the order of the documentation, as one of
///   visit(info, double&, min, max)   visit(info, int&, min, max)   visit(info, bool&)
///   visit(info, std::string&)        visit(info, Enum&)  with namesOf(Enum) as its values.
template <class Visitor>
void visitParameters(Config& config, Visitor&& visit) {
  const auto in = [&](ParameterGroup group) { return GroupVisitor<std::remove_reference_t<Visitor>>{group, visit}; };
  auto classifier = in(ParameterGroup::kClassifier), region = in(ParameterGroup::kRegion),
       evidence = in(ParameterGroup::kEvidence), body = in(ParameterGroup::kBody),
       objects = in(ParameterGroup::kObjects), motion = in(ParameterGroup::kMotion),
       clouds = in(ParameterGroup::kClouds), node = in(ParameterGroup::kNode);
  visitClassifier(config, classifier);
  visitRegion(config.region, region);
  visitEvidence(config.evidence, evidence);
  visitSelf(config.self, body);
  visitObjects(config.objects, objects);
  visitMotion(config.motion, motion);
  visitCloud(config.cloud, clouds);
  visitNode(config.node, node);
}

/// A parameter with its value; that of an enumeration is its name.
struct Parameter {
  ParameterInfo info;
  std::variant<bool, int, double, std::string> value;
};

/// Every parameter, in the order of the documentation.
std::vector<Parameter> parametersOf(const Config& config);

/// Whether a parameter belongs to the steps beyond the paper's rule.
constexpr bool isBeyondPaper(const ParameterInfo& info) {
  return info.group == ParameterGroup::kEvidence || info.group == ParameterGroup::kObjects;
}

}  // namespace donex
