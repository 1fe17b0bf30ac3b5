#include "core/methods/evidence_explanation.h"

#include <algorithm>

namespace donex {
namespace {

EchoReason reasonOf(const JudgedScan& scan, std::size_t i, bool inside) {
  if (scan.is_echo[i] == 0) return EchoReason::kNoEcho;
  if (!inside) return EchoReason::kOutside;
  if (scan.is_solid[i] == 0) return EchoReason::kOwnBody;
  if (scan.roles[i] == ClusterRole::kLoose) return EchoReason::kLoose;
  if (scan.roles[i] != ClusterRole::kConnects) return EchoReason::kGround;
  if (scan.places[i] == Place::kUnobserved) return EchoReason::kUnobserved;
  return isNewPlace(scan.places[i]) ? EchoReason::kNewAlone : EchoReason::kSettled;
}

}  // namespace

std::vector<std::uint8_t> movingEchoes(const std::vector<Proof>& proofs) {
  std::vector<std::uint8_t> moving(proofs.size());
  std::transform(proofs.begin(), proofs.end(), moving.begin(),
                 [](Proof proof) { return static_cast<std::uint8_t>(proof != Proof::kNone); });
  return moving;
}

std::vector<EchoReason> reasonsOf(const JudgedScan& scan, const std::vector<std::uint8_t>& inside,
                                  const std::vector<Proof>& proofs) {
  std::vector<EchoReason> reasons(proofs.size());
  for (std::size_t i = 0; i < reasons.size(); ++i) {
    reasons[i] = proofs[i] != Proof::kNone ? EchoReason::kMoving : reasonOf(scan, i, inside[i] != 0);
  }
  return reasons;
}

MemoryCells memoryCellsOf(const Newness3d& places, const ScanClock& clock, const EvidenceConfig& config,
                          const SightHistory& sights, const Eigen::Isometry3d& odom_from_points) {
  MemoryCells cells;
  const auto size = static_cast<float>(places.window().voxelSize());
  const SightView seen = sights.seenFrom(odom_from_points);
  places.memory().forEach([&](const Index3& voxel, const VoxelRecord& record) {
    if (record.last_hit == clock.scan()) return;
    const Eigen::Vector3f point = (voxel.cast<float>().array() + 0.5F) * size;
    const bool settled = !clock.isYoung(record.birth, record.was_free);
    const double since = clock.stampOf(record.last_hit);
    auto& kind = weigh(config, seen, point, since, true, settled).was_free ? cells.seen_through : cells.shadowed;
    kind.emplace_back((odom_from_points * point.cast<double>()).cast<float>());
  });
  return cells;
}

}  // namespace donex
