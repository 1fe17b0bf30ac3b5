// The object step as the detector runs it, on judged echoes.
#pragma once

#include <cstdint>

#include "core/objects/object_tracker.h"
#include "core/objects/segmenter.h"
#include "support/judged_scene.h"

namespace donex::testing {

inline const SightImage::Reading kReading{true, 0.038};

/// What the detector does with a judged scan.
class Followed {
 public:
  explicit Followed(const ObjectConfig& config = {}) : segmenter_(60.0, config), tracker(config) {}

  /// Number of the scan's echoes that move. `goes_on_with`: what the first segment's echoes beside belong to;
  /// `is_plume`: all of them are.
  std::size_t step(const JudgedScene& scene, std::uint32_t goes_on_with = 0, bool is_plume = false) {
    history_.arrive(scene.scan(), scene.judged.is_echo);
    history_.add(scene.scan(), scene.judged.is_echo);
    tracker.predict(scene.judged, predictions_);
    segmenter_.connect(scene.judged);
    segmenter_.segment(scene.judged, predictions_, segments);
    if (goes_on_with != 0) segments[0].object = goes_on_with;
    for (Segment& segment : segments) segment.is_of_plume = is_plume;
    tracker.update(scene.judged, segments, predictions_, history_.newestSeenFrom(scene.judged.odom_from_points),
                   verdicts);
    tracker.describe(scene.judged, segments);
    std::size_t moving = 0;
    for (std::size_t i = 0; i < segments.size(); ++i) moving += verdicts[i].moves() ? segments[i].echoes.size() : 0U;
    return moving;
  }

 private:
  SightHistory history_{2.0, 0.0, 0.5F, kReading};
  Segmenter segmenter_;
  Predictions predictions_;

 public:
  ObjectTracker tracker;
  Segments segments;
  Verdicts verdicts;
};

/// The rear and a side of a vehicle whose rear is at x.
inline void addVehicle(JudgedScene& scene, double x, double y, Place place) {
  scene.face({x, y, 0.3}, {0.0, 1.8, 0.0}, 1.2, place, 0.05);
  scene.face({x, y, 0.3}, {4.0, 0.0, 0.0}, 1.2, place, 0.05);
}

}  // namespace donex::testing
