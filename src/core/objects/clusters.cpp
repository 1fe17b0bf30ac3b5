#include "core/objects/clusters.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/grid/line_of_sight.h"

namespace donex {

Clusters::Clusters(double reach, const Options& options)
    : options_(options),
      per_cell_(static_cast<float>(1.0 / options.cell)),
      width_(widthOf(reach, options.cell)),
      layers_(static_cast<int>(std::ceil(options.height / options.cell)) + 1),
      column_at_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(width_), kNone) {}

int Clusters::widthOf(double reach, double cell) { return 2 * static_cast<int>(std::ceil(reach / cell)) + 1; }

int& Clusters::makeCell(std::size_t x_y, int z) {
  int& column = column_at_[x_y];
  if (column == kNone) {
    column = static_cast<int>(cell_in_column_.size()) / layers_;
    cell_in_column_.resize(cell_in_column_.size() + static_cast<std::size_t>(layers_), kNone);
  }
  return cell_in_column_[placeOf(column, z)];
}

void Clusters::connect(const Eigen::Vector3f& sensor, const std::vector<Eigen::Vector3f>& echoes,
                       const std::vector<float>& heights, const std::vector<ClusterRole>& roles,
                       const Workers& workers) {
  constexpr std::size_t kCells = 512;  // far ones have more neighbours to look at
  findColumns(sensor, echoes, heights, roles, workers);
  fill(heights, roles);
  attachLowEchoes();
  const auto join_some = [&](std::size_t first, std::size_t last) {
    for (std::size_t cell = first; cell < last; ++cell) join(static_cast<int>(cell));
  };
  is_shared_ = workers.threads() > 1;
  forEachStretch(workers, cells_.size(), join_some, kCells);
  number();
  for (const Cell& cell : cells_) column_at_[columnOf(cell.x, cell.y)] = kNone;
}

/// Of all echoes that take part.
void Clusters::findColumns(const Eigen::Vector3f& sensor, const std::vector<Eigen::Vector3f>& echoes,
                           const std::vector<float>& heights, const std::vector<ClusterRole>& roles,
                           const Workers& workers) {
  const auto highest = static_cast<float>(options_.height);
  of_.resize(echoes.size());
  const auto column_of = [&](std::size_t i) {
    const bool takes_part = roles[i] == ClusterRole::kConnects || roles[i] == ClusterRole::kFollows;
    const bool in_height = takes_part && heights[i] >= 0.0F && heights[i] <= highest;
    if (!in_height) return int{kNone};
    const int x = floorToInt((echoes[i].x() - sensor.x()) * per_cell_) + width_ / 2;
    const int y = floorToInt((echoes[i].y() - sensor.y()) * per_cell_) + width_ / 2;
    const bool in_square = x >= 0 && x < width_ && y >= 0 && y < width_;
    return in_square ? static_cast<int>(columnOf(x, y)) : int{kNone};
  };
  forEachStretch(workers, echoes.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) of_[i] = column_of(i);
  });
}

/// Cells are numbered in the order of their first echoes.
void Clusters::fill(const std::vector<float>& heights, const std::vector<ClusterRole>& roles) {
  cells_.clear();
  cell_in_column_.clear();
  low_echoes_.clear();
  for (std::size_t i = 0; i < of_.size(); ++i) {
    const int column = of_[i];
    if (column == kNone) continue;
    if (roles[i] == ClusterRole::kFollows) {
      low_echoes_.push_back({static_cast<int>(i), column});
      of_[i] = kNone;
      continue;
    }
    const int z = static_cast<int>(heights[i] * per_cell_);
    int& cell = makeCell(static_cast<std::size_t>(column), z);
    if (cell == kNone) {
      cell = static_cast<int>(cells_.size());
      cells_.push_back({column % width_, column / width_, z, cell});
    }
    of_[i] = cell;
  }
}

void Clusters::attachLowEchoes() {
  for (const auto& [echo, column] : low_echoes_) {
    for (int z = 0; z <= std::min(1, layers_ - 1) && of_[static_cast<std::size_t>(echo)] == kNone; ++z) {
      of_[static_cast<std::size_t>(echo)] = cellAt(static_cast<std::size_t>(column), z);
    }
  }
}

int Clusters::rootOf(int cell) {
  for (int parent = parentOf(cell); parent != cell; parent = parentOf(cell)) {
    const int above = parentOf(parent);
    __atomic_store_n(&cells_[static_cast<std::size_t>(cell)].parent, above, __ATOMIC_RELAXED);
    cell = above;
  }
  return cell;
}

/// The root of both from now on. The larger root goes below the smaller one, so that no order makes a ring.
int Clusters::unite(int a, int b) {
  while (true) {
    a = rootOf(a);
    b = rootOf(b);
    if (a == b) return a;
    if (a > b) std::swap(a, b);
    int& parent = cells_[static_cast<std::size_t>(b)].parent;
    int still_root = b;
    if (!is_shared_) {
      parent = a;  // one thread need not wait for the memory of others
      return a;
    }
    if (__atomic_compare_exchange_n(&parent, &still_root, a, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) return a;
  }
}

void Clusters::join(int cell) {
  const Cell& here = cells_[static_cast<std::size_t>(cell)];
  const double cells_away = std::hypot(here.x - width_ / 2, here.y - width_ / 2);
  const int across = std::max(1, static_cast<int>(std::ceil(cells_away * options_.across_angle)));
  const int up = std::max(1, static_cast<int>(std::ceil(cells_away * options_.up_angle)));
  const int last_z = std::min(here.z + up, layers_ - 1);
  const int first_x = std::max(here.x - across, 0), last_x = std::min(here.x + across, width_ - 1);
  const int first_y = std::max(here.y - across, 0), last_y = std::min(here.y + across, width_ - 1);
  int root = rootOf(cell);
  // The half of the neighbourhood behind this cell finds it from there.
  for (int y = first_y; y <= last_y; ++y) {
    for (int x = first_x; x <= last_x; ++x) {
      const int column = column_at_[columnOf(x, y)];
      if (column == kNone) continue;
      const int* cell_at = cell_in_column_.data() + static_cast<std::ptrdiff_t>(column) * layers_;
      for (int z = here.z; z <= last_z; ++z) {
        const bool joins = cell_at[z] != kNone && parentOf(cell_at[z]) != root;
        if (joins) root = unite(root, cell_at[z]);
      }
    }
  }
}

void Clusters::number() {
  // Numbered in the order of their first echoes: independent of how the cells were joined.
  number_of_root_.assign(cells_.size(), kNone);
  echoes_in_.clear();
  for (int& of : of_) {
    if (of == kNone) continue;
    int& number = number_of_root_[static_cast<std::size_t>(rootOf(of))];
    if (number == kNone) {
      number = count();
      echoes_in_.push_back(0);
    }
    ++echoes_in_[static_cast<std::size_t>(number)];
    of = number;
  }
}

int Clusters::countWithin(std::size_t echoes) const {
  if (echoes == of_.size()) return count();
  int highest = kNone;
  for (std::size_t i = 0; i < echoes; ++i) highest = std::max(highest, of_[i]);
  return highest + 1;
}

double Clusters::bytesFor(double reach, const Options& options, double echoes, double connected) {
  constexpr double kEchoesACell = 6.0, kCellsAColumn = 3.0;
  const double columns = connected / kEchoesACell / kCellsAColumn, layers = options.height / options.cell + 1.0;
  const double a_cell = sizeof(Cell) + sizeof(int) + layers / kCellsAColumn * sizeof(int);
  return sizeof(int) * (std::pow(widthOf(reach, options.cell), 2) + echoes) + kCellsAColumn * columns * a_cell;
}

Clusters::Options clustersOf(const ObjectConfig& config, double finer) {
  Clusters::Options options;
  options.cell = finer * config.cell;
  options.height = config.height;
  return options;
}

std::size_t Clusters::memoryBytes() const {
  const std::size_t numbers =
      column_at_.capacity() + cell_in_column_.capacity() + of_.capacity() + number_of_root_.capacity();
  return numbers * sizeof(int) + cells_.capacity() * sizeof(Cell) + echoes_in_.capacity() * sizeof(std::size_t) +
         low_echoes_.capacity() * sizeof(low_echoes_[0]);
}

}  // namespace donex
