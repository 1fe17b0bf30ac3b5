#include "donex/core/candidate_finder.h"

#include <algorithm>
#include <limits>

namespace donex {
namespace {

constexpr double kLongest = 25.0;      // [m]
constexpr double kLeastShare = 0.15;   // of all echoes that must be new
constexpr double kAcrossAngle = 0.01;  // [rad] wider than any sensor's step in azimuth
constexpr double kUpAngle = 0.015;     // [rad]

Clusters::Settings clustersOf(const ObjectConfig& config, double cell) {
  return {cell, config.height, kAcrossAngle, kUpAngle};
}

}  // namespace

bool isTooLong(const Candidate& candidate) { return candidate.extent().maxCoeff() > kLongest; }

bool isNew(const Candidate& candidate, const ObjectConfig& config) {
  const double fresh = candidate.new_echoes;
  const bool enough = candidate.new_echoes >= config.min_echoes && !isTooLong(candidate);
  const bool outweighs = fresh > config.new_share * (fresh + candidate.settled_echoes);
  return enough && outweighs && fresh > kLeastShare * static_cast<double>(candidate.echoes.size());
}

CandidateFinder::CandidateFinder(double reach, const ObjectConfig& config)
    : config_(config),
      clusters_(reach, clustersOf(config, config.cell)),
      fine_clusters_(reach, clustersOf(config, 0.5 * config.cell)) {}

void CandidateFinder::find(const JudgedScan& scan, std::vector<Candidate>& candidates) {
  candidates.clear();
  clusters_.connect(scan.sensor, scan.points, scan.heights, scan.standing);
  append(scan, candidates);

  standing_.assign(scan.points.size(), Standing::kOut);
  const auto is_mixed = [&](const Candidate& candidate) {
    return candidate.new_echoes >= config_.min_echoes && !isNew(candidate, config_);
  };
  for (const Candidate& candidate : candidates) {
    if (!is_mixed(candidate)) continue;
    for (const std::uint32_t echo : candidate.echoes) {
      const bool may_move = scan.places[echo] != Place::kSettled && scan.standing[echo] == Standing::kIn;
      if (may_move) standing_[echo] = Standing::kIn;
    }
  }
  const auto whole_end = std::remove_if(candidates.begin(), candidates.end(), is_mixed);
  if (whole_end == candidates.end()) return;
  candidates.erase(whole_end, candidates.end());
  clusters_.connect(scan.sensor, scan.points, scan.heights, standing_);
  append(scan, candidates);
}

void CandidateFinder::append(const JudgedScan& scan, std::vector<Candidate>& candidates) const {
  const std::size_t first = candidates.size();
  candidates.resize(first + static_cast<std::size_t>(clusters_.count()));
  const Eigen::Vector3d infinity = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (clusters_.of(i) == Clusters::kNone) continue;
    Candidate& candidate = candidates[first + static_cast<std::size_t>(clusters_.of(i))];
    if (candidate.echoes.empty()) candidate.low = infinity, candidate.high = -infinity;
    candidate.echoes.push_back(static_cast<std::uint32_t>(i));
    candidate.new_echoes += scan.places[i] == Place::kNew ? 1 : 0;
    candidate.settled_echoes += scan.places[i] == Place::kSettled ? 1 : 0;
    const Eigen::Vector3d in_odom = scan.odom_from_points * scan.points[i].cast<double>();
    candidate.low = candidate.low.cwiseMin(in_odom);
    candidate.high = candidate.high.cwiseMax(in_odom);
  }
  const auto is_small = [&](const Candidate& candidate) {
    return candidate.echoes.size() < static_cast<std::size_t>(config_.min_echoes);
  };
  const auto appended = candidates.begin() + static_cast<std::ptrdiff_t>(first);
  candidates.erase(std::remove_if(appended, candidates.end(), is_small), candidates.end());
}

void CandidateFinder::release(const JudgedScan& scan, std::vector<Candidate>& candidates) {
  const auto releasable = [&](const Candidate& candidate) { return isReleasable(candidate); };
  if (std::none_of(candidates.begin(), candidates.end(), releasable)) return;
  standing_.assign(scan.points.size(), Standing::kOut);
  for (const Candidate& candidate : candidates) {
    if (!isReleasable(candidate)) continue;
    for (const std::uint32_t echo : candidate.echoes) standing_[echo] = scan.standing[echo];
  }
  fine_clusters_.connect(scan.sensor, scan.points, scan.heights, standing_);
  countParts(scan, candidates);
  for (Candidate& candidate : candidates) {
    if (isReleasable(candidate)) releaseFrom(candidate);
  }
}

void CandidateFinder::countParts(const JudgedScan& scan, const std::vector<Candidate>& candidates) {
  parts_.assign(static_cast<std::size_t>(fine_clusters_.count()), Part{});
  for (const Candidate& candidate : candidates) {
    if (!isReleasable(candidate)) continue;
    for (const std::uint32_t echo : candidate.echoes) {
      if (fine_clusters_.of(echo) == Clusters::kNone) continue;
      Part& part = parts_[static_cast<std::size_t>(fine_clusters_.of(echo))];
      ++part.echoes;
      part.settled += scan.places[echo] == Place::kSettled ? 1U : 0U;
      part.is_new = part.is_new || scan.places[echo] == Place::kNew;
    }
  }
}

void CandidateFinder::releaseFrom(Candidate& candidate) const {
  const auto part_of = [&](std::uint32_t echo) {
    const int part = fine_clusters_.of(echo);
    return part == Clusters::kNone ? nullptr : &parts_[static_cast<std::size_t>(part)];
  };
  std::size_t largest_new = 0;
  for (const std::uint32_t echo : candidate.echoes) {
    const Part* part = part_of(echo);
    if (part != nullptr && part->is_new) largest_new = std::max(largest_new, part->echoes);
  }
  const auto stands_apart = [&](std::uint32_t echo) {
    const Part* part = part_of(echo);
    return part != nullptr && !part->is_new && (2 * part->settled > part->echoes || part->echoes > largest_new);
  };
  const auto kept = std::remove_if(candidate.echoes.begin(), candidate.echoes.end(), stands_apart);
  candidate.echoes.erase(kept, candidate.echoes.end());
}

std::size_t CandidateFinder::memoryBytes() const {
  return clusters_.memoryBytes() + fine_clusters_.memoryBytes() + standing_.capacity() * sizeof(Standing) +
         parts_.capacity() * sizeof(Part);
}

}  // namespace donex
