// Connected echoes (algorithm: "Clusters").
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/evidence/judged_scan.h"
#include "core/grid/workers.h"
#include "donex/config.h"

namespace donex {

/// Groups echoes whose cells touch. Cells are cubes over x, y and the height above ground; echoes a
/// beam apart touch at any range, since the reach grows with the distance from the sensor.
class Clusters {
 public:
  struct Options {
    double cell = 0.3;           ///< edge of a cell [m]
    double height = 4.5;         ///< echoes higher above ground belong to no cluster [m]
    double across_angle = 0.01;  ///< echoes within this angle touch, horizontally: more than a sensor's step [rad]
    double up_angle = 0.015;     ///< the same vertically, at least [rad]
    /// Of the angle between beams above one another: so much is touched vertically where that is more. With all of it
    /// crowns of trees are connected with what parks beneath.
    double up_beams = 0.7;
  };

  /// A square of `reach` [m] around the sensor.
  Clusters(double reach, const Options& options);

  /// Echoes that are connected anyway.
  struct Known {
    std::size_t first;                          ///< of the echoes that have a number; all behind it have one
    std::size_t far;                            ///< the last echoes: they connect nothing, but go with their number
    const std::vector<std::uint32_t>& numbers;  ///< what has the same one is one cluster; 0: nothing is known
  };

  /// `echoes` [m] in a frame whose z points up, `heights` above ground [m], one per echo. `beams_apart`: tangent of the
  /// angle between beams above one another, as far as it is known.
  void connect(const Eigen::Vector3f& sensor, const std::vector<Eigen::Vector3f>& echoes,
               const std::vector<float>& heights, const std::vector<ClusterRole>& roles, double beams_apart = 0.0,
               const Workers& workers = Workers::alone()) {
    connect(sensor, echoes, heights, roles, {echoes.size(), 0, {}}, beams_apart, workers);
  }
  void connect(const Eigen::Vector3f& sensor, const std::vector<Eigen::Vector3f>& echoes,
               const std::vector<float>& heights, const std::vector<ClusterRole>& roles, const Known& known,
               double beams_apart = 0.0, const Workers& workers = Workers::alone());

  static constexpr int kNone = -1;
  /// Cluster of an echo, 0 to count() - 1, or kNone.
  int of(std::size_t echo) const { return of_[echo]; }
  int count() const { return static_cast<int>(echoes_in_.size()); }
  /// Clusters with any of the first `echoes`: these come first.
  int countWithin(std::size_t echoes) const;
  /// An echo of a cluster.
  struct Member {
    std::uint32_t echo;
    int cluster;
  };
  /// Of all clusters, in the order of the echoes.
  const std::vector<Member>& members() const { return members_; }
  std::size_t echoesIn(int cluster) const { return echoes_in_[static_cast<std::size_t>(cluster)]; }

  std::size_t memoryBytes() const;
  /// What memoryBytes will be, for scans of so many echoes of which `connected` take part [bytes], about: scenes differ
  /// in how many cells echoes share.
  static double bytesFor(double reach, const Options& options, double echoes, double connected);

 private:
  /// Cells above one another.
  struct Column {
    int x, y;
  };

  std::size_t columnOf(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  /// The cells of a column by z: their numbers, or kNone.
  const int* cellsOf(int column) const {
    return cell_in_column_.data() + static_cast<std::ptrdiff_t>(column) * layers_;
  }
  static int widthOf(double reach, double cell);
  int makeColumn(int x_y);
  int makeCell(int x_y, int z);
  int cellAbove(int x_y) const;
  /// Others may join cells at the same time: what is read is old at worst, and a parent's parent serves as well.
  int parentOf(int cell) const { return __atomic_load_n(&parents_[static_cast<std::size_t>(cell)], __ATOMIC_RELAXED); }
  int rootOf(int cell);
  int unite(int a, int b);
  void fill(const Eigen::Vector3f& sensor, const std::vector<Eigen::Vector3f>& echoes,
            const std::vector<float>& heights, const std::vector<ClusterRole>& roles, std::size_t count);
  void fillSome(const Eigen::Vector3f& sensor, const std::vector<Eigen::Vector3f>& echoes,
                const std::vector<float>& heights, const std::vector<ClusterRole>& roles, std::size_t begin,
                std::size_t end);
  void join(int column);
  void joinRun(const Column& here, const int* cells, int first_z, int last_z);
  void joinKnown(const Known& known, std::size_t echoes);
  void number(std::size_t echoes);

  Options options_;
  float per_cell_;  ///< [1/m]
  int width_, layers_;
  double up_angle_ = 0.0;            ///< of this scan [rad]
  bool is_shared_ = false;           ///< several threads join cells
  std::vector<int> column_at_;       ///< by x, y: number of the column, or kNone
  std::vector<Column> columns_;      ///< dense, in the order of their first echoes
  std::vector<int> cell_in_column_;  ///< by column, z: number of the cell, or kNone
  std::vector<int> parents_;         ///< by cell: union-find
  std::vector<int> of_;              ///< by echo: its cluster
  std::vector<Member> members_;      ///< before they are numbered, `cluster` is the cell, or ~columnOf what is above
  std::vector<int> cell_of_known_;   ///< by what is known: one of its cells, or kNone
  std::vector<int> number_of_root_;
  std::vector<std::size_t> echoes_in_;  ///< by cluster
};

/// What a configuration says of clusters; their cells are `finer` times the configured edge.
Clusters::Options clustersOf(const ObjectConfig& config, double finer = 1.0);

}  // namespace donex
