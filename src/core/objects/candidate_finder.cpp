#include "core/objects/candidate_finder.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace donex {
namespace {

constexpr double kRim = 0.3, kTightRim = 0.1;  // [m] around a thing
constexpr std::size_t kWorthCutting = 10;      // echoes
constexpr std::size_t kTooSmall = std::numeric_limits<std::size_t>::max();

Clusters::Settings clustersOf(const ObjectConfig& config, double cell) {
  Clusters::Settings settings;
  settings.cell = cell;
  settings.height = config.height;
  return settings;
}

}  // namespace

CandidateFinder::CandidateFinder(double reach, const ObjectConfig& config)
    : config_(config),
      clusters_(reach, clustersOf(config, config.cell)),
      fine_clusters_(reach, clustersOf(config, 0.5 * config.cell)) {}

void CandidateFinder::find(const JudgedScan& scan, const std::vector<Expected>& expected, Candidates& candidates) {
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
  if (!candidates.removeIf(is_mixed)) return;
  clusters_.connect(scan.sensor, scan.points, scan.heights, standing_);
  append(scan, candidates);
}

void CandidateFinder::append(const JudgedScan& scan, Candidates& candidates) {
  const std::size_t first = candidates.size();
  candidate_of_.assign(static_cast<std::size_t>(clusters_.count()), kTooSmall);
  for (int cluster = 0; cluster < clusters_.count(); ++cluster) {
    if (clusters_.echoesIn(cluster) < static_cast<std::size_t>(config_.min_echoes)) continue;
    candidate_of_[static_cast<std::size_t>(cluster)] = candidates.size();
    candidates.add(clusters_.echoesIn(cluster));
  }
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (clusters_.of(i) == Clusters::kNone) continue;
    const std::size_t candidate = candidate_of_[static_cast<std::size_t>(clusters_.of(i))];
    if (candidate != kTooSmall) candidates[candidate].echoes.push_back(static_cast<std::uint32_t>(i));
  }
  for (std::size_t i = first; i < candidates.size(); ++i) describeEchoes(scan, candidates[i]);
}

void CandidateFinder::cutOut(const JudgedScan& scan, const Expected& thing, std::size_t whole, Candidates& candidates) {
  const bool fits_in = ((thing.extent - candidates[whole].extent()).array() <= kRim).all();
  const bool worth_it = thing.moves_whole && thing.isLong() && thing.isWithin(candidates[whole]) && fits_in;
  if (!worth_it) return;
  const auto is_part = [&](std::uint32_t echo) {
    const Eigen::Vector3d offset = scan.odom_from_points * scan.points[echo].cast<double>() - thing.center;
    const bool inside = (offset.array().abs() <= (0.5 * thing.extent).array() + kTightRim).all();
    return inside && scan.places[echo] != Place::kSettled;
  };
  const auto all = candidates[whole].echoes.size();
  const auto of_part = static_cast<std::size_t>(
      std::count_if(candidates[whole].echoes.begin(), candidates[whole].echoes.end(), is_part));
  if (of_part < kWorthCutting || all - of_part < kWorthCutting) return;
  Candidate& part = candidates.add(of_part);
  Candidate& rest = candidates[whole];
  std::copy_if(rest.echoes.begin(), rest.echoes.end(), std::back_inserter(part.echoes), is_part);
  rest.echoes.erase(std::remove_if(rest.echoes.begin(), rest.echoes.end(), is_part), rest.echoes.end());
  part.cut_out = true;
  rest.cut_out = false;
  describeEchoes(scan, part);
  describeEchoes(scan, rest);
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

void CandidateFinder::release(const JudgedScan& scan, Candidates& candidates) {
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

void CandidateFinder::countParts(const JudgedScan& scan, const Candidates& candidates) {
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

double CandidateFinder::bytesFor(double reach, const ObjectConfig& config, double echoes) {
  return Clusters::bytesFor(reach, clustersOf(config, config.cell), echoes, 0.5 * echoes) +
         Clusters::bytesFor(reach, clustersOf(config, 0.5 * config.cell), echoes, 0.0) + echoes * sizeof(Standing);
}

std::size_t CandidateFinder::memoryBytes() const {
  return clusters_.memoryBytes() + fine_clusters_.memoryBytes() + standing_.capacity() * sizeof(Standing) +
         parts_.capacity() * sizeof(Part) + candidate_of_.capacity() * sizeof(std::size_t);
}

}  // namespace donex
