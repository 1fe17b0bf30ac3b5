// Peopleremover's definition (people_remover.h) read literally, as slowly as it is written.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include <Eigen/Eigenvalues>

#include "core/grid/grid_window.h"
#include "core/methods/people_remover.h"

namespace donex::oracle {

class PeopleRemover {
 public:
  PeopleRemover(Config config, const PeopleRemoverOptions& options) : options_(options), window_(config) {
    diagonal_ = static_cast<float>(std::sqrt(3.0) * config.voxel_size);
  }

  /// The labels of every scan.
  std::vector<std::vector<std::uint8_t>> label(const std::vector<Scan>& scans) {
    for (std::size_t k = 0; k < scans.size(); ++k) hit(scans[k], static_cast<int>(k));
    for (std::size_t k = 0; k < scans.size(); ++k) see(scans[k], static_cast<int>(k));
    dropSmallClusters();
    std::vector<std::vector<std::uint8_t>> labels;
    for (std::size_t k = 0; k < scans.size(); ++k) labels.push_back(labelsOf(scans[k], static_cast<int>(k)));
    return labels;
  }

  /// How far each line of sight may be followed.
  static std::vector<float> shadows(const std::vector<Eigen::Vector3f>& echoes,
                                    const std::vector<std::uint8_t>& is_echo, float diagonal, float fuzz);

 private:
  using Voxel = std::array<int, 3>;

  void enter(const Scan& scan) {
    window_.moveTo(scan.odom_from_base);
    window_.enter(scan, in_grid_);
    sees_.clear();
    for (std::size_t i = 0; i < scan.echoes.size(); ++i) {
      sees_.push_back(in_grid_.echoes[i].allFinite() && scan.echoes[i].norm() > diagonal_ ? 1 : 0);
    }
  }

  Voxel voxelAt(const Index3& in_window) const {
    const Index3 v = in_window + window_.minIndex();
    return {v.x(), v.y(), v.z()};
  }

  void hit(const Scan& scan, int k) {
    enter(scan);
    for (std::size_t i = 0; i < sees_.size(); ++i) {
      if (sees_[i] != 0 && in_grid_.inside[i] != 0) hits_[voxelAt(voxelOf(in_grid_.echoes[i]))].insert(k);
    }
  }

  /// False where the line ends.
  bool pass(const Index3& in_window, int k) {
    if (!window_.contains(in_window)) return false;
    const Voxel voxel = voxelAt(in_window);
    if (hits_.count(voxel) == 0) return true;
    for (const int scan : hits_.at(voxel)) {
      if (std::abs(scan - k) <= options_.diff) return false;
    }
    free_.insert(voxel);
    return true;
  }

  void see(const Scan& scan, int k) {
    enter(scan);
    const auto farthest = shadows(scan.echoes, sees_, diagonal_, static_cast<float>(options_.fuzz));
    for (std::size_t i = 0; i < sees_.size(); ++i) {
      if (sees_[i] == 0) continue;
      const float share = options_.point_shadows ? std::min(farthest[i] / scan.echoes[i].norm(), 1.0F) : 1.0F;
      if (share <= 0.0F) continue;
      const Eigen::Vector3f sight = in_grid_.echoes[i] - in_grid_.origin;
      const Eigen::Vector3f end = in_grid_.origin + share * sight;
      bool goes_on = true;
      for (const Index3& voxel : LineOfSight(in_grid_.origin, end)) {
        goes_on = pass(voxel, k);
        if (!goes_on) break;
      }
      if (goes_on) pass(voxelOf(end), k);
    }
  }

  static std::vector<Voxel> around(const Voxel& v, int reach) {
    std::vector<Voxel> voxels;
    for (int x = -reach; x <= reach; ++x) {
      for (int y = -reach; y <= reach; ++y) {
        for (int z = -reach; z <= reach; ++z) {
          if (x != 0 || y != 0 || z != 0) voxels.push_back({v[0] + x, v[1] + y, v[2] + z});
        }
      }
    }
    return voxels;
  }

  /// Spreads the lowest voxel of each cluster until nothing changes.
  void dropSmallClusters() {
    std::map<Voxel, Voxel> lowest;
    for (const Voxel& v : free_) lowest[v] = v;
    for (bool changed = true; changed;) {
      changed = false;
      for (auto& [v, low] : lowest) {
        for (const Voxel& n : around(v, 1)) {
          const auto found = lowest.find(n);
          if (found == lowest.end() || !(found->second < low)) continue;
          low = found->second;
          changed = true;
        }
      }
    }
    std::map<Voxel, int> sizes;
    for (const auto& [v, low] : lowest) ++sizes[low];
    for (const auto& [v, low] : lowest) {
      if (sizes[low] < options_.min_cluster) free_.erase(v);
    }
  }

  std::vector<std::uint8_t> labelsOf(const Scan& scan, int k) {
    enter(scan);
    std::vector<std::uint8_t> labels(sees_.size(), 0);
    for (std::size_t i = 0; i < sees_.size(); ++i) {
      if (sees_[i] == 0 || in_grid_.inside[i] == 0) continue;
      const Voxel voxel = voxelAt(voxelOf(in_grid_.echoes[i]));
      labels[i] = free_.count(voxel) != 0 || (options_.subvoxel && isNextToFreed(voxel, k)) ? 1 : 0;
    }
    return labels;
  }

  bool isNextToFreed(const Voxel& voxel, int k) const {
    for (const Voxel& n : around(voxel, 2)) {
      if (free_.count(n) != 0 && hits_.at(n).count(k) != 0) return true;
    }
    return false;
  }

  PeopleRemoverOptions options_;
  GridWindow window_;
  float diagonal_ = 0.0F;
  GridScan in_grid_;
  std::vector<std::uint8_t> sees_;
  std::map<Voxel, std::set<int>> hits_;
  std::set<Voxel> free_;
};

inline std::vector<float> PeopleRemover::shadows(const std::vector<Eigen::Vector3f>& echoes,
                                                 const std::vector<std::uint8_t>& is_echo, float diagonal, float fuzz) {
  std::vector<std::pair<double, std::size_t>> nearest_first;
  std::vector<Eigen::Vector3d> directions(echoes.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    if (is_echo[i] == 0) continue;
    nearest_first.emplace_back(echoes[i].cast<double>().norm(), i);
    directions[i] = echoes[i].cast<double>() / nearest_first.back().first;
  }
  std::sort(nearest_first.begin(), nearest_first.end());
  std::vector<float> most(echoes.size(), -1.0F);  // -1: in no shadow yet
  for (const auto& [range, i] : nearest_first) {
    if (most[i] >= 0.0F) continue;
    const double sine = double{diagonal} / (range - double{diagonal});
    const double angle = sine >= 1.0 || sine < 0.0 ? M_PI : 2.0 * std::asin(sine);
    std::vector<std::size_t> near;
    for (std::size_t j = 0; j < echoes.size(); ++j) {
      if (is_echo[j] != 0 && directions[j].dot(directions[i]) >= std::cos(angle)) near.push_back(j);
    }
    Eigen::Vector3d normal = -directions[i];
    if (near.size() >= 3) {
      Eigen::Vector3d mean = Eigen::Vector3d::Zero();
      for (const std::size_t j : near) mean += echoes[j].cast<double>();
      mean /= static_cast<double>(near.size());
      Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
      for (const std::size_t j : near) {
        const Eigen::Vector3d off = echoes[j].cast<double>() - mean;
        scatter += off * off.transpose();
      }
      normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(0);
      if (normal.dot(directions[i]) >= 0.0) normal = -normal;
    }
    const double plane = (echoes[i].cast<double>() + normal * double{diagonal + fuzz}).dot(normal);
    const auto meets = [&](std::size_t j) { return plane / directions[j].dot(normal); };
    most[i] = directions[i].dot(normal) == 0.0 ? 0.0F : static_cast<float>(std::max(meets(i), 0.0));
    for (const std::size_t j : near) {
      if (directions[j].dot(normal) == 0.0 || meets(j) > echoes[j].cast<double>().norm()) continue;
      const auto reach = static_cast<float>(std::max(meets(j), 0.0));
      most[j] = most[j] < 0.0F ? reach : std::min(most[j], reach);
    }
  }
  for (float& value : most) value = std::max(value, 0.0F);
  return most;
}

}  // namespace donex::oracle
