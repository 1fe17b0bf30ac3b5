// What stands around the vehicle, as Gaussians in voxels of several sizes: what a scan is registered against.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/grid/voxel_key.h"

namespace donex {

/// A surface as far as one voxel knows it.
struct Surface {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();  ///< from the voxel's centre [m]
  Eigen::Vector3f normal =
      Eigen::Vector3f::Zero();  ///< of a plane: the direction that is determined; of a pole: its axis
  float variance = 0.0F;        ///< across the surface [m^2]
};

/// A surface and where it is.
struct SurfaceMatch {
  const Surface* surface = nullptr;                ///< null where nothing is known
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  ///< [m]
  bool is_pole = false;                            ///< two directions are determined, across the axis
};

/// Hash tables of voxels, one for each size. Memory is set aside at construction and never grows: what is far away is
/// forgotten first.
class GaussianMap {
 public:
  struct Options {
    /// Edges of the voxels [m], rising. The finest planar voxel is the most exact one; a sparse sensor fills only
    /// the coarse ones.
    std::array<double, 3> edges{0.5, 1.0, 2.0};
    /// Most voxels of the finest size, a power of two; each coarser size has half of the one before.
    std::size_t most_voxels = 1U << 17U;
    double reach = 100.0;          ///< voxels farther from the sensor are forgotten [m]
    double prune_distance = 10.0;  ///< the vehicle's way between two times of forgetting [m]
    float least_echoes = 6.0F;     ///< fewer span no plane that could be trusted
    /// Echoes after which a voxel's past counts half: the map follows what changes.
    float most_echoes = 200.0F;
    double least_spread = 0.12;    ///< of a plane's echoes along its second axis, of the edge (an even one has 0.29)
    double most_thickness = 0.06;  ///< of a surface, standard deviation [m] at the finest size
    double upright = 0.85;         ///< cosine to the vertical above which a line is a pole; rings of ground are none
  };

  GaussianMap() : GaussianMap(Options()) {}
  explicit GaussianMap(const Options& options);

  /// Adds an echo to the voxels around `point`.
  void add(const Eigen::Vector3d& point);

  /// The finest surface in whose voxel `point` lies.
  SurfaceMatch surfaceAt(const Eigen::Vector3d& point);

  /// Forgets what is out of reach of `center`, once the vehicle has moved on or a table is nearly full.
  void moveTo(const Eigen::Vector3d& center);

  void clear();
  bool empty() const { return levels_[0].used == 0; }
  std::size_t memoryBytes() const;

 private:
  enum class Shape : std::uint8_t { kUnknown, kNone, kPlane, kPole };

  struct Voxel {
    float count = 0.0F;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();                          // from the centre
    Eigen::Array<float, 6, 1> squares = Eigen::Array<float, 6, 1>::Zero();  // xx, yy, zz, xy, xz, yz
    Surface surface;
    float fitted_count = 0.0F;  // echoes when the surface was fitted
    Shape shape = Shape::kUnknown;
  };

  struct Level {
    double edge = 0.0;
    std::size_t used = 0;
    std::vector<VoxelKey> keys;
    std::vector<Voxel> voxels;
  };

  static std::size_t slotOf(const Level& level, VoxelKey key);
  Voxel* find(Level& level, VoxelKey key) const;
  void add(Level& level, const Eigen::Vector3d& point);
  void fit(const Level& level, Voxel& voxel) const;
  void forgetBeyond(Level& level, const Eigen::Vector3d& center, double reach);
  static void erase(Level& level, std::size_t slot);

  Options options_;
  std::array<Level, 3> levels_;
  Eigen::Vector3d pruned_at_ = Eigen::Vector3d::Zero();
};

}  // namespace donex
