// Connected echoes of one scan that may be an object, and what is decided about them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory_resource>
#include <vector>

#include "core/evidence/judged_scan.h"
#include "core/objects/scan_memory.h"
#include "donex/proof.h"

namespace donex {

/// Connected echoes of the present scan, and what their places say. Only the segmenter writes it; low parts come last,
/// and count in nothing but its echoes.
struct Segment {
  explicit Segment(std::pmr::memory_resource* memory = std::pmr::get_default_resource()) : echoes(memory) {}
  /// Moved, never copied: with Eigen 3.3 a vector would copy its segments as it grows, out of the scan's memory.
  Segment(Segment&&) = default;
  Segment& operator=(Segment&&) = default;

  std::pmr::vector<std::uint32_t> echoes;  ///< indices into the scan
  int new_echoes = 0;
  int surely_new_echoes = 0, coarsely_new_echoes = 0, lingering_echoes = 0;  ///< of new_echoes
  int surface_echoes = 0;
  int settled_echoes = 0;
  float lowest = 0.0F;                          ///< height above ground [m]; 0 where no ground is known
  float lowest_new = 0.0F, highest_new = 0.0F;  ///< the same of its new echoes
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();  ///< odometry frame [m]
  bool is_mixed = false;  ///< of what stands and what may move, which is a segment of its own, too: only followed
  bool cut_out = false;   ///< cut from a larger cluster where a moving object was predicted
  bool is_of_two_turns =
      false;                 ///< has echoes of the turn before, where this one has not looked yet: more of it may come
  bool is_of_plume = false;  ///< of dust or spray, not a thing
  std::uint32_t object = 0;  ///< that its echoes of earlier parts of the turn belong to; 0: none

  int freshEchoes() const { return new_echoes - lingering_echoes; }
  Eigen::Vector3d center() const { return 0.5 * (low + high); }
  Eigen::Vector3d extent() const { return high - low; }
};

/// The segments of one scan.
class Segments {
 public:
  /// Makes one more, with room for so many echoes. Valid until the next call.
  Segment& add(std::size_t echoes) {
    Segment& segment = segments_.emplace_back(memory_.resource());
    segment.echoes.reserve(echoes);
    return segment;
  }
  /// Keeps the order of the others.
  template <class Condition>
  bool removeIf(Condition&& condition) {
    const auto end = std::remove_if(segments_.begin(), segments_.end(), condition);
    const bool any = end != segments_.end();
    segments_.erase(end, segments_.end());
    return any;
  }
  void clear() {
    segments_.clear();
    memory_.release();
  }

  std::size_t size() const { return segments_.size(); }
  Segment& operator[](std::size_t i) { return segments_[i]; }
  const Segment& operator[](std::size_t i) const { return segments_[i]; }
  auto begin() { return segments_.begin(); }
  auto begin() const { return segments_.begin(); }
  auto end() { return segments_.end(); }
  auto end() const { return segments_.end(); }

  std::size_t memoryBytes() const { return memory_.bytes() + segments_.capacity() * sizeof(Segment); }

 private:
  ScanMemory memory_;  ///< outlives the segments
  std::vector<Segment> segments_;
};

/// What is decided about a segment.
struct Verdict {
  Proof proof = Proof::kNone;
  bool moves_whole = false;  ///< the proof is about the whole segment, not about its new echoes alone
  std::uint32_t object = 0;  ///< id of the object that the segment is followed as; 0: it is not

  bool moves() const { return proof != Proof::kNone; }
};

/// One per segment.
using Verdicts = std::vector<Verdict>;

/// Where an object that is followed and moves, or seems to, should be now, odometry frame [m].
struct Prediction {
  Eigen::Vector3d center, extent;
  Eigen::Vector3d full_extent;  ///< as seen when less of it was hidden
  bool moves_whole = false;     ///< it was seen to move as a whole not long ago
  bool is_displaced = false;    ///< all of it was seen elsewhere in the scan before
  bool is_proven = true;        ///< its motion; else it only seemed to be displaced so far
};
using Predictions = std::vector<Prediction>;

/// Fills in everything that follows from the segment's echoes.
void describeEchoes(const JudgedScan& scan, Segment& segment);

}  // namespace donex
