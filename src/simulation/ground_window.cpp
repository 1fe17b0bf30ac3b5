#include "donex/simulation/ground_window.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "donex/simulation/shape.h"

namespace donex::simulation {
namespace {

constexpr int kMask = GroundWindow::kCells - 1;
constexpr int kMoveCells = 16;   // the window follows in steps
constexpr float kStep = 0.2f;    // [m]
constexpr float kSteepest = 0.75f;  // no slope of the samples is steeper: a kerb's height over one cell
constexpr float kNearest = 0.3f;    // [m]

int cellOf(double coordinate) { return static_cast<int>(std::floor(coordinate / GroundWindow::kCell)); }

}  // namespace

GroundWindow::GroundWindow(const Ground& ground)
    : ground_(ground), samples_(static_cast<std::size_t>(kCells) * kCells) {}

std::size_t GroundWindow::slot(int column, int row) const {
  return static_cast<std::size_t>(row & kMask) * kCells + static_cast<std::size_t>(column & kMask);
}

void GroundWindow::sampleBlock(int first_column, int first_row, int columns, int rows) {
  for (int row = first_row; row < first_row + rows; ++row) {
    for (int column = first_column; column < first_column + columns; ++column) {
      const GroundPoint point = ground_.at(kCell * Eigen::Vector2d(column, row));
      samples_[slot(column, row)] = {static_cast<float>(point.height), point.label};
    }
  }
}

void GroundWindow::moveTo(const Eigen::Vector2d& center) {
  const auto firstFor = [](double coordinate) {
    return cellOf(coordinate / kMoveCells) * kMoveCells - kCells / 2;
  };
  const int column = firstFor(center.x());
  const int row = firstFor(center.y());
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
  const float column = std::floor(u);
  const float row = std::floor(v);
  const int i = static_cast<int>(column) + first_column_;
  const int j = static_cast<int>(row) + first_row_;
  const float a = u - column;
  const float b = v - row;
  const float low = samples_[slot(i, j)].height * (1.0f - a) + samples_[slot(i + 1, j)].height * a;
  const float high = samples_[slot(i, j + 1)].height * (1.0f - a) + samples_[slot(i + 1, j + 1)].height * a;
  return low * (1.0f - b) + high * b;
}

float GroundWindow::height(double x, double y) const {
  return heightAtCell(static_cast<float>(x / kCell - first_column_), static_cast<float>(y / kCell - first_row_));
}

std::uint32_t GroundWindow::label(double x, double y) const {
  return samples_[slot(cellOf(x + 0.5 * kCell), cellOf(y + 0.5 * kCell))].label;
}

Eigen::Vector3f GroundWindow::normal(double x, double y) const {
  const auto run = static_cast<float>(2.0 * kCell);
  const float across = (height(x + kCell, y) - height(x - kCell, y)) / run;
  const float along = (height(x, y + kCell) - height(x, y - kCell)) / run;
  return Eigen::Vector3f(-across, -along, 1.0f).normalized();
}

void GroundWindow::meet(const RayFan& fan, std::vector<float>& parameters) const {
  parameters.assign(fan.slopes.size(), kMiss);
  const auto u0 = static_cast<float>(fan.origin.x() / kCell - first_column_);
  const auto v0 = static_cast<float>(fan.origin.y() / kCell - first_row_);
  const auto z0 = static_cast<float>(fan.origin.z());
  const Eigen::Vector3f forward = fan.forward.cast<float>();
  const Eigen::Vector3f up = fan.up.cast<float>();
  const auto cells = static_cast<float>(1.0 / kCell);

  // In one plane a higher ray enters the ground further out: each begins where the one below it ended.
  float r = kNearest;
  for (std::size_t i = 0; i < fan.slopes.size(); ++i) {
    const Eigen::Vector3f direction = forward + fan.slopes[i] * up;
    const float du = direction.x() * cells;
    const float dv = direction.y() * cells;
    r = std::max(kNearest, r - kStep);
    float before_r = r;
    float before = 0.0f;
    while (r < static_cast<float>(kReach)) {
      const float above = z0 + r * direction.z() - heightAtCell(u0 + r * du, v0 + r * dv);
      if (above <= 0.0f) {
        r = before > 0.0f ? before_r + (r - before_r) * before / (before - above) : r;
        parameters[i] = r;
        break;
      }
      before_r = r;
      before = above;
      r += std::max(kStep, above / std::max(0.2f, kSteepest - direction.z()));
    }
    if (parameters[i] == kMiss) return;
  }
}

}  // namespace donex::simulation
