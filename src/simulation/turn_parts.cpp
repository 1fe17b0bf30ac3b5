#include "simulation/turn_parts.h"

#include <algorithm>

#include "core/sector.h"

namespace donex::simulation {

TurnParts::TurnParts(const SimulatorOptions& options)
    : duration_(1.0 / options.scan_rate),
      distortion_(options.distortion),
      echoes_of_part_(static_cast<std::size_t>(options.parts)) {}

PartTimes TurnParts::timesOf(std::size_t part, double end) const {
  if (!distortion_) return {end, end + duration_ * shareOf(part)};
  const double complete = end - duration_ * (1.0 - shareOf(part + 1));
  return {complete, complete};
}

std::size_t TurnParts::partOf(const SimulatedEcho& echo) const {
  if (!distortion_) return sectorOf(echo.position, count());
  // The own body has no time: it comes when the beam, clockwise from behind, passes it.
  const bool has_time = echo.time < 0.0F;
  if (!has_time) return sectorOf({-echo.position.x(), echo.position.y(), echo.position.z()}, count());
  const double share = 1.0 + static_cast<double>(echo.time) / duration_;
  return std::min(static_cast<std::size_t>(std::max(share, 0.0) * static_cast<double>(count())), count() - 1);
}

void TurnParts::cut(const std::vector<SimulatedEcho>& echoes) {
  for (std::vector<std::uint32_t>& part : echoes_of_part_) part.clear();
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    echoes_of_part_[partOf(echoes[i])].push_back(static_cast<std::uint32_t>(i));
  }
}

}  // namespace donex::simulation
