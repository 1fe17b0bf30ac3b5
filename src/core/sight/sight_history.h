// The last few scans' sights: was this place seen free lately?
#pragma once

#include <vector>

#include "core/sight/sight_image.h"
#include "donex/scan.h"

namespace donex {

/// Free evidence (algorithm: "Free evidence"): "never hit before" is not "was free before".
/// It is asked only of voxels that are newly hit, so a scan is kept as its sight image, nothing more.
class SightHistory {
 public:
  struct Evidence {
    int free = 0;     ///< scans that saw through the place
    int surface = 0;  ///< scans that saw a surface there
    int hidden = 0;   ///< scans that saw something before it
  };

  /// Keeps scans of the last `length` [s], at most one every `spacing` [s].
  SightHistory(double length, double spacing, float margin, const SightImage::Reading& reading)
      : length_(length), spacing_(spacing), margin_(margin), reading_(reading) {}

  /// Takes what a scan saw. Stamps grow.
  void add(const Scan& scan, const std::vector<std::uint8_t>& is_echo);

  /// Fixes the frame of the following questions: window or grid coordinates [m] to odometry.
  void askFrom(const Eigen::Isometry3d& odom_from_asked);

  /// What the kept scans later than `since` [s] saw at `point`; stops early once `enough` of them saw it free.
  Evidence ask(const Eigen::Vector3f& point, double since, int enough) const;

  /// What the newest scan alone saw at `point`, on `margin` [m].
  SightImage::Sight askNewest(const Eigen::Vector3f& point, float margin) const;
  SightImage::Sight askNewest(const Eigen::Vector3f& point) const { return askNewest(point, margin_); }
  /// The same of its single lines of sight: between the wires of a fence they see through.
  SightImage::Sight askThroughGaps(const Eigen::Vector3f& point, float margin) const;

  bool empty() const { return kept_.empty(); }
  void reset();
  std::size_t memoryBytes() const;
  /// What memoryBytes will be with a sensor of as many scans as are kept, of so many echoes [bytes].
  static double bytesFor(double length, double spacing, double echoes);

 private:
  struct Kept {
    double stamp;
    Eigen::Isometry3d sensor_from_odom;
    Eigen::Isometry3f sensor_from_asked;
    SightImage image;
  };

  void forget(double until);

  double length_, spacing_;
  float margin_;
  SightImage::Reading reading_;
  std::vector<Kept> kept_;          ///< oldest first
  std::vector<SightImage> spares_;  ///< storage for the next images
};

}  // namespace donex
