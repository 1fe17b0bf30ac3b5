#include "core/evidence/own_body.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/grid/simd.h"

namespace donex {
namespace {

constexpr std::size_t kNearBlock = 256;  // echoes that are looked at together

Eigen::Array3f halfOf(const OwnBody::Options& options) {
  return Eigen::Array3d(options.reach, options.half_width, options.half_height).cast<float>();
}

Eigen::Vector3i sizeOf(const OwnBody::Options& options) {
  return (2.0F * halfOf(options) / static_cast<float>(options.cell)).ceil().cast<int>();
}

/// 1 where an echo lies nearer to its sensor than `farthest` [m]. The order of the sums is Eigen's.
DONEX_WIDE_LOOPS void findNear(const Eigen::Vector3f* echoes, std::size_t count, float farthest,
                               std::uint8_t* is_near) {
  const auto* xyz = reinterpret_cast<const float*>(echoes);
  for (std::size_t i = 0; i < count; ++i) {
    const float x = xyz[3 * i], y = xyz[3 * i + 1], z = xyz[3 * i + 2];
    is_near[i] = static_cast<std::uint8_t>(x * x + (y * y + z * z) < farthest * farthest);
  }
}

/// Calls visit(number) for the echoes from `first` to `last` (not included) that lie so near. Few do.
template <class Visit>
void forEachNear(const Scan& scan, std::size_t first, std::size_t last, float farthest, Visit&& visit) {
  std::array<std::uint8_t, kNearBlock> is_near;
  for (std::size_t begin = first; begin < last; begin += kNearBlock) {
    const std::size_t count = std::min(kNearBlock, last - begin);
    findNear(scan.echoes.data() + begin, count, farthest, is_near.data());
    for (std::size_t i = 0; i < count; ++i) {
      if (is_near[i] != 0) visit(begin + i);
    }
  }
}

}  // namespace

OwnBody::OwnBody(const SelfConfig& config, const Options& options)
    : config_(config),
      options_(options),
      half_(halfOf(options)),
      size_(sizeOf(options)),
      counts_(config.detection ? static_cast<std::size_t>(size_.prod()) : 0, 0),
      hit_(counts_.size(), 0) {}

bool OwnBody::isInBox(const Eigen::Vector3f& in_vehicle) const {
  const Eigen::Vector3d point = in_vehicle.cast<double>();
  return point.x() >= config_.x_min && point.x() < config_.x_max && point.y() >= config_.y_min &&
         point.y() < config_.y_max && point.z() >= config_.z_min && point.z() < config_.z_max;
}

int OwnBody::cellOf(const Eigen::Vector3f& in_vehicle) const {
  const Eigen::Array3f from_center = (in_vehicle - center_).array();
  const bool is_near = (from_center.abs() < half_).all();  // false for NaN
  if (!is_near) return kNone;
  const Eigen::Array3i cell = ((from_center + half_) / static_cast<float>(options_.cell)).cast<int>();
  return (cell.z() * size_.y() + cell.y()) * size_.x() + cell.x();
}

/// From a sensor that sits at `mounting`, no cell is farther away [m].
float OwnBody::farthestFrom(const Eigen::Vector3f& mounting) const {
  return half_.matrix().norm() + (mounting - center_).norm();
}

void OwnBody::leaveOut(const Scan& scan, std::size_t first, std::size_t last,
                       std::vector<std::uint8_t>& is_solid) const {
  if (!is_found_ && !hasBox()) return;
  const Eigen::Isometry3f base_from_sensor = scan.base_from_sensor.cast<float>();
  const auto leave_out = [&](std::size_t i) {
    const Eigen::Vector3f place = base_from_sensor * scan.echoes[i];
    const int cell = detects() ? cellOf(place) : kNone;
    const bool stays = cell != kNone && isBody(cell);
    if (stays || isInBox(place)) is_solid[i] = 0;
  };
  if (hasBox()) {
    for (std::size_t i = first; i < last; ++i) leave_out(i);
  } else {
    forEachNear(scan, first, last, farthestFrom(base_from_sensor.translation()), leave_out);
  }
}

void OwnBody::learn(TurnPart part, const Scan& scan, const std::vector<std::uint8_t>& is_echo,
                    const std::vector<float>& heights, float lowest) {
  if (!detects()) return;
  if (part != TurnPart::kContinuing) beginTurn(scan);
  if (!is_counting_) return;
  const Eigen::Isometry3f base_from_sensor = scan.base_from_sensor.cast<float>();
  const float farthest = farthestFrom(base_from_sensor.translation());
  forEachNear(scan, 0, scan.echoes.size(), farthest, [&](std::size_t i) {
    const bool may_count = is_echo[i] != 0 && heights[i] > lowest;
    const int cell = may_count ? cellOf(base_from_sensor * scan.echoes[i]) : kNone;
    if (cell != kNone) hit_[static_cast<std::size_t>(cell)] = 1;
  });
}

void OwnBody::beginTurn(const Scan& scan) {
  if (is_counting_) count();
  const Eigen::Vector3d place = scan.odom_from_base.translation();
  if (!has_place_) center_ = scan.base_from_sensor.translation().cast<float>();
  is_counting_ = !has_place_ || (place - last_place_).norm() >= options_.step;
  if (is_counting_) last_place_ = place;
  has_place_ = true;
}

/// Echoes scatter about a body's surface: what was hit before and lies beside what stays is its own, too. At the edge
/// of the cells a neighbour may be one of the other side.
bool OwnBody::isBody(int cell) const {
  const int least = leastOfBody(), row = size_.x(), layer = size_.x() * size_.y();
  const auto stays = [&](int other) {
    const bool exists = other >= 0 && other < static_cast<int>(counts_.size());
    return exists && counts_[static_cast<std::size_t>(other)] >= least;
  };
  if (stays(cell)) return true;
  const auto is_beside = [&](int offset) { return stays(cell - offset) || stays(cell + offset); };
  return counts_[static_cast<std::size_t>(cell)] > 0 && (is_beside(1) || is_beside(row) || is_beside(layer));
}

/// What was hit from every place so far may be the body: until there are enough places, that has to do.
int OwnBody::leastOfBody() const { return std::clamp(options_.gain * places_, options_.suspect, options_.body); }

void OwnBody::count() {
  ++places_;
  is_found_ = false;
  for (std::size_t cell = 0; cell < counts_.size(); ++cell) {
    const int count = counts_[cell] + (hit_[cell] != 0 ? options_.gain : -options_.loss);
    counts_[cell] = static_cast<std::uint8_t>(std::clamp(count, 0, options_.most));
    is_found_ = is_found_ || counts_[cell] >= leastOfBody();
  }
  std::fill(hit_.begin(), hit_.end(), std::uint8_t{0});
}

void OwnBody::reset() {
  std::fill(counts_.begin(), counts_.end(), std::uint8_t{0});
  std::fill(hit_.begin(), hit_.end(), std::uint8_t{0});
  has_place_ = is_counting_ = is_found_ = false;
  places_ = 0;
}

double OwnBody::bytesFor(const SelfConfig& config) {
  return config.detection ? 2.0 * static_cast<double>(sizeOf(Options()).prod()) : 0.0;
}

}  // namespace donex
