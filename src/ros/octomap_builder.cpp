#include "ros/octomap_builder.h"

#include <limits>
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

/// Sets a leaf of any depth, in a tree whose inner nodes are updated later.
void setLeaf(octomap::OcTree& octree, const octomap::OcTreeKey& key, unsigned depth, float log_odds) {
  constexpr bool kLazy = true;
  if (octree.getRoot() == nullptr) octree.setNodeValue(key, log_odds, kLazy);  // only this makes a root
  octomap::OcTreeNode* node = octree.getRoot();
  for (unsigned level = octree.getTreeDepth(); level-- > octree.getTreeDepth() - depth;) {
    const unsigned child = octomap::computeChildIdx(key, static_cast<int>(level));
    node = octree.nodeChildExists(node, child) ? octree.getNodeChild(node, child) : octree.createNodeChild(node, child);
  }
  collapse(octree, node, octree.nodeHasChildren(node));
  node->setLogOdds(log_odds);
}

/// Moves the contents of an octree against its origin. What its keys do not reach there is lost.
void moveBy(octomap::OcTree& octree, const Eigen::Array3i& leaves) {
  constexpr int kKeys = std::numeric_limits<octomap::key_type>::max() + 1;
  octomap::OcTree moved(octree.getResolution());
  for (auto leaf = octree.begin_leafs(); leaf != octree.end_leafs(); ++leaf) {
    const octomap::OcTreeKey old = leaf.getKey();
    const Eigen::Array3i key = Eigen::Array3i(old[0], old[1], old[2]) + leaves;
    const bool is_reached = (key >= 0).all() && (key < kKeys).all();
    if (!is_reached) continue;
    const auto part = [&key](int axis) { return static_cast<octomap::key_type>(key[axis]); };
    setLeaf(moved, {part(0), part(1), part(2)}, leaf.getDepth(), leaf->getLogOdds());
  }
  moved.updateInnerOccupancy();
  octree.swapContent(moved);
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
  followWithOrigin(map_from_cloud.translation());
  const Eigen::Isometry3f transform = (Eigen::Translation3d(-origin_) * map_from_cloud).cast<float>();
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

void OctomapBuilder::followWithOrigin(const Eigen::Vector3d& sensor) {
  // Leaves that have absorbed others are smaller than this: after it they fall on leaves again.
  constexpr int kStep = kReach / 2;
  const double step = kStep * options_.resolution;
  const bool is_far = (sensor - origin_).cwiseAbs().maxCoeff() > kReach * options_.resolution;
  if (!is_far) return;
  const Eigen::Array3d steps = ((sensor - origin_).array() / step).round();
  origin_ += (step * steps).matrix();
  moveBy(tree_->octree, -kStep * steps.cast<int>());
}

void OctomapBuilder::forgetAround(const Eigen::Vector3d& sensor) {
  // Often enough for the range to hold to a block, seldom enough not to walk the tree for every cloud.
  const double moved = (sensor - forgotten_around_).cwiseAbs().maxCoeff();
  if (moved < Forgetting::blockOf(tree_->octree)) return;
  forgotten_around_ = sensor;
  Forgetting(tree_->octree, sensor - origin_, options_.map_range).run();
}

std::size_t OctomapBuilder::nodes() const { return tree_->octree.size(); }

bool OctomapBuilder::isOccupied(const Eigen::Vector3d& place) const {
  const Eigen::Vector3d in_tree = place - origin_;
  const octomap::OcTreeNode* node = tree_->octree.search(in_tree.x(), in_tree.y(), in_tree.z());
  return node != nullptr && tree_->octree.isNodeOccupied(node);
}

sensor_msgs::PointCloud2Ptr OctomapBuilder::occupiedCells(const std_msgs::Header& header) const {
  std::vector<Eigen::Vector3f> centers;
  for (auto leaf = tree_->octree.begin_leafs(); leaf != tree_->octree.end_leafs(); ++leaf) {
    if (!tree_->octree.isNodeOccupied(*leaf)) continue;
    centers.emplace_back((origin_ + Eigen::Vector3d(leaf.getX(), leaf.getY(), leaf.getZ())).cast<float>());
  }
  return cellCloud(centers, header);
}

}  // namespace donex
