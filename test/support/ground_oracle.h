// The local ground as ground.h words it: what a cell's ground is follows from that of the cells nearer to the sensor.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include <Eigen/QR>

namespace donex::oracle {

class GroundMap {
 public:
  GroundMap(double reach, const Eigen::Vector3f& sensor, const std::vector<Eigen::Vector3f>& echoes,
            const std::vector<std::uint8_t>& is_echo)
      : half_(static_cast<int>(std::ceil(reach / kCell))), sensor_(sensor) {
    for (std::size_t i = 0; i < echoes.size(); ++i) {
      const auto cell = cellOf(echoes[i]);
      if (is_echo[i] == 0 || !cell) continue;
      const auto known = lowest_.find(*cell);
      const double z = echoes[i].z();
      lowest_[*cell] = known == lowest_.end() ? z : std::min(z, known->second);
    }
    if (!lowest_.empty()) findGround();
  }

  /// Height above the ground [m]; infinite outside the map, or where no ground was found at all.
  double heightOf(const Eigen::Vector3f& point) {
    const auto cell = cellOf(point);
    if (!cell || lowest_.empty()) return std::numeric_limits<double>::infinity();
    return static_cast<double>(point.z()) - groundOf(*cell).height;
  }

  /// Cells that took their own lowest echo, and cells with an echo above the ground.
  int continued() const { return continued_; }
  int interrupted() const { return interrupted_; }

 private:
  static constexpr double kCell = 0.8;         ///< [m]
  static constexpr int kReach = 2;             ///< cells
  static constexpr double kLargestStep = 0.4;  ///< [m]

  using Cell = std::array<int, 2>;  // y, x from the sensor's
  struct Known {
    double height;
    double unseen;  ///< how far away the ground was last seen [m]
  };

  static int squaredDistance(const Cell& cell) { return cell[0] * cell[0] + cell[1] * cell[1]; }

  std::optional<Cell> cellOf(const Eigen::Vector3f& point) const {
    const Eigen::Array2f away = ((point - sensor_).head<2>().array() / static_cast<float>(kCell) + 0.5F).floor();
    if (!(away.abs() <= static_cast<float>(half_)).all()) return std::nullopt;
    return Cell{static_cast<int>(away.y()), static_cast<int>(away.x())};
  }

  /// The first of three circles around the sensor whose ground has hardly anything beneath it, or the one with least.
  void findGround() {
    int best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (const int cells : {8, 17, 35}) {  // 7, 14 and 28 m
      if (least <= 0.1) break;
      findStart(cells);
      const double beneath = shareBeneath();
      if (beneath < least) best = cells;
      least = std::min(least, beneath);
    }
    findStart(best);
  }

  double shareBeneath() {
    int on = 1, beneath = 0;
    for (const auto& [cell, lowest] : lowest_) {
      const double height = lowest - groundOf(cell).height;
      on += std::abs(height) < 0.1 ? 1 : 0;
      beneath += height < -0.3 ? 1 : 0;
    }
    return static_cast<double>(beneath) / on;
  }

  /// The plane of the ground around the sensor, in a circle of so many cells.
  void findStart(int cells) {
    ground_.clear();
    continued_ = interrupted_ = 0;
    std::vector<std::pair<int, Cell>> by_distance;
    for (const auto& known : lowest_) by_distance.emplace_back(squaredDistance(known.first), known.first);
    std::sort(by_distance.begin(), by_distance.end());
    std::vector<Eigen::Vector3d> near;
    for (const auto& [squared, cell] : by_distance) {
      const bool is_near = squared <= cells * cells || near.size() < 24;
      if (is_near) near.emplace_back(kCell * cell[1], kCell * cell[0], lowest_.at(cell));
    }
    std::vector<double> heights;
    for (const Eigen::Vector3d& point : near) heights.push_back(point.z());
    std::sort(heights.begin(), heights.end());
    start_ = {0.0, 0.0, heights[heights.size() / 3]};
    for (const double reach : {0.6, 0.3, 0.15}) start_ = fitPlane(near, reach);
  }

  double startAt(double x, double y) const { return start_.x() * x + start_.y() * y + start_.z(); }

  /// Through the points within `reach` of the plane so far; without any it stays level where it was.
  Eigen::Vector3d fitPlane(const std::vector<Eigen::Vector3d>& points, double reach) const {
    std::vector<Eigen::Vector4d> equations{
        {std::sqrt(50.0), 0.0, 0.0, 0.0}, {0.0, std::sqrt(50.0), 0.0, 0.0}, {0.0, 0.0, 1e-3, 1e-3 * start_.z()}};
    for (const Eigen::Vector3d& p : points) {
      if (std::abs(p.z() - startAt(p.x(), p.y())) <= reach) equations.emplace_back(p.x(), p.y(), 1.0, p.z());
    }
    Eigen::MatrixXd rows(static_cast<Eigen::Index>(equations.size()), 4);
    for (std::size_t i = 0; i < equations.size(); ++i) rows.row(static_cast<Eigen::Index>(i)) = equations[i];
    return rows.leftCols(3).colPivHouseholderQr().solve(rows.col(3));
  }

  /// The cell's lowest echo where it continues what nearer cells let expect, and that expectation elsewhere.
  const Known& groundOf(const Cell& cell) {
    const auto known = ground_.find(cell);
    if (known != ground_.end()) return known->second;
    const Known expected = expectedAt(cell);
    const auto lowest = lowest_.find(cell);
    const double step = lowest == lowest_.end() ? kLargestStep : lowest->second - expected.height;
    const bool continues = step > -std::min(0.15 + 0.08 * expected.unseen, kLargestStep) &&
                           step < std::min(0.14 + 0.03 * expected.unseen, kLargestStep);
    if (lowest != lowest_.end()) ++(continues ? continued_ : interrupted_);
    return ground_[cell] = continues ? Known{lowest->second, 0.0} : expected;
  }

  /// A mean of the nearer neighbours, each continued along the start's slope; the sooner seen the heavier.
  Known expectedAt(const Cell& cell) {
    double sum = 0.0, weights = 0.0, unseen = std::numeric_limits<double>::infinity();
    for (int y = -kReach; y <= kReach; ++y) {
      for (int x = -kReach; x <= kReach; ++x) {
        const Cell by{cell[0] + y, cell[1] + x};
        const bool in_map = std::abs(by[0]) <= half_ && std::abs(by[1]) <= half_;
        if (!in_map || squaredDistance(by) >= squaredDistance(cell)) continue;
        const Known ground = groundOf(by);
        const double since_seen = ground.unseen + kCell * std::hypot(x, y);
        const double weight = 1.0 / (since_seen * since_seen);
        sum += weight * (ground.height - kCell * (start_.x() * x + start_.y() * y));
        weights += weight;
        unseen = std::min(unseen, since_seen);
      }
    }
    if (weights > 0.0) return {sum / weights, unseen};
    return {startAt(kCell * cell[1], kCell * cell[0]), 4.0};
  }

  int half_;
  Eigen::Vector3f sensor_;
  std::map<Cell, double> lowest_;
  std::map<Cell, Known> ground_;
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero();  ///< slopes along x, y, and the height under the sensor [m]
  int continued_ = 0, interrupted_ = 0;
};

}  // namespace donex::oracle
