#include "core/objects/trimmer.h"

#include <algorithm>

namespace donex {
Trimmer::Trimmer(double reach, const ObjectConfig& config, const TrimmerOptions& options)
    : clusters_(reach, clustersOf(config, options.finer_cells)) {}

void Trimmer::trim(const JudgedScan& scan, const Segments& segments, const Verdicts& verdicts,
                   std::vector<Proof>& proofs, const Workers& workers) {
  proofs.assign(scan.points.size(), Proof::kNone);
  const bool any_parts = findParts(scan, segments, verdicts, workers);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Verdict& verdict = verdicts[i];
    if (!verdict.moves()) continue;
    const bool has_parts = any_parts && isTrimmed(segments[i], verdict);
    const std::size_t largest_new = has_parts ? largestNewPart(segments[i]) : 0;
    const auto stands_apart = [&](std::uint32_t echo) {
      const Part* part = has_parts ? partOf(echo) : nullptr;
      if (part == nullptr || part->is_new) return false;
      return 2 * part->settled > part->echoes || (part->echoes > largest_new && !verdict.moves_whole);
    };
    for (const std::uint32_t echo : segments[i].echoes) {
      if (!stands_apart(echo)) proofs[echo] = verdict.proof;
    }
  }
}

/// False where nothing is to be trimmed.
bool Trimmer::findParts(const JudgedScan& scan, const Segments& segments, const Verdicts& verdicts,
                        const Workers& workers) {
  bool any = false;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (!isTrimmed(segments[i], verdicts[i])) continue;
    if (!any) roles_.assign(scan.points.size(), ClusterRole::kNone);
    any = true;
    for (const std::uint32_t echo : segments[i].echoes) roles_[echo] = scan.roles[echo];
  }
  if (!any) return false;
  clusters_.connect(scan.sensor, scan.points, scan.heights, roles_, scan.beams_apart, workers);
  parts_.assign(static_cast<std::size_t>(clusters_.count()), Part{});
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (isTrimmed(segments[i], verdicts[i])) count(scan, segments[i]);
  }
  return true;
}

void Trimmer::count(const JudgedScan& scan, const Segment& segment) {
  for (const std::uint32_t echo : segment.echoes) {
    if (clusters_.of(echo) == Clusters::kNone) continue;
    Part& part = parts_[static_cast<std::size_t>(clusters_.of(echo))];
    ++part.echoes;
    part.settled += scan.places[echo] == Place::kSettled ? 1U : 0U;
    part.is_new = part.is_new || isNewPlace(scan.places[echo]);
  }
}

const Trimmer::Part* Trimmer::partOf(std::uint32_t echo) const {
  const int cluster = clusters_.of(echo);
  return cluster == Clusters::kNone ? nullptr : &parts_[static_cast<std::size_t>(cluster)];
}

std::size_t Trimmer::largestNewPart(const Segment& segment) const {
  std::size_t largest = 0;
  for (const std::uint32_t echo : segment.echoes) {
    const Part* part = partOf(echo);
    if (part != nullptr && part->is_new) largest = std::max(largest, part->echoes);
  }
  return largest;
}

double Trimmer::bytesFor(double reach, const ObjectConfig& config, double echoes, const TrimmerOptions& options) {
  return Clusters::bytesFor(reach, clustersOf(config, options.finer_cells), echoes, 0.0) + echoes * sizeof(ClusterRole);
}

std::size_t Trimmer::memoryBytes() const {
  return clusters_.memoryBytes() + roles_.capacity() * sizeof(ClusterRole) + parts_.capacity() * sizeof(Part);
}

}  // namespace donex
