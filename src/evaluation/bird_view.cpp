#include <algorithm>
#include <cmath>

#include "evaluation/comparison.h"

namespace donex {
namespace {

constexpr std::uint32_t kNoCell = 0xFFFFFFFFU;

/// Number of the cell an echo falls into.
std::uint32_t cellOf(const Eigen::Vector3f& echo) {
  constexpr int kMiddle = BirdView::kWidth / 2;
  const double column = std::floor(static_cast<double>(echo.x()) / BirdView::kCell) + kMiddle;
  const double row = std::floor(static_cast<double>(echo.y()) / BirdView::kCell) + kMiddle;
  const bool is_inside = column >= 0 && column < BirdView::kWidth && row >= 0 && row < BirdView::kWidth;  // not for NaN
  return is_inside ? static_cast<std::uint32_t>(row) * BirdView::kWidth + static_cast<std::uint32_t>(column) : kNoCell;
}

EchoOutcome outcomeOf(std::uint32_t truth, std::uint32_t prediction) {
  if (!isScored(truth)) return isMoving(prediction) ? EchoOutcome::kUnjudged : EchoOutcome::kStatic;
  if (isMoving(truth)) return isMoving(prediction) ? EchoOutcome::kFound : EchoOutcome::kMissed;
  return isMoving(prediction) ? EchoOutcome::kFalseAlarm : EchoOutcome::kStatic;
}

}  // namespace

BirdView makeBirdView(std::size_t scan, const std::vector<Eigen::Vector3f>& echoes,
                      const std::vector<std::uint32_t>& truth,
                      const std::vector<std::vector<std::uint32_t>>& predictions) {
  BirdView view;
  view.scan = scan;
  std::vector<std::uint32_t> occupied;
  occupied.reserve(echoes.size());
  for (const Eigen::Vector3f& echo : echoes) occupied.push_back(cellOf(echo));
  std::sort(occupied.begin(), occupied.end());
  occupied.erase(std::unique(occupied.begin(), occupied.end()), occupied.end());
  if (!occupied.empty() && occupied.back() == kNoCell) occupied.pop_back();
  for (const std::uint32_t cell : occupied) {
    view.cells.push_back(static_cast<std::uint16_t>(cell % BirdView::kWidth));
    view.cells.push_back(static_cast<std::uint16_t>(cell / BirdView::kWidth));
  }
  for (const auto& prediction : predictions) {
    std::vector<std::uint8_t> outcomes(occupied.size(), 0);
    for (std::size_t i = 0; i < prediction.size(); ++i) {
      const std::uint32_t cell = cellOf(echoes[i]);
      if (cell == kNoCell) continue;
      const auto at = std::lower_bound(occupied.begin(), occupied.end(), cell) - occupied.begin();
      std::uint8_t& outcome = outcomes[static_cast<std::size_t>(at)];
      outcome = std::max(outcome, static_cast<std::uint8_t>(outcomeOf(truth[i], prediction[i])));
    }
    view.outcomes.push_back(std::move(outcomes));
  }
  return view;
}

}  // namespace donex
