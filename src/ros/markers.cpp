#include "ros/markers.h"

#include <iomanip>
#include <sstream>

#include <boost/make_shared.hpp>
#include <tf2_eigen/tf2_eigen.h>

namespace donex {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr double kArrowSeconds = 1.0;  // an arrow is as long as the way of this time
constexpr double kTextHeight = 0.8;    // [m]
constexpr double kSlowestArrow = 0.2;  // [m/s]; below, the direction is noise

std_msgs::ColorRGBA colour(float r, float g, float b, float a) {
  std_msgs::ColorRGBA colour;
  colour.r = r;
  colour.g = g;
  colour.b = b;
  colour.a = a;
  return colour;
}

geometry_msgs::Point pointOf(const Eigen::Vector3d& position) { return tf2::toMsg(position); }

Marker markerOf(const std_msgs::Header& header, const char* name_space, std::int32_t id, std::int32_t type) {
  Marker marker;
  marker.header = header;
  marker.ns = name_space;
  marker.id = id;
  marker.type = type;
  marker.action = Marker::ADD;
  marker.pose.orientation.w = 1.0;
  return marker;
}

void addCells(const Detector& detector, double voxel_size, const std_msgs::Header& header, MarkerArray& array) {
  const auto cells = detector.dynamicCells();
  if (cells.empty()) return;  // an ADD without points is an error in rviz
  Marker marker = markerOf(header, "dynamic_cells", 0, Marker::CUBE_LIST);
  marker.scale.x = marker.scale.y = marker.scale.z = voxel_size;
  marker.color = colour(1.0F, 0.0F, 1.0F, 0.6F);
  marker.points.reserve(cells.size());
  for (const Eigen::Vector3f& cell : cells) marker.points.push_back(pointOf(cell.cast<double>()));
  array.markers.push_back(std::move(marker));
}

void addBox(const Object& object, const std_msgs::Header& header, MarkerArray& array) {
  Marker box = markerOf(header, "objects", static_cast<std::int32_t>(object.id), Marker::CUBE);
  box.pose = tf2::toMsg(object.odom_from_box);
  // rviz refuses a scale of zero, which a flat object has.
  const Eigen::Vector3d size = object.size.cwiseMax(0.01);
  box.scale.x = size.x();
  box.scale.y = size.y();
  box.scale.z = size.z();
  box.color = object.dynamic ? colour(1.0F, 0.5F, 0.0F, 0.35F) : colour(0.6F, 0.6F, 0.6F, 0.25F);
  array.markers.push_back(std::move(box));
}

void addVelocity(const Object& object, const std_msgs::Header& header, MarkerArray& array) {
  const double speed = object.velocity.norm();
  const bool shows = object.dynamic && speed > kSlowestArrow;
  if (!shows) return;
  Marker arrow = markerOf(header, "velocities", static_cast<std::int32_t>(object.id), Marker::ARROW);
  const Eigen::Vector3d from = object.odom_from_box.translation();
  arrow.points = {pointOf(from), pointOf(from + kArrowSeconds * object.velocity)};
  arrow.scale.x = 0.15;  // shaft, head, length of the head [m]
  arrow.scale.y = 0.4;
  arrow.scale.z = 0.5;
  arrow.color = colour(1.0F, 1.0F, 0.0F, 1.0F);
  array.markers.push_back(std::move(arrow));
}

void addSpeed(const Object& object, const std_msgs::Header& header, MarkerArray& array) {
  if (!object.dynamic) return;
  Marker text = markerOf(header, "speeds", static_cast<std::int32_t>(object.id), Marker::TEXT_VIEW_FACING);
  const Eigen::Vector3d above(0.0, 0.0, 0.5 * object.size.z() + kTextHeight);
  text.pose.position = pointOf(object.odom_from_box.translation() + above);
  text.scale.x = text.scale.y = text.scale.z = kTextHeight;
  text.color = colour(1.0F, 1.0F, 1.0F, 1.0F);
  std::ostringstream words;
  words << std::fixed << std::setprecision(1) << object.velocity.norm() << " m/s";
  text.text = words.str();
  array.markers.push_back(std::move(text));
}

void addObjects(const Detector& detector, const std_msgs::Header& header, MarkerArray& array) {
  for (const Object& object : detector.objects()) {
    addBox(object, header, array);
    addVelocity(object, header, array);
    addSpeed(object, header, array);
  }
}

/// The twelve edges of the grid, as pairs of corners: those that differ in one coordinate.
void addOutline(const GridOutline& outline, const std_msgs::Header& header, MarkerArray& array) {
  Marker marker = markerOf(header, "grid", 0, Marker::LINE_LIST);
  marker.pose = tf2::toMsg(outline.odom_from_grid);
  marker.scale.x = 0.05;
  marker.color = colour(0.3F, 0.6F, 1.0F, 0.6F);
  const auto corner = [&](unsigned bits) {
    const auto pick = [&](Eigen::Index axis) {
      return (bits >> axis & 1U) != 0 ? outline.max_corner[axis] : outline.min_corner[axis];
    };
    return pointOf({pick(0), pick(1), pick(2)});
  };
  for (unsigned from = 0; from < 8; ++from) {
    for (const unsigned axis : {1U, 2U, 4U}) {
      if ((from & axis) != 0) continue;
      marker.points.push_back(corner(from));
      marker.points.push_back(corner(from | axis));
    }
  }
  array.markers.push_back(std::move(marker));
}

}  // namespace

visualization_msgs::MarkerArrayPtr MarkerMaker::make(const Detector& detector, const Config& config,
                                                     const ros::Time& stamp, const std::string& odom_frame,
                                                     const Eigen::Isometry3d& odom_from_world) {
  header_.stamp = stamp;
  header_.frame_id = odom_frame;
  auto array = boost::make_shared<MarkerArray>();
  const NodeConfig& wanted = config.node;
  if (wanted.markers && wanted.marker_cells) addCells(detector, config.voxel_size, header_, *array);
  if (wanted.markers && wanted.marker_objects) addObjects(detector, header_, *array);
  if (wanted.markers && wanted.marker_grid) addOutline(detector.outline(), header_, *array);
  for (Marker& marker : array->markers) {
    Eigen::Isometry3d world_from_marker;
    tf2::fromMsg(marker.pose, world_from_marker);
    marker.pose = tf2::toMsg(Eigen::Isometry3d(odom_from_world * world_from_marker));
  }
  deleteGone(*array);
  return array;
}

visualization_msgs::MarkerArrayPtr MarkerMaker::clear() {
  auto array = boost::make_shared<MarkerArray>();
  deleteGone(*array);
  return array;
}

void MarkerMaker::deleteGone(MarkerArray& array) {
  std::set<Key> now;
  for (const Marker& marker : array.markers) now.emplace(marker.ns, marker.id);
  for (const Key& key : shown_) {
    if (now.count(key) != 0) continue;
    Marker marker = markerOf(header_, key.first.c_str(), key.second, Marker::CUBE);
    marker.action = Marker::DELETE;
    array.markers.push_back(std::move(marker));
  }
  shown_ = std::move(now);
}

}  // namespace donex
