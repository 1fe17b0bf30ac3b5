#include "simulation/ground_window.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "simulation/shape.h"

namespace donex::simulation {
namespace {

constexpr int kMoveCells = 16;         // the window follows in steps
constexpr float kStep = 0.2f;          // [m]
constexpr float kStepGrowth = 0.008f;  // of the distance: far away the rays themselves lie further apart
constexpr float kSteepest = 0.75f;     // no slope of the samples is steeper: a kerb's height over one cell
constexpr float kNearest = 0.3f;       // [m]

int cellOf(double coordinate) { return static_cast<int>(std::floor(coordinate / GroundWindow::kCell)); }

}  // namespace

GroundWindow::GroundWindow(const Ground& ground)
    : ground_(ground), heights_(static_cast<std::size_t>(kCells) * kCells), labels_(heights_.size()) {}

void GroundWindow::sampleBlock(int first_column, int first_row, int columns, int rows) {
  for (int row = first_row; row < first_row + rows; ++row) {
    for (int column = first_column; column < first_column + columns; ++column) {
      const GroundPoint point = ground_.at(kCell * Eigen::Vector2d(column, row));
      heights_[slot(column, row)] = static_cast<float>(point.height);
      labels_[slot(column, row)] = static_cast<std::uint8_t>(point.label);
    }
  }
}

void GroundWindow::moveTo(const Eigen::Vector2d& center) {
  const auto first_for = [](double coordinate) { return cellOf(coordinate / kMoveCells) * kMoveCells - kCells / 2; };
  const int column = first_for(center.x());
  const int row = first_for(center.y());
  const int right = column - first_column_;
  const int up = row - first_row_;
  const bool far = std::abs(right) >= kCells || std::abs(up) >= kCells;
  first_column_ = column;
  first_row_ = row;
  if (!filled_ || far) {
    sampleBlock(column, row, kCells, kCells);
    filled_ = true;
    return;
  }
  sampleBlock(right > 0 ? column + kCells - right : column, row, std::abs(right), kCells);
  sampleBlock(column, up > 0 ? row + kCells - up : row, kCells, std::abs(up));
}

float GroundWindow::heightAtCell(float u, float v) const {
  // Never negative inside the window: truncation is the floor.
  const int column = static_cast<int>(u);
  const int row = static_cast<int>(v);
  const int i = column + first_column_;
  const int j = row + first_row_;
  const float a = u - static_cast<float>(column);
  const float b = v - static_cast<float>(row);
  const float low = heights_[slot(i, j)] * (1.0f - a) + heights_[slot(i + 1, j)] * a;
  const float high = heights_[slot(i, j + 1)] * (1.0f - a) + heights_[slot(i + 1, j + 1)] * a;
  return low * (1.0f - b) + high * b;
}

float GroundWindow::height(double x, double y) const {
  return heightAtCell(static_cast<float>(x / kCell - first_column_), static_cast<float>(y / kCell - first_row_));
}

std::uint32_t GroundWindow::label(double x, double y) const {
  return labels_[slot(cellOf(x + 0.5 * kCell), cellOf(y + 0.5 * kCell))];
}

Eigen::Vector3f GroundWindow::normal(double x, double y) const {
  const auto run = static_cast<float>(2.0 * kCell);
  const float across = (height(x + kCell, y) - height(x - kCell, y)) / run;
  const float along = (height(x, y + kCell) - height(x, y - kCell)) / run;
  return Eigen::Vector3f(-across, -along, 1.0f).normalized();
}

/// `origin` and `direction` level in cells, upright in metres. The parameter, or kMiss.
float GroundWindow::enter(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float from) const {
  const auto above_ground = [&](float r) {
    const Eigen::Vector3f at = origin + r * direction;
    return at.z() - heightAtCell(at.x(), at.y());
  };
  /// Between a place above and a place below: two steps of false position.
  const auto crossing = [&](float r_above, float above, float r_below, float below) {
    const float guess = r_above + (r_below - r_above) * above / (above - below);
    const float there = above_ground(guess);
    if (there > 0.0f) return guess + (r_below - guess) * there / (there - below);
    return r_above + (guess - r_above) * above / (above - there);
  };
  const float fastest_approach = std::max(0.2f, kSteepest - direction.z());
  float before = 0.0f;
  float before_r = from;
  for (float r = from; r < static_cast<float>(kReach);) {
    const float above = above_ground(r);
    if (above <= 0.0f) return before > 0.0f ? crossing(before_r, before, r, above) : r;
    before_r = r;
    before = above;
    r += std::max(std::max(kStep, kStepGrowth * r), above / fastest_approach);
  }
  return kMiss;
}

void GroundWindow::meet(const RayFan& fan, std::vector<float>& parameters) const {
  parameters.assign(fan.slopes.size(), kMiss);
  const Eigen::Vector3f cells = Eigen::Vector3d(1.0 / kCell, 1.0 / kCell, 1.0).cast<float>();
  const Eigen::Vector3d corner(first_column_ * kCell, first_row_ * kCell, 0.0);
  const Eigen::Vector3f origin = (fan.origin - corner).cast<float>().cwiseProduct(cells);
  const Eigen::Vector3f forward = fan.forward.cast<float>().cwiseProduct(cells);
  const Eigen::Vector3f up = fan.up.cast<float>().cwiseProduct(cells);

  // In one plane a higher ray enters the ground further out: each begins where the one below it ended.
  float reached = kNearest;
  for (std::size_t i = 0; i < fan.slopes.size(); ++i) {
    const float from = std::max(kNearest, reached - kStep);
    reached = enter(origin, forward + fan.slopes[i] * up, from);
    if (reached == kMiss) return;
    parameters[i] = reached;
  }
}

}  // namespace donex::simulation
