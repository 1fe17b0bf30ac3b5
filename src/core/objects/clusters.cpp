#include "core/objects/clusters.h"

#include <algorithm>
#include <cmath>

#include "core/grid/line_of_sight.h"

namespace donex {

Clusters::Clusters(double reach, const Options& options)
    : options_(options),
      width_(widthOf(reach, options.cell)),
      layers_(static_cast<int>(std::ceil(options.height / options.cell)) + 1),
      column_at_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(width_), kNone) {}

int Clusters::widthOf(double reach, double cell) { return 2 * static_cast<int>(std::ceil(reach / cell)) + 1; }

int& Clusters::makeCell(int x, int y, int z) {
  int& column = column_at_[columnOf(x, y)];
  if (column == kNone) {
    column = static_cast<int>(cell_in_column_.size()) / layers_;
    cell_in_column_.resize(cell_in_column_.size() + static_cast<std::size_t>(layers_), kNone);
  }
  return cell_in_column_[placeOf(column, z)];
}

void Clusters::connect(const Eigen::Vector3f& sensor, const std::vector<Eigen::Vector3f>& echoes,
                       const std::vector<float>& heights, const std::vector<ClusterRole>& roles) {
  fill(sensor, echoes, heights, roles);
  attachLowEchoes();
  for (int cell = 0; cell < static_cast<int>(cells_.size()); ++cell) join(cell);
  number();
  for (const Cell& cell : cells_) column_at_[columnOf(cell.x, cell.y)] = kNone;
}

void Clusters::fill(const Eigen::Vector3f& sensor, const std::vector<Eigen::Vector3f>& echoes,
                    const std::vector<float>& heights, const std::vector<ClusterRole>& roles) {
  const auto per_cell = static_cast<float>(1.0 / options_.cell);
  const auto highest = static_cast<float>(options_.height);
  cells_.clear();
  cell_in_column_.clear();
  low_echoes_.clear();
  of_.assign(echoes.size(), kNone);
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const bool takes_part = roles[i] == ClusterRole::kConnects || roles[i] == ClusterRole::kFollows;
    const bool in_height = takes_part && heights[i] >= 0.0F && heights[i] <= highest;
    if (!in_height) continue;
    const int x = floorToInt((echoes[i].x() - sensor.x()) * per_cell) + width_ / 2;
    const int y = floorToInt((echoes[i].y() - sensor.y()) * per_cell) + width_ / 2;
    const int z = static_cast<int>(heights[i] * per_cell);
    if (x < 0 || x >= width_ || y < 0 || y >= width_) continue;
    if (roles[i] == ClusterRole::kFollows) {
      low_echoes_.push_back({static_cast<int>(i), x, y});
      continue;
    }
    int& cell = makeCell(x, y, z);
    if (cell == kNone) {
      cell = static_cast<int>(cells_.size());
      cells_.push_back({x, y, z, cell});
    }
    of_[i] = cell;
  }
}

void Clusters::attachLowEchoes() {
  for (const auto& [echo, x, y] : low_echoes_) {
    for (int z = 0; z <= std::min(1, layers_ - 1) && of_[static_cast<std::size_t>(echo)] == kNone; ++z) {
      of_[static_cast<std::size_t>(echo)] = cellAt(x, y, z);
    }
  }
}

int Clusters::rootOf(int cell) {
  while (cells_[static_cast<std::size_t>(cell)].parent != cell) {
    int& parent = cells_[static_cast<std::size_t>(cell)].parent;
    parent = cells_[static_cast<std::size_t>(parent)].parent;
    cell = parent;
  }
  return cell;
}

void Clusters::join(int cell) {
  const Cell here = cells_[static_cast<std::size_t>(cell)];
  const double cells_away = std::hypot(here.x - width_ / 2, here.y - width_ / 2);
  const int across = std::max(1, static_cast<int>(std::ceil(cells_away * options_.across_angle)));
  const int up = std::max(1, static_cast<int>(std::ceil(cells_away * options_.up_angle)));
  const int last_z = std::min(here.z + up, layers_ - 1);
  const int first_x = std::max(here.x - across, 0), last_x = std::min(here.x + across, width_ - 1);
  const int first_y = std::max(here.y - across, 0), last_y = std::min(here.y + across, width_ - 1);
  const int root = rootOf(cell);
  // The half of the neighbourhood behind this cell finds it from there.
  for (int y = first_y; y <= last_y; ++y) {
    for (int x = first_x; x <= last_x; ++x) {
      const int column = column_at_[columnOf(x, y)];
      if (column == kNone) continue;
      const int* cell_at = cell_in_column_.data() + static_cast<std::ptrdiff_t>(column) * layers_;
      for (int z = here.z; z <= last_z; ++z) {
        const bool joins = cell_at[z] != kNone && cells_[static_cast<std::size_t>(cell_at[z])].parent != root;
        if (joins) cells_[static_cast<std::size_t>(rootOf(cell_at[z]))].parent = root;
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
