#include "donex/core/candidate_finder.h"

#include <algorithm>

namespace donex {
namespace {

constexpr double kAcrossAngle = 0.01;          // [rad] wider than any sensor's step in azimuth
constexpr double kRim = 0.3, kTightRim = 0.1;  // [m] around a thing
constexpr std::size_t kWorthCutting = 10;      // echoes
constexpr double kUpAngle = 0.015;             // [rad]

Clusters::Settings clustersOf(const ObjectConfig& config, double cell) {
  return {cell, config.height, kAcrossAngle, kUpAngle};
}

}  // namespace

CandidateFinder::CandidateFinder(double reach, const ObjectConfig& config)
    : config_(config),
      clusters_(reach, clustersOf(config, config.cell)),
      fine_clusters_(reach, clustersOf(config, 0.5 * config.cell)) {}

void CandidateFinder::find(const JudgedScan& scan, const std::vector<Expected>& expected,
                           std::vector<Candidate>& candidates) {
  candidates.clear();
  clusters_.connect(scan.sensor, scan.points, scan.heights, scan.standing);
  append(scan, candidates);
  const std::size_t clusters = candidates.size();
  for (std::size_t i = 0; i < clusters; ++i) {
    for (const Expected& thing : expected) cutOut(scan, thing, i, candidates);
  }

  standing_.assign(scan.points.size(), Standing::kOut);
  const auto is_mixed = [&](const Candidate& candidate) { return isMixed(candidate, expected); };
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
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (clusters_.of(i) == Clusters::kNone) continue;
    candidates[first + static_cast<std::size_t>(clusters_.of(i))].echoes.push_back(static_cast<std::uint32_t>(i));
  }
  const auto is_small = [&](const Candidate& candidate) {
    return candidate.echoes.size() < static_cast<std::size_t>(config_.min_echoes);
  };
  const auto appended = candidates.begin() + static_cast<std::ptrdiff_t>(first);
  candidates.erase(std::remove_if(appended, candidates.end(), is_small), candidates.end());
  for (std::size_t i = first; i < candidates.size(); ++i) describeEchoes(scan, candidates[i]);
}

void CandidateFinder::cutOut(const JudgedScan& scan, const Expected& thing, std::size_t whole,
                             std::vector<Candidate>& candidates) const {
  const bool is_larger = ((thing.extent - candidates[whole].extent()).array() <= kRim).all();
  const bool worth_it = thing.moves_whole && thing.isLong() && thing.isWithin(candidates[whole]) && is_larger;
  if (!worth_it) return;
  Candidate part, rest;
  for (const std::uint32_t echo : candidates[whole].echoes) {
    const Eigen::Vector3d offset = scan.odom_from_points * scan.points[echo].cast<double>() - thing.center;
    const bool inside = (offset.array().abs() <= (0.5 * thing.extent).array() + kTightRim).all();
    (inside && scan.places[echo] != Place::kSettled ? part : rest).echoes.push_back(echo);
  }
  if (part.echoes.size() < kWorthCutting || rest.echoes.size() < kWorthCutting) return;
  part.cut_out = true;
  describeEchoes(scan, part);
  describeEchoes(scan, rest);
  candidates[whole] = std::move(rest);
  candidates.push_back(std::move(part));
}

bool CandidateFinder::isMixed(const Candidate& candidate, const std::vector<Expected>& expected) const {
  if (isNew(candidate, config_)) return false;
  const auto is_it = [&](const Expected& thing) { return thing.isLong() && thing.looksLike(candidate); };
  const bool is_known = !isMostlySettled(candidate) && std::any_of(expected.begin(), expected.end(), is_it);
  if (is_known) return false;
  const std::size_t unsettled = candidate.echoes.size() - static_cast<std::size_t>(candidate.settled_echoes);
  const bool has_parts =
      unsettled >= kWorthCutting && 4 * static_cast<std::size_t>(candidate.settled_echoes) >= unsettled;
  const auto is_within = [&](const Expected& thing) { return thing.isWithin(candidate); };
  const bool hides_a_thing = has_parts && std::any_of(expected.begin(), expected.end(), is_within);
  return hides_a_thing || candidate.new_echoes >= config_.min_echoes;
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
    if (part == nullptr || part->is_new) return false;
    return 2 * part->settled > part->echoes || (part->echoes > largest_new && !candidate.moves_whole);
  };
  const auto kept = std::remove_if(candidate.echoes.begin(), candidate.echoes.end(), stands_apart);
  candidate.echoes.erase(kept, candidate.echoes.end());
}

std::size_t CandidateFinder::memoryBytes() const {
  return clusters_.memoryBytes() + fine_clusters_.memoryBytes() + standing_.capacity() * sizeof(Standing) +
         parts_.capacity() * sizeof(Part);
}

}  // namespace donex
