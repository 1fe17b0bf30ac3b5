#include "evaluation/phantoms.h"

#include <cmath>
#include <numeric>
#include <unordered_map>

#include "core/grid/voxel_key.h"

namespace donex {
namespace {

/// Points by cubes of space.
class Cubes {
 public:
  Cubes(const std::vector<Eigen::Vector3f>& points, double edge) : points_(points), edge_(edge) {
    for (std::size_t i = 0; i < points.size(); ++i) cubes_[keyOf(cubeOf(points[i]))].push_back(i);
  }

  /// Calls visit(numbers of points) for the cubes up to `reach` around that of a point, until it returns true.
  template <class Visit>
  bool anyAround(const Eigen::Vector3f& point, int reach, Visit&& visit) const {
    const Index3 middle = cubeOf(point);
    for (int z = -reach; z <= reach; ++z) {
      for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
          const auto found = cubes_.find(keyOf(middle + Index3(x, y, z)));
          if (found != cubes_.end() && visit(found->second)) return true;
        }
      }
    }
    return false;
  }

  bool anyWithin(double distance, const Eigen::Vector3f& point, const std::vector<std::size_t>& numbers) const {
    for (const std::size_t i : numbers) {
      if ((points_[i] - point).cast<double>().norm() <= distance) return true;
    }
    return false;
  }

 private:
  Index3 cubeOf(const Eigen::Vector3f& point) const {
    return (point.cast<double>() / edge_).array().floor().cast<int>().matrix();
  }

  const std::vector<Eigen::Vector3f>& points_;
  double edge_;
  std::unordered_map<VoxelKey, std::vector<std::size_t>, VoxelHash> cubes_;
};

/// Single linkage: by point, the number of a point that stands for its cluster.
std::vector<std::size_t> clustersOf(const std::vector<Eigen::Vector3f>& points, double link) {
  // Cubes so small that points of one are always linked: between two cubes the first pair near enough suffices.
  const Cubes cubes(points, 0.999 * link / std::sqrt(3.0));
  std::vector<std::size_t> parents(points.size());
  std::iota(parents.begin(), parents.end(), std::size_t{0});
  const auto root_of = [&](std::size_t i) {
    while (parents[i] != i) i = parents[i] = parents[parents[i]];
    return i;
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    cubes.anyAround(points[i], 2, [&](const std::vector<std::size_t>& numbers) {
      const std::size_t here = root_of(i), there = root_of(numbers.front());
      if (here != there && cubes.anyWithin(link, points[i], numbers)) parents[here] = there;
      return false;
    });
  }
  for (std::size_t i = 0; i < points.size(); ++i) parents[i] = root_of(i);
  return parents;
}

}  // namespace

std::size_t countPhantoms(const std::vector<Eigen::Vector3f>& false_echoes,
                          const std::vector<Eigen::Vector3f>& truly_moving, const PhantomRules& rules) {
  const std::vector<std::size_t> cluster_of = clustersOf(false_echoes, rules.link);
  const Cubes moving(truly_moving, rules.clearance);
  std::vector<std::size_t> echoes_in(false_echoes.size(), 0);
  std::vector<bool> is_near_moving(false_echoes.size(), false);
  for (std::size_t i = 0; i < false_echoes.size(); ++i) {
    ++echoes_in[cluster_of[i]];
    if (is_near_moving[cluster_of[i]]) continue;
    is_near_moving[cluster_of[i]] = moving.anyAround(false_echoes[i], 1, [&](const std::vector<std::size_t>& numbers) {
      return moving.anyWithin(rules.clearance, false_echoes[i], numbers);
    });
  }
  std::size_t phantoms = 0;
  for (std::size_t i = 0; i < false_echoes.size(); ++i) {
    phantoms += echoes_in[i] >= rules.least_echoes && !is_near_moving[i] ? 1 : 0;
  }
  return phantoms;
}

}  // namespace donex
