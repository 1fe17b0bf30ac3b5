// An octree of what the sensor saw: static echoes in, a map without moving objects out. A consumer of ~static_points.
#pragma once

#include <cstddef>
#include <memory>

#include <Eigen/Geometry>
#include <sensor_msgs/PointCloud2.h>

namespace donex {

class OctomapBuilder {
 public:
  struct Options {
    double resolution = 0.2;   ///< edge of a leaf [m]
    double max_range = 40.0;   ///< lines of sight end here; echoes beyond only free space up to it [m]
    double map_range = 100.0;  ///< what lies farther from the sensor, along x, y or z, is forgotten [m]; 0: nothing is
  };

  /// Lines of sight of so many leaves fit into the octree wherever the sensor is [leaves].
  static constexpr int kReach = 1 << 14;

  explicit OctomapBuilder(const Options& options);
  ~OctomapBuilder();

  /// Adds a cloud with its lines of sight. Echoes in the cloud's frame, lines of sight begin in its origin.
  /// False when the cloud cannot be read (judgeLayout); then nothing is added.
  bool add(const sensor_msgs::PointCloud2& cloud, const Eigen::Isometry3d& map_from_cloud);

  /// What memory grows with: all nodes, of the free space as well.
  std::size_t nodes() const;

  /// Is the leaf at this place occupied? [m]
  bool isOccupied(const Eigen::Vector3d& place) const;

  /// Centres of the occupied leaves, x, y, z [m] in `header`'s frame.
  sensor_msgs::PointCloud2Ptr occupiedCells(const std_msgs::Header& header) const;

 private:
  /// The octree's keys reach twice kReach from its origin, and its coordinates are in single precision.
  void followWithOrigin(const Eigen::Vector3d& sensor);

  /// Forgets what lies beyond the map's range, where the sensor has moved far enough since the last time.
  void forgetAround(const Eigen::Vector3d& sensor);

  struct Tree;
  Options options_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();            ///< of the octree, in the map [m]
  Eigen::Vector3d forgotten_around_ = Eigen::Vector3d::Zero();  ///< the sensor's place then [m]
  std::unique_ptr<Tree> tree_;
};

}  // namespace donex
