// The last few scans' sights: was this place seen free lately?
#pragma once

#include <array>
#include <vector>

#include "core/sight/sight_image.h"
#include "donex/scan.h"

namespace donex {

class SightHistory;

/// What one scan saw, asked in points of the frame it was made for [m].
class ScanSight {
 public:
  ScanSight() = default;
  ScanSight(const SightImage& image, const Eigen::Isometry3f& sensor_from_points, float margin)
      : image_(&image), sensor_from_points_(sensor_from_points), margin_(margin) {}

  /// What the scan saw at `point`, within `margin` [m]; unknown where there is no scan.
  SightImage::Sight at(const Eigen::Vector3f& point, float margin) const {
    return image_ == nullptr ? SightImage::Sight::kUnknown : image_->at(sensor_from_points_ * point, margin);
  }
  SightImage::Sight at(const Eigen::Vector3f& point) const { return at(point, margin_); }
  /// The same of its single lines of sight: between the wires of a fence they see through.
  SightImage::Sight throughGaps(const Eigen::Vector3f& point, float margin) const {
    return image_ == nullptr ? SightImage::Sight::kUnknown : image_->throughGaps(sensor_from_points_ * point, margin);
  }

 private:
  const SightImage* image_ = nullptr;
  Eigen::Isometry3f sensor_from_points_ = Eigen::Isometry3f::Identity();
  float margin_ = 0.0F;  ///< [m]
};

/// What the remembered scans saw, asked in points of the frame it was made for [m]. Valid until the history changes.
class SightView {
 public:
  struct Evidence {
    int free = 0;             ///< scans that saw through the place
    int surface = 0;          ///< scans that saw a surface there
    int hidden = 0;           ///< scans that saw something before it
    int stale_surface = 0;    ///< of `surface`: before the newest scan that saw through
    int lasting_surface = 0;  ///< of `surface`: at least kApproach before the newest scan

    /// What comes at walking pace is within the margin of a place for so long before it hits it [s].
    static constexpr double kApproach = 0.45;
  };

  /// What the scans later than `since` [s] saw at `point`; stops early once `enough` of them saw it free.
  Evidence ask(const Eigen::Vector3f& point, double since, int enough) const;

 private:
  friend class SightHistory;
  /// Made anew for each scan, on the stack: as many as SightHistory keeps.
  static constexpr std::size_t kMostScans = 128;
  struct Kept {
    double stamp;
    ScanSight sight;
  };

  std::array<Kept, kMostScans> kept_;  ///< newest first
  std::size_t count_ = 0;
};

/// Free evidence (algorithm: "Free evidence"): "never hit before" is not "was free before".
/// It is asked only of voxels that are newly hit, so a scan is kept as its sight image, nothing more.
class SightHistory {
 public:
  /// Keeps scans of the last `length` [s], at most one every `spacing` [s], and never more than SightView holds.
  SightHistory(double length, double spacing, float margin, const SightImage::Reading& reading)
      : length_(length), spacing_(spacing), margin_(margin), reading_(reading) {}

  /// Takes what a scan saw. Stamps grow. Views made before are no longer valid.
  void add(const Scan& scan, const std::vector<std::uint8_t>& is_echo);

  /// What all kept scans saw; to be asked in points whose frame lies in the odometry's like this.
  SightView seenFrom(const Eigen::Isometry3d& odom_from_points) const;
  /// The same of the newest kept scan alone.
  ScanSight newestSeenFrom(const Eigen::Isometry3d& odom_from_points) const;

  bool empty() const { return kept_.empty(); }
  void reset();
  std::size_t memoryBytes() const;
  /// What memoryBytes will be with a sensor of as many scans as are kept, of so many echoes [bytes].
  static double bytesFor(double length, double spacing, double echoes);

 private:
  struct Kept {
    double stamp;
    Eigen::Isometry3d sensor_from_odom;
    SightImage image;
  };

  void forget(double until);
  ScanSight sightOf(const Kept& kept, const Eigen::Isometry3d& odom_from_points) const {
    return {kept.image, (kept.sensor_from_odom * odom_from_points).cast<float>(), margin_};
  }

  double length_, spacing_;
  float margin_;
  SightImage::Reading reading_;
  std::vector<Kept> kept_;          ///< oldest first
  std::vector<SightImage> spares_;  ///< storage for the next images
};

}  // namespace donex
