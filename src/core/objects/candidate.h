// A segment: connected echoes of one scan that may be an object (algorithm: "Segments").
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory_resource>
#include <vector>

#include "core/evidence/judged_scan.h"
#include "core/objects/scan_memory.h"
#include "donex/config.h"

namespace donex {

constexpr double kFollowed = 1.5;  ///< [m] off its expected place a thing that is followed is found at most

/// A thing of the present scan and what its echoes say.
struct Candidate {
  explicit Candidate(std::pmr::memory_resource* memory = std::pmr::get_default_resource()) : echoes(memory) {}

  std::pmr::vector<std::uint32_t> echoes;  ///< indices into the scan
  int new_echoes = 0;
  int settled_echoes = 0;
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();  ///< odometry frame [m]
  bool cut_out = false;      ///< cut from a larger cluster where a moving thing was expected
  bool dynamic = false;      ///< the verdict
  bool moves_whole = false;  ///< the verdict is about the whole thing, not about its new echoes alone

  Eigen::Vector3d center() const { return 0.5 * (low + high); }
  Eigen::Vector3d extent() const { return high - low; }
};

/// The things of one scan.
class Candidates {
 public:
  /// Makes one more, with room for so many echoes. Valid until the next call.
  Candidate& add(std::size_t echoes) {
    Candidate& candidate = things_.emplace_back(memory_.resource());
    candidate.echoes.reserve(echoes);
    return candidate;
  }
  /// Keeps the order of the others.
  template <class Condition>
  bool removeIf(Condition&& condition) {
    const auto end = std::remove_if(things_.begin(), things_.end(), condition);
    const bool any = end != things_.end();
    things_.erase(end, things_.end());
    return any;
  }
  void clear() {
    things_.clear();
    memory_.release();
  }

  std::size_t size() const { return things_.size(); }
  Candidate& operator[](std::size_t i) { return things_[i]; }
  const Candidate& operator[](std::size_t i) const { return things_[i]; }
  auto begin() { return things_.begin(); }
  auto begin() const { return things_.begin(); }
  auto end() { return things_.end(); }
  auto end() const { return things_.end(); }

  std::size_t memoryBytes() const { return memory_.bytes() + things_.capacity() * sizeof(Candidate); }

 private:
  ScanMemory memory_;  ///< outlives the things
  std::vector<Candidate> things_;
};

/// Where a moving thing that is followed should be now, odometry frame [m].
struct Expected {
  Eigen::Vector3d center, extent;
  bool moves_whole = false;  ///< it was seen to move as one not long ago

  /// Longer than what it moves in the birth window: its own side settles under it.
  bool isLong() const;
  bool looksLike(const Candidate& candidate) const;
  /// It is somewhere in the candidate, which is more than that.
  bool isWithin(const Candidate& candidate) const;
};

/// Fills in everything that follows from the candidate's echoes.
void describeEchoes(const JudgedScan& scan, Candidate& candidate);

/// Extents [m] that may be those of one thing, seen from two places.
bool alike(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// Longer than any vehicle: a wall, a hedge, or things that touch.
bool isTooLong(const Candidate& candidate);

/// More of it is settled than not.
bool isMostlySettled(const Candidate& candidate);

/// Enough of the candidate is new, by number and against what is settled.
bool isNew(const Candidate& candidate, const ObjectConfig& config);

/// Near, and yet hardly higher than a beam: the edge of something, a wire, a branch. `sensor` in the odometry frame.
bool isThin(const Candidate& candidate, const Eigen::Vector3d& sensor);

}  // namespace donex
