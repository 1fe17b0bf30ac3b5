#include "core/sight/ring_apex.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace donex {
namespace {

// Unknowns: the apex, and where the axis leans, by its x and y.
constexpr int kUnknowns = 5;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Ring = std::vector<Eigen::Vector3d>;

/// One echo's part in the adjustment.
struct Row {
  double sine = 0.0;  // of its elevation over the cones' base
  Unknowns slope;     // of the sine by the unknowns
  double weight = 0.0;
};

class RingApex {
 public:
  RingApex(std::vector<Ring> rings, const RingApexOptions& options) : rings_(std::move(rings)), options_(options) {}

  std::optional<Eigen::Vector3d> find() {
    for (int round = 0; round < options_.rounds; ++round) {
      if (!adjust()) return std::nullopt;
    }
    return isDetermined() ? std::optional(apex_) : std::nullopt;
  }

 private:
  bool adjust() {
    normal_.setZero();
    gradient_.setZero();
    errors_ = weights_ = 0.0;
    std::vector<double> offsets;  // of all echoes, for the scale of the next round
    for (const Ring& ring : rings_) addRing(ring, offsets);
    if (offsets.empty()) return false;
    const auto middle = offsets.begin() + static_cast<std::ptrdiff_t>(offsets.size() / 2);
    std::nth_element(offsets.begin(), middle, offsets.end());
    scale_ = std::max(1.5 * *middle, options_.least_scale);
    const Eigen::LDLT<Normal> solver(normal_ + kDamping * Normal::Identity());
    const Unknowns step = solver.solve(-gradient_);
    if (!step.allFinite()) return false;
    apex_ += step.head<3>().cwiseMax(-options_.largest_step).cwiseMin(options_.largest_step);
    axis_ = (axis_ + Eigen::Vector3d(step[3], step[4], 0.0)).normalized();
    return axis_.allFinite();
  }

  /// Elevation is another unknown of every ring: its mean is taken out of the ring's rows.
  void addRing(const Ring& ring, std::vector<double>& offsets) {
    rows_.clear();
    for (const Eigen::Vector3d& echo : ring) addRow(echo);
    if (rows_.size() < options_.least_of_ring) return;
    const double middle = middleSine();
    double weight = 0.0, sine = 0.0;
    Unknowns slope = Unknowns::Zero();
    for (Row& row : rows_) {
      const double offset = (row.sine - middle) / scale_;
      offsets.push_back(std::abs(row.sine - middle));
      row.weight = 1.0 / (1.0 + offset * offset);
      weight += row.weight;
      sine += row.weight * row.sine;
      slope += row.weight * row.slope;
    }
    for (const Row& row : rows_) {
      const double error = row.sine - sine / weight;
      const Unknowns centered = row.slope - slope / weight;
      normal_ += row.weight * centered * centered.transpose();
      gradient_ += row.weight * error * centered;
      errors_ += row.weight * error * error;
      weights_ += row.weight;
    }
  }

  void addRow(const Eigen::Vector3d& echo) {
    const Eigen::Vector3d ray = echo - apex_;
    const double range = ray.norm();
    if (range < options_.nearest) return;
    const Eigen::Vector3d direction = ray / range;
    Row row;
    row.sine = direction.dot(axis_);
    row.slope.head<3>() = (direction * row.sine - axis_) / range;
    row.slope.tail<2>() = direction.head<2>();
    rows_.push_back(row);
  }

  double middleSine() {
    sines_.clear();
    for (const Row& row : rows_) sines_.push_back(row.sine);
    const auto middle = sines_.begin() + static_cast<std::ptrdiff_t>(sines_.size() / 2);
    std::nth_element(sines_.begin(), middle, sines_.end());
    return *middle;
  }

  bool isDetermined() const {
    const double error = std::sqrt(errors_ / weights_);
    if (!(error <= options_.largest_error)) return false;
    const double variance = std::pow(std::max(error, options_.least_scale), 2);
    // Of the apex, whatever the axis is.
    const Normal covariance = (normal_ + kDamping * Normal::Identity()).inverse() * variance;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance.topLeftCorner<3, 3>());
    return std::sqrt(axes.eigenvalues().maxCoeff()) <= options_.largest_deviation;
  }

  static constexpr double kDamping = 1e-9;  // what nothing determines stays where it is

  std::vector<Ring> rings_;
  RingApexOptions options_;
  Eigen::Vector3d apex_ = Eigen::Vector3d::Zero(), axis_ = Eigen::Vector3d::UnitZ();
  double scale_ = 1.0;  // of errors that count in full; in the first round all do
  Normal normal_;
  Unknowns gradient_;
  double errors_ = 0.0, weights_ = 0.0;
  std::vector<Row> rows_;
  std::vector<double> sines_;
};

}  // namespace

std::optional<Eigen::Vector3d> findRingApex(const std::vector<Eigen::Vector3f>& echoes,
                                            const std::vector<std::uint32_t>& rings, const RingApexOptions& options) {
  assert(echoes.size() == rings.size());
  const std::size_t stride = std::max<std::size_t>(1, echoes.size() / options.echoes);
  std::map<std::uint32_t, Ring> by_number;
  for (std::size_t i = 0; i < echoes.size(); i += stride) {
    const bool is_repeated = i > 0 && echoes[i] == echoes[i - 1];  // beams without an echo, at the sensor's own origin
    if (echoes[i].allFinite() && !is_repeated) by_number[rings[i]].push_back(echoes[i].cast<double>());
  }
  std::vector<Ring> usable;
  for (auto& [number, ring] : by_number) {
    if (ring.size() >= options.least_of_ring) usable.push_back(std::move(ring));
  }
  if (usable.size() < options.least_rings) return std::nullopt;
  return RingApex(std::move(usable), options).find();
}

}  // namespace donex
