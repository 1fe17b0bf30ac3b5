// One scan as a mesh of triangles between neighbouring echoes: which surface lies in a direction?
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace donex {

/// The mesh of a spinning sensor's scan (Lee, Kim & Jo 2019, section 3: the previous scan as a range image and the
/// triangles of its pixels). Columns of azimuth hold their echoes by elevation, so no ring numbers are needed.
class ScanMesh {
 public:
  /// `largest_gap`: echoes farther apart in elevation are no neighbours [rad].
  explicit ScanMesh(double largest_gap) : largest_gap_(static_cast<float>(largest_gap)) {}

  /// Echoes in the sensor's frame [m]; non-finite ones are left out.
  void build(const std::vector<Eigen::Vector3f>& echoes);

  /// What the mesh has in a direction.
  struct Surface {
    bool is_edge = false;    ///< the triangle joins two surfaces at different depths: there is no surface between them
    float range = 0.0F;      ///< where the direction meets the triangle [m]; of an edge, its nearest corner
    float far_range = 0.0F;  ///< of an edge, its farthest corner [m]
    float cosine = 1.0F;     ///< of the angle between the direction and the triangle's normal
  };

  /// Nothing where the direction has no four echoes around it.
  std::optional<Surface> at(const Eigen::Vector3f& direction) const;

  std::size_t memoryBytes() const;

 private:
  struct Corner {
    float elevation, azimuth;
    Eigen::Vector3f point;
  };
  struct Side {
    const Corner* below;
    const Corner* above;
  };

  std::optional<Side> bracket(int column, float elevation) const;
  /// The nearest column, from `column` on by `step`, with echoes below and above.
  std::optional<Side> search(int column, int step, float elevation) const;

  float largest_gap_;
  std::vector<std::size_t> first_;  ///< columns + 1: where each column's corners start
  std::vector<Corner> corners_;     ///< by column, then elevation
  std::vector<int> column_of_;
};

}  // namespace donex
