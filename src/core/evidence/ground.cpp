#include "core/evidence/ground.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "core/grid/line_of_sight.h"
#include "core/grid/simd.h"
#include "core/grid/storage.h"
#include "core/pi.h"

namespace donex {
namespace {

constexpr int kReach = 2;      // cells over which the ground is continued; a bit per neighbour, see Nearer::mask
constexpr int kBearings = 64;  // sectors of equal azimuth, a bit each
constexpr int kNearCells = 6;  // around the sensor, where sectors are narrower than cells
constexpr std::uint64_t kAllSectors = ~std::uint64_t{0};

/// The number of every echo's cell, or -1 outside the map.
DONEX_WIDE_LOOPS void findCells(const Eigen::Vector3f& sensor, float cell, int width, const Eigen::Vector3f* echoes,
                                std::size_t count, int* cells) {
  const float sensor_x = sensor.x(), sensor_y = sensor.y();
  const auto* xyz = reinterpret_cast<const float*>(echoes);
  const int middle = width / 2;
  const auto low = static_cast<float>(-middle), high = static_cast<float>(middle + 1);
  for (std::size_t i = 0; i < count; ++i) {
    const float across = (xyz[3 * i] - sensor_x) / cell + 0.5F, along = (xyz[3 * i + 1] - sensor_y) / cell + 0.5F;
    const int inside = static_cast<int>(across >= low) & static_cast<int>(across < high) &
                       static_cast<int>(along >= low) & static_cast<int>(along < high);
    const int x = floorToInt(clampedTo(low, high, across)) + middle;
    const int y = floorToInt(clampedTo(low, high, along)) + middle;
    cells[i] = (y * width + x) | (inside - 1);
  }
}

}  // namespace

int Ground::widthOf(double reach, float cell) {
  return 2 * static_cast<int>(std::ceil(reach / static_cast<double>(cell))) + 1;
}

Ground::Ground(double reach, const GroundOptions& options) : options_(options), width_(widthOf(reach, options.cell)) {
  const auto cells = static_cast<std::size_t>(width_) * static_cast<std::size_t>(width_);
  lowest_.resize(cells);
  before_.resize(cells, kNone);
  ground_.resize(cells, kNone);
  unseen_.resize(cells, 0.0F);
  outwards_.reserve(cells);
  sector_of_.reserve(cells);
  for (int y = -kReach; y <= kReach; ++y) {
    for (int x = -kReach; x <= kReach; ++x) {
      around_.push_back({x, y, y * width_ + x, options_.cell * std::sqrt(static_cast<float>(x * x + y * y)), 0.0F});
    }
  }
  for (int y = -(width_ / 2); y <= width_ / 2; ++y) {
    for (int x = -(width_ / 2); x <= width_ / 2; ++x) {
      sector_of_.push_back(sectorOf(x, y));
      outwards_.push_back({static_cast<std::int16_t>(x), static_cast<std::int16_t>(y),
                           findNearer(neighboursNearerTo(x, y)), sector_of_.back()});
    }
  }
  std::stable_sort(outwards_.begin(), outwards_.end(),
                   [](const Cell& a, const Cell& b) { return a.squaredDistance() < b.squaredDistance(); });
}

std::uint32_t Ground::neighboursNearerTo(int x, int y) const {
  static_assert((2 * kReach + 1) * (2 * kReach + 1) <= 32);
  std::uint32_t nearer = 0;
  for (std::size_t i = 0; i < around_.size(); ++i) {
    const int nx = x + around_[i].x, ny = y + around_[i].y;
    const bool in_map = std::max(std::abs(nx), std::abs(ny)) <= width_ / 2;
    if (in_map && nx * nx + ny * ny < x * x + y * y) nearer |= std::uint32_t{1} << i;
  }
  return nearer;
}

Ground::Nearer Ground::nearerOf(std::uint32_t mask) const {
  Nearer nearer{mask, {}, {}, {}, {}};
  nearer.away.fill(kNone);
  std::size_t count = 0;
  for (std::uint32_t left = mask; left != 0; left &= left - 1) nearer.number[count++] = __builtin_ctz(left);
  std::fill(nearer.number.begin() + static_cast<std::ptrdiff_t>(count), nearer.number.end(), nearer.number.front());
  for (std::size_t k = 0; k < kMostNearer; ++k) {
    const Neighbour& by = around_[static_cast<std::size_t>(nearer.number[k])];
    nearer.offset[k] = mask == 0 ? 0 : by.offset;
    if (k < count) nearer.away[k] = by.away;
  }
  return nearer;
}

/// Its place in nearer_; few differ.
std::uint16_t Ground::findNearer(std::uint32_t mask) {
  const auto known =
      std::find_if(nearer_.begin(), nearer_.end(), [&](const Nearer& nearer) { return nearer.mask == mask; });
  const auto place = static_cast<std::uint16_t>(known - nearer_.begin());
  if (known == nearer_.end()) nearer_.push_back(nearerOf(mask));
  return place;
}

Eigen::Vector2f Ground::offsetOf(const Cell& cell) const { return options_.cell * Eigen::Vector2f(cell.x, cell.y); }

void Ground::estimate(TurnPart part, const Eigen::Vector3d& origin, const Eigen::Vector3f& sensor,
                      const std::vector<Eigen::Vector3f>& echoes, const std::vector<std::uint8_t>& is_echo) {
  if (part == TurnPart::kContinuing) {
    shift_ = (origin - origin_).cast<float>();
  } else {
    beginMap(part, origin, sensor);
  }
  collect(echoes, is_echo);
  const Sectors sectors = is_known_ ? sectorsHit() : kAllSectors;
  float radius = options_.start_radius, best = radius, least = kNone;
  for (int trial = 0; trial < options_.start_trials && least > options_.most_beneath; ++trial) {
    radius = options_.start_radius * static_cast<float>(1 << trial);
    if (!continueFrom(radius, sectors)) return;
    const float beneath = shareBeneath();
    if (beneath < least) least = beneath, best = radius;
  }
  if (radius != best) continueFrom(best, sectors);
  is_known_ = true;
}

/// From what lies within a radius around the sensor; false where nothing does.
bool Ground::continueFrom(float radius, Sectors sectors) {
  if (!findStart(radius)) return false;
  climbAround();
  continueOutwards(sectors);
  return true;
}

/// Cells with an echo clearly beneath the ground, as a share of those on it.
float Ground::shareBeneath() const {
  int on = 1, beneath = 0;
  for (std::size_t i = 0; i < ground_.size(); ++i) {
    const float height = lowestIn(i) - ground_[i];
    on += static_cast<int>(std::abs(height) < options_.on);
    beneath += static_cast<int>(height < -options_.beneath);
  }
  return static_cast<float>(beneath) / static_cast<float>(on);
}

/// After a turn in parts the map moves by whole cells, so that what is known of a cell stays that cell's.
void Ground::beginMap(TurnPart part, const Eigen::Vector3d& origin, const Eigen::Vector3f& sensor) {
  shift_.setZero();
  if (part == TurnPart::kFirst) {
    const Eigen::Vector3d moved = origin - origin_ + (sensor - sensor_).cast<double>();
    const Eigen::Array2d cells = (moved.head<2>().array() / static_cast<double>(options_.cell)).round();
    const Eigen::Array2d beside = moved.head<2>().array() - static_cast<double>(options_.cell) * cells;
    moveMap(static_cast<int>(cells.x()), static_cast<int>(cells.y()), static_cast<float>(origin_.z() - origin.z()));
    sensor_ = sensor;
    sensor_.head<2>() -= beside.matrix().cast<float>();
  } else {
    std::fill(before_.begin(), before_.end(), kNone);
    std::fill(ground_.begin(), ground_.end(), kNone);
    is_known_ = false;
    sensor_ = sensor;
  }
  origin_ = origin;
  std::fill(lowest_.begin(), lowest_.end(), kNone);
}

/// The map's centre moves by so many cells, and everything in it up by `up` [m].
void Ground::moveMap(int x, int y, float up) {
  before_.swap(lowest_);
  moveMap(before_, x, y, up);
  moveMap(ground_, x, y, up);
  moveMap(unseen_, x, y, 0.0F);
}

/// What comes into the map has the values of its rim.
void Ground::moveMap(std::vector<float>& map, int x, int y, float up) {
  moved_.resize(map.size());
  const auto inside = [&](int i) { return std::clamp(i, 0, width_ - 1); };
  const int first = std::clamp(-x, 0, width_), last = std::clamp(width_ - x, first, width_);  // have a place in the old
  for (int to_y = 0; to_y < width_; ++to_y) {
    const float* from = map.data() + static_cast<std::ptrdiff_t>(inside(to_y + y)) * width_;
    float* to = moved_.data() + static_cast<std::ptrdiff_t>(to_y) * width_;
    std::fill(to, to + first, from[0] + up);
    for (int to_x = first; to_x < last; ++to_x) to[to_x] = from[to_x + x] + up;
    std::fill(to + last, to + width_, from[width_ - 1] + up);
  }
  map.swap(moved_);
}

void Ground::collect(const std::vector<Eigen::Vector3f>& echoes, const std::vector<std::uint8_t>& is_echo) {
  resizeTo(cell_of_, echoes.size());
  findCells(sensor_ - shift_, options_.cell, width_, echoes.data(), echoes.size(), cell_of_.data());
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    if (is_echo[i] == 0 || cell_of_[i] < 0) continue;
    float& lowest = lowest_[static_cast<std::size_t>(cell_of_[i])];
    const float height = echoes[i].z() + shift_.z();
    if (height < lowest) lowest = height;  // seldom: what is not written need not be waited for
  }
}

/// Sectors that hold an echo of the present cloud, and those beside.
Ground::Sectors Ground::sectorsHit() const {
  std::array<std::uint8_t, kInAll + 1> has_echo{};
  for (const int cell : cell_of_) {
    if (cell >= 0) has_echo[sector_of_[static_cast<std::size_t>(cell)]] = 1;
  }
  Sectors hit = 0;
  for (std::size_t sector = 0; sector < kBearings; ++sector) hit |= Sectors{has_echo[sector]} << sector;
  return hit | hit << 1 | hit >> 1 | hit << (kBearings - 1) | hit >> (kBearings - 1);
}

Ground::Sector Ground::sectorOf(int x, int y) {
  if (x * x + y * y <= kNearCells * kNearCells) return kInAll;
  const float turn = std::atan2(static_cast<float>(y), static_cast<float>(x)) / (2.0F * kPiF) + 0.5F;
  return static_cast<Sector>(std::min(static_cast<int>(turn * kBearings), kBearings - 1));
}

inline Ground::Continuation Ground::continueTo(const Cell& cell) const {
  const std::size_t here = indexOf(cell.x, cell.y);
  const Nearer& nearer = nearer_[cell.nearer];
  const float *unseen_here = unseen_.data() + here, *ground_here = ground_.data() + here;
  float sum = 0.0F, weights = 0.0F, unseen = kNone;
  for (std::size_t k = 0; k < kMostNearer; ++k) {
    const float since_seen = unseen_here[nearer.offset[k]] + nearer.away[k];
    const float weight = 1.0F / (since_seen * since_seen);
    sum += weight * (ground_here[nearer.offset[k]] - nearer.climb[k]);
    weights += weight;
    unseen = std::min(unseen, since_seen);
  }
  if (weights > 0.0F) return {sum / weights, unseen};
  return {startAt(offsetOf(cell)), options_.start_uncertainty};
}

/// Cells of other sectors keep the ground that they have.
DONEX_WIDE_LOOPS void Ground::continueOutwards(Sectors sectors) {
  if (sectors == 0) return;
  std::array<bool, kInAll + 1> is_asked{};
  is_asked[kInAll] = true;
  for (std::size_t sector = 0; sector < kBearings; ++sector) is_asked[sector] = (sectors >> sector & 1U) != 0;
  for (const Cell& cell : outwards_) {
    if (!is_asked[cell.sector]) continue;
    const std::size_t i = indexOf(cell.x, cell.y);
    const Continuation expected = continueTo(cell);
    const float down = std::min(options_.roughness + options_.fall * expected.unseen, options_.largest_step);
    const float rise = std::min(options_.kerb + options_.rise * expected.unseen, options_.largest_step);
    const float lowest = lowestIn(i);
    const float step = lowest - expected.height;
    const bool continues = step > -down && step < rise;
    ground_[i] = continues ? lowest : expected.height;
    unseen_[i] = continues ? 0.0F : expected.unseen;
  }
}

bool Ground::findStart(float radius) {
  near_.clear();
  const auto cells = static_cast<int>(radius / options_.cell);
  for (const Cell& cell : outwards_) {
    const bool enough = near_.size() >= options_.start_cells && cell.squaredDistance() > cells * cells;
    if (enough) break;
    const std::size_t i = indexOf(cell.x, cell.y);
    const float lowest = lowestIn(i);
    const Eigen::Vector2f offset = offsetOf(cell);
    if (lowest != kNone) near_.emplace_back(offset.x(), offset.y(), lowest);
  }
  if (near_.empty()) return false;
  // A third from below: passes by stray echoes beneath the ground, and by parked cars on both sides.
  const auto third = near_.begin() + static_cast<std::ptrdiff_t>(near_.size() / 3);
  std::nth_element(near_.begin(), third, near_.end(), [](const auto& a, const auto& b) { return a.z() < b.z(); });
  start_ = Eigen::Vector3f(0.0F, 0.0F, third->z());
  // On a slope that is a height among many: a plane through what lies near it, then nearer, follows.
  for (const float reach : options_.start_reach) start_ = fitStart(reach);
  return true;
}

Eigen::Vector3f Ground::fitStart(float reach) const {
  // Least squares, drawn to level ground and to the height so far where little speaks for a plane.
  Eigen::Matrix3d normal = Eigen::Vector3d(options_.levelling, options_.levelling, 1e-6).asDiagonal();
  Eigen::Vector3d right = 1e-6 * start_.cast<double>();
  for (const Eigen::Vector3f& cell : near_) {
    if (std::abs(cell.z() - startAt(cell.head<2>())) > reach) continue;
    const Eigen::Vector3d row(cell.x(), cell.y(), 1.0);
    normal += row * row.transpose();
    right += row * cell.z();
  }
  return normal.ldlt().solve(right).cast<float>();
}

/// The slope around the sensor goes on.
void Ground::climbAround() {
  for (Neighbour& by : around_) {
    by.climb = options_.cell * (start_.x() * static_cast<float>(by.x) + start_.y() * static_cast<float>(by.y));
  }
  for (Nearer& nearer : nearer_) {
    for (std::size_t k = 0; k < kMostNearer; ++k) {
      nearer.climb[k] = around_[static_cast<std::size_t>(nearer.number[k])].climb;
    }
  }
}

float Ground::heightOf(const Eigen::Vector3f& point) const {
  int cell = -1;
  findCells(sensor_ - shift_, options_.cell, width_, &point, 1, &cell);
  return heightIn(cell, point.z());
}

void Ground::heightsOf(const std::vector<Eigen::Vector3f>& echoes, std::size_t first, std::size_t last,
                       std::vector<float>& heights) const {
  for (std::size_t i = first; i < last; ++i) heights[i] = heightIn(cell_of_[i], echoes[i].z());
}

double Ground::bytesFor(double reach, double echoes, const GroundOptions& options) {
  const double cells = std::pow(widthOf(reach, options.cell), 2);
  return cells * (sizeof(Cell) + sizeof(Sector) + 5 * sizeof(float)) + roomFor(echoes * sizeof(int));
}

std::size_t Ground::memoryBytes() const {
  return outwards_.capacity() * sizeof(Cell) + sector_of_.capacity() * sizeof(Sector) +
         around_.capacity() * sizeof(Neighbour) + nearer_.capacity() * sizeof(Nearer) +
         cell_of_.capacity() * sizeof(int) +
         (lowest_.capacity() + before_.capacity() + ground_.capacity() + unseen_.capacity() + moved_.capacity()) *
             sizeof(float) +
         near_.capacity() * sizeof(Eigen::Vector3f);
}

}  // namespace donex
