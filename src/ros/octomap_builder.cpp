#include "ros/octomap_builder.h"

#include <vector>

#include <octomap/OcTree.h>

#include "ros/conversions.h"
#include "ros/explanation_clouds.h"

namespace donex {

namespace {

constexpr unsigned kChildren = 8;
constexpr unsigned kBlockLevels = 4;  // blocks of 16 leaves a side are forgotten as one

/// Makes a leaf of a node. OcTree::deleteNodeChild frees neither what is below the child nor the child's own array of
/// children: only pruneNode does, and only where all children are leaves that agree.
void collapse(octomap::OcTree& octree, octomap::OcTreeNode* node, bool has_array) {
  for (unsigned i = 0; i < kChildren; ++i) {
    if (!octree.nodeChildExists(node, i)) continue;
    octomap::OcTreeNode* child = octree.getNodeChild(node, i);
    if (octree.nodeHasChildren(child)) collapse(octree, child, true);
  }
  if (!has_array) return;
  for (unsigned i = 0; i < kChildren; ++i) {
    const bool is_there = octree.nodeChildExists(node, i);
    octomap::OcTreeNode* child = is_there ? octree.getNodeChild(node, i) : octree.createNodeChild(node, i);
    child->setLogOdds(0.0F);
  }
  octree.pruneNode(node);
}

/// Forgets blocks of an octree that lie beyond a range.
class Forgetting {
 public:
  Forgetting(octomap::OcTree& octree, const Eigen::Vector3d& around, double range)
      : octree_(octree), around_(around), range_(range), block_(blockOf(octree)) {}

  static double blockOf(const octomap::OcTree& octree) {
    return octree.getNodeSize(octree.getTreeDepth() - kBlockLevels);
  }

  void run() {
    octomap::OcTreeNode* root = octree_.getRoot();
    if (root == nullptr) return;
    const bool is_gone = forgetIn(root, Eigen::Vector3d::Zero(), octree_.getNodeSize(0));
    if (is_gone) octree_.clear();
  }

 private:
  /// True where nothing is left of the node: then it is a leaf for its parent to delete.
  bool forgetIn(octomap::OcTreeNode* node, const Eigen::Vector3d& center, double size) {
    const double distance = (center - around_).cwiseAbs().maxCoeff();
    const bool has_children = octree_.nodeHasChildren(node);
    if (distance - 0.5 * size > range_) {
      collapse(octree_, node, has_children);
      return true;
    }
    const bool is_within = distance + 0.5 * size <= range_;
    const bool is_block = size < 1.5 * block_;
    if (is_within || is_block || !has_children) return false;
    for (unsigned i = 0; i < kChildren; ++i) {
      if (!octree_.nodeChildExists(node, i)) continue;
      const Eigen::Vector3d side((i & 1U) != 0 ? 1.0 : -1.0, (i & 2U) != 0 ? 1.0 : -1.0, (i & 4U) != 0 ? 1.0 : -1.0);
      const bool is_gone = forgetIn(octree_.getNodeChild(node, i), center + 0.25 * size * side, 0.5 * size);
      if (is_gone) octree_.deleteNodeChild(node, i);
    }
    if (octree_.nodeHasChildren(node)) {
      node->updateOccupancyChildren();
      return false;
    }
    collapse(octree_, node, true);
    return true;
  }

  octomap::OcTree& octree_;
  Eigen::Vector3d around_;
  double range_, block_;  // [m]
};

}  // namespace

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
  // Not lazily: leaves that agree become one on the way, in place of a walk through the whole tree for every cloud.
  constexpr bool kLazy = false, kOneRayALeaf = true;
  tree_->octree.insertPointCloud(points, {origin.x(), origin.y(), origin.z()}, options_.max_range, kLazy, kOneRayALeaf);
  if (options_.map_range > 0.0) forgetAround(map_from_cloud.translation());
  return true;
}

void OctomapBuilder::forgetAround(const Eigen::Vector3d& sensor) {
  // Often enough for the range to hold to a block, seldom enough not to walk the tree for every cloud.
  const double moved = (sensor - forgotten_around_).cwiseAbs().maxCoeff();
  if (moved < Forgetting::blockOf(tree_->octree)) return;
  forgotten_around_ = sensor;
  Forgetting(tree_->octree, sensor, options_.map_range).run();
}

std::size_t OctomapBuilder::nodes() const { return tree_->octree.size(); }

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
