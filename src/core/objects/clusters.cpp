#include "core/objects/clusters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/grid/line_of_sight.h"
#include "core/grid/selection.h"
#include "core/grid/simd.h"

namespace donex {
namespace {

/// A square of cells, seen from its middle.
struct CellsAround {
  Eigen::Vector3f sensor;  ///< [m]
  float per_cell;          ///< [1/m]
  int width;               ///< cells
  float height;            ///< [m]
};

/// Whether any of them has a role: often few do, close to one another.
bool hasAny(const ClusterRole* roles, std::size_t count) {
  static_assert(static_cast<int>(ClusterRole::kNone) == 0);
  int any = 0;
  for (std::size_t i = 0; i < count; ++i) any |= static_cast<int>(roles[i]);
  return any != 0;
}

/// The number of the column of cells each echo lies in, or kNone where it takes no part, and its layer there. Echoes
/// may be NaN.
DONEX_WIDE_LOOPS void placeSome(const CellsAround& around, const float* echoes, const float* heights, std::size_t count,
                                int* columns, int* layers) {
  static_assert(Clusters::kNone == -1);  // all bits
  const float per_cell = around.per_cell, sensor_x = around.sensor.x(), sensor_y = around.sensor.y();
  const int width = around.width, middle = width / 2;
  const auto beyond = static_cast<float>(width);
  for (std::size_t i = 0; i < count; ++i) {
    const int x = floorToInt(clampedTo(-beyond, beyond, (echoes[3 * i] - sensor_x) * per_cell)) + middle;
    const int y = floorToInt(clampedTo(-beyond, beyond, (echoes[3 * i + 1] - sensor_y) * per_cell)) + middle;
    const float height = clampedTo(-1.0F, around.height + 1.0F, heights[i]);
    const int in_height = static_cast<int>(height >= 0.0F) & static_cast<int>(height <= around.height);
    const int in_square =
        static_cast<int>(x >= 0) & static_cast<int>(x < width) & static_cast<int>(y >= 0) & static_cast<int>(y < width);
    columns[i] = (y * width + x) | ((in_height & in_square) - 1);
    layers[i] = static_cast<int>(height * per_cell);
  }
}

}  // namespace

Clusters::Clusters(double reach, const Options& options)
    : options_(options),
      per_cell_(static_cast<float>(1.0 / options.cell)),
      width_(widthOf(reach, options.cell)),
      layers_(static_cast<int>(std::ceil(options.height / options.cell)) + 1),
      column_at_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(width_), kNone) {}

int Clusters::widthOf(double reach, double cell) { return 2 * static_cast<int>(std::ceil(reach / cell)) + 1; }

int Clusters::makeColumn(int x_y) {
  const auto column = static_cast<int>(columns_.size());
  column_at_[static_cast<std::size_t>(x_y)] = column;
  columns_.push_back({x_y % width_, x_y / width_});
  cell_in_column_.resize(cell_in_column_.size() + static_cast<std::size_t>(layers_), kNone);
  return column;
}

inline int Clusters::makeCell(int x_y, int z) {
  int column = column_at_[static_cast<std::size_t>(x_y)];
  if (column == kNone) column = makeColumn(x_y);
  int& cell = cell_in_column_[static_cast<std::size_t>(column) * static_cast<std::size_t>(layers_) +
                              static_cast<std::size_t>(z)];
  if (cell == kNone) {
    cell = static_cast<int>(parents_.size());
    parents_.push_back(cell);
  }
  return cell;
}

/// The cell right above an echo near the ground, or kNone.
int Clusters::cellAbove(int x_y) const {
  const int column = column_at_[static_cast<std::size_t>(x_y)];
  if (column == kNone) return kNone;
  const int* cells = cellsOf(column);
  return cells[0] == kNone && layers_ > 1 ? cells[1] : cells[0];
}

void Clusters::connect(const Eigen::Vector3f& sensor, const std::vector<Eigen::Vector3f>& echoes,
                       const std::vector<float>& heights, const std::vector<ClusterRole>& roles, const Known& known,
                       double beams_apart, const Workers& workers) {
  constexpr std::size_t kJoinedTogether = 256;  // columns; far ones have more neighbours to look at
  up_angle_ = std::max(options_.up_angle, options_.up_beams * beams_apart);
  fill(sensor, echoes, heights, roles, echoes.size() - known.far);
  const auto join_some = [&](std::size_t first, std::size_t last) {
    for (std::size_t column = first; column < last; ++column) join(static_cast<int>(column));
  };
  is_shared_ = workers.threads() > 1;
  forEachStretch(workers, columns_.size(), join_some, kJoinedTogether);
  joinKnown(known, echoes.size());
  number(echoes.size());
  for (const Column& column : columns_) column_at_[columnOf(column.x, column.y)] = kNone;
}

/// Cells are numbered in the order of their first echoes.
void Clusters::fill(const Eigen::Vector3f& sensor, const std::vector<Eigen::Vector3f>& echoes,
                    const std::vector<float>& heights, const std::vector<ClusterRole>& roles, std::size_t count) {
  parents_.clear();
  columns_.clear();
  cell_in_column_.clear();
  members_.clear();
  for (std::size_t first = 0; first < count; first += kSelectionBlock) {
    const std::size_t last = std::min(first + kSelectionBlock, count);
    if (hasAny(&roles[first], last - first)) fillSome(sensor, echoes, heights, roles, first, last);
  }
}

void Clusters::fillSome(const Eigen::Vector3f& sensor, const std::vector<Eigen::Vector3f>& echoes,
                        const std::vector<float>& heights, const std::vector<ClusterRole>& roles, std::size_t begin,
                        std::size_t end) {
  const auto takes_part = [&](std::size_t i) {
    return roles[i] == ClusterRole::kConnects || roles[i] == ClusterRole::kFollows;
  };
  forEachSelection(begin, end, takes_part, [&](const std::uint32_t* chosen, std::size_t count) {
    if (count == 0) return;
    const std::size_t first = chosen[0], last = chosen[count - 1];
    std::array<int, kSelectionBlock> columns, layers;  // from the first one on
    placeSome({sensor, per_cell_, width_, static_cast<float>(options_.height)}, echoes[first].data(), &heights[first],
              last + 1 - first, columns.data(), layers.data());
    for (std::size_t k = 0; k < count; ++k) {
      __builtin_prefetch(&column_at_[static_cast<std::size_t>(std::max(columns[chosen[k] - first], 0))]);
    }
    const std::size_t before = members_.size();
    members_.resize(before + count);
    Member* member = members_.data() + before;
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint32_t echo = chosen[k];
      const int column = columns[echo - first];
      if (column == kNone) continue;
      const bool follows = roles[echo] == ClusterRole::kFollows;
      member->echo = echo;
      member->cluster = follows ? ~column : makeCell(column, layers[echo - first]);
      ++member;
    }
    members_.resize(static_cast<std::size_t>(member - members_.data()));
  });
}

int Clusters::rootOf(int cell) {
  for (int parent = parentOf(cell); parent != cell; parent = parentOf(cell)) {
    const int above = parentOf(parent);
    __atomic_store_n(&parents_[static_cast<std::size_t>(cell)], above, __ATOMIC_RELAXED);
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
    int& parent = parents_[static_cast<std::size_t>(b)];
    int still_root = b;
    if (!is_shared_) {
      parent = a;  // one thread need not wait for the memory of others
      return a;
    }
    if (__atomic_compare_exchange_n(&parent, &still_root, a, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) return a;
  }
}

void Clusters::join(int column) {
  const int* cells = cellsOf(column);
  for (int z = 0; z < layers_; ++z) {
    if (cells[z] == kNone) continue;
    const int first = z;
    while (z + 1 < layers_ && cells[z + 1] != kNone) ++z;
    joinRun(columns_[static_cast<std::size_t>(column)], cells, first, z);
  }
}

/// Cells right above one another touch at any range: a run of them is joined as one, and asks of its neighbours' runs
/// only where each begins.
void Clusters::joinRun(const Column& here, const int* cells, int first_z, int last_z) {
  const double cells_away = std::hypot(here.x - width_ / 2, here.y - width_ / 2);
  const int across = std::max(1, static_cast<int>(std::ceil(cells_away * options_.across_angle)));
  const int up = std::max(1, static_cast<int>(std::ceil(cells_away * up_angle_)));
  const int last_near = std::min(last_z + up, layers_ - 1);
  const int first_x = std::max(here.x - across, 0), last_x = std::min(here.x + across, width_ - 1);
  const int first_y = std::max(here.y - across, 0), last_y = std::min(here.y + across, width_ - 1);
  int root = rootOf(cells[first_z]);
  for (int z = first_z + 1; z <= last_z; ++z) root = unite(root, cells[z]);
  // The half of the neighbourhood below this run finds it from there.
  for (int y = first_y; y <= last_y; ++y) {
    for (int x = first_x; x <= last_x; ++x) {
      const int column = column_at_[columnOf(x, y)];
      if (column == kNone) continue;
      const int* cell_at = cellsOf(column);
      int below = kNone;
      for (int z = first_z; z <= last_near; ++z) {
        const bool joins = cell_at[z] != kNone && below == kNone && parentOf(cell_at[z]) != root;
        if (joins) root = unite(root, cell_at[z]);
        below = cell_at[z];
      }
    }
  }
}

void Clusters::joinKnown(const Known& known, std::size_t echoes) {
  cell_of_known_.clear();
  for (auto near = members_.rbegin(); near != members_.rend() && near->echo >= known.first; ++near) {
    const std::uint32_t number = known.numbers[near->echo - known.first];
    if (number == 0 || near->cluster < 0) continue;
    if (number >= cell_of_known_.size()) cell_of_known_.resize(number + 1, kNone);
    int& cell = cell_of_known_[number];
    if (cell == kNone) cell = near->cluster;
    if (parentOf(near->cluster) != cell) cell = unite(cell, near->cluster);
  }
  const std::size_t connecting = members_.size();
  members_.resize(connecting + known.far);
  Member* member = members_.data() + connecting;
  for (std::size_t echo = echoes - known.far; echo < echoes; ++echo) {
    const std::uint32_t number = known.numbers[echo - known.first];
    if (number >= cell_of_known_.size() || cell_of_known_[number] == kNone) continue;
    member->echo = static_cast<std::uint32_t>(echo);
    member->cluster = cell_of_known_[number];
    ++member;
  }
  members_.resize(static_cast<std::size_t>(member - members_.data()));
}

/// In the order of their first echoes: independent of how the cells were joined.
void Clusters::number(std::size_t echoes) {
  // No parent is behind its cell, so that all of them have met their roots already.
  for (int& parent : parents_) parent = parents_[static_cast<std::size_t>(parent)];
  number_of_root_.assign(parents_.size(), kNone);
  echoes_in_.clear();
  of_.assign(echoes, kNone);
  std::size_t stay = 0;
  // As members, all of these would be read again after each number that is written.
  Member* members = members_.data();
  const int* parents = parents_.data();
  int *numbers = number_of_root_.data(), *of = of_.data();
  for (std::size_t i = 0, count_of_members = members_.size(); i < count_of_members; ++i) {
    const std::uint32_t echo = members[i].echo;
    const int at = members[i].cluster, cell = at < 0 ? cellAbove(~at) : at;
    if (cell == kNone) continue;
    int number = numbers[parents[cell]];
    if (number == kNone) {
      number = numbers[parents[cell]] = count();
      echoes_in_.push_back(0);
    }
    ++echoes_in_[static_cast<std::size_t>(number)];
    of[echo] = number;
    members[stay].echo = echo;
    members[stay++].cluster = number;
  }
  members_.resize(stay);
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
  const double a_column = sizeof(Column) + (layers + 2.0 * kCellsAColumn) * sizeof(int);
  return sizeof(int) * (std::pow(widthOf(reach, options.cell), 2) + echoes) + columns * a_column +
         connected * sizeof(Member);
}

Clusters::Options clustersOf(const ObjectConfig& config, double finer) {
  Clusters::Options options;
  options.cell = finer * config.cell;
  options.height = config.height;
  return options;
}

std::size_t Clusters::memoryBytes() const {
  const std::size_t numbers = column_at_.capacity() + cell_in_column_.capacity() + parents_.capacity() +
                              of_.capacity() + cell_of_known_.capacity() + number_of_root_.capacity();
  return numbers * sizeof(int) + columns_.capacity() * sizeof(Column) + members_.capacity() * sizeof(Member) +
         echoes_in_.capacity() * sizeof(std::size_t);
}

}  // namespace donex
