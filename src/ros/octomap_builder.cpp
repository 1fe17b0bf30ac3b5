#include "ros/octomap_builder.h"

#include <vector>

#include <octomap/OcTree.h>

#include "ros/conversions.h"
#include "ros/explanation_clouds.h"

namespace donex {

struct OctomapBuilder::Tree {
  explicit Tree(double resolution) : octree(resolution) {}
  octomap::OcTree octree;
};

OctomapBuilder::OctomapBuilder(const Options& options)
    : options_(options), tree_(std::make_unique<Tree>(options.resolution)) {}

OctomapBuilder::~OctomapBuilder() = default;

bool OctomapBuilder::add(const sensor_msgs::PointCloud2& cloud, const Eigen::Isometry3d& map_from_cloud) {
  const LayoutVerdict verdict = judgeLayout(cloud);
  const auto* layout = std::get_if<CloudLayout>(&verdict);
  if (layout == nullptr) return false;
  std::vector<Eigen::Vector3f> echoes;
  parseEchoes(cloud, *layout, echoes);
  octomap::Pointcloud points;
  points.reserve(echoes.size());
  const Eigen::Isometry3f transform = map_from_cloud.cast<float>();
  for (const Eigen::Vector3f& echo : echoes) {
    if (!echo.allFinite()) continue;
    const Eigen::Vector3f place = transform * echo;
    points.push_back(place.x(), place.y(), place.z());
  }
  const Eigen::Vector3f origin = transform.translation();
  constexpr bool kLazy = true, kOneRayALeaf = true;
  tree_->octree.insertPointCloud(points, {origin.x(), origin.y(), origin.z()}, options_.max_range, kLazy, kOneRayALeaf);
  tree_->octree.updateInnerOccupancy();
  return true;
}

bool OctomapBuilder::isOccupied(const Eigen::Vector3d& place) const {
  const octomap::OcTreeNode* node = tree_->octree.search(place.x(), place.y(), place.z());
  return node != nullptr && tree_->octree.isNodeOccupied(node);
}

sensor_msgs::PointCloud2Ptr OctomapBuilder::occupiedCells(const std_msgs::Header& header) const {
  std::vector<Eigen::Vector3f> centers;
  for (auto leaf = tree_->octree.begin_leafs(); leaf != tree_->octree.end_leafs(); ++leaf) {
    if (!tree_->octree.isNodeOccupied(*leaf)) continue;
    centers.emplace_back(Eigen::Vector3d(leaf.getX(), leaf.getY(), leaf.getZ()).cast<float>());
  }
  return cellCloud(centers, header);
}

}  // namespace donex
