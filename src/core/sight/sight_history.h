// The sights of the last turns: was this place seen free lately?
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/sight/sight_image.h"
#include "core/sight/turns.h"
#include "donex/measured_sensor.h"
#include "donex/scan.h"

namespace donex {

class SightHistory;

/// An image, and how points of the frame it is asked in lie before it [m].
struct ImageSight {
  const SightImage* image = nullptr;
  Eigen::Isometry3f sensor_from_points = Eigen::Isometry3f::Identity();
};

/// What was seen last in each direction, asked in points of the frame it was made for [m].
class ScanSight {
 public:
  /// What was seen at `point`, within `margin` [m]; unknown where nobody looked.
  SightImage::Sight at(const Eigen::Vector3f& point, float margin) const {
    return ask(point, [&](const SightImage& image, const Eigen::Vector3f& seen) { return image.at(seen, margin); });
  }
  SightImage::Sight at(const Eigen::Vector3f& point) const { return at(point, margin_); }
  /// The same of single lines of sight: between the wires of a fence they see through.
  SightImage::Sight throughGaps(const Eigen::Vector3f& point, float margin) const {
    return ask(point,
               [&](const SightImage& image, const Eigen::Vector3f& seen) { return image.throughGaps(seen, margin); });
  }
  /// The same of the nearest beam, as SightImage::ofNearestBeam.
  SightImage::Sight ofNearestBeam(const Eigen::Vector3f& point, float margin, int rows) const {
    return ask(point, [&](const SightImage& image, const Eigen::Vector3f& seen) {
      return image.ofNearestBeam(seen, margin, rows);
    });
  }

 private:
  friend class SightHistory;

  /// Of the first image that looks there.
  template <class Question>
  SightImage::Sight ask(const Eigen::Vector3f& point, Question&& question) const {
    for (std::size_t i = 0; i < count_; ++i) {
      const Eigen::Vector3f seen = images_[i].sensor_from_points * point;
      if (i + 1 == count_ || images_[i].image->looksAt(seen)) return question(*images_[i].image, seen);
    }
    return SightImage::Sight::kUnknown;
  }

  std::array<ImageSight, 2 * Turns::kMostSensors> images_;  ///< newest first
  std::size_t count_ = 0;
  float margin_ = 0.0F;  ///< [m]
};

/// How much it counts that a scan saw through a place: it did not look between two beams, and read carefully it says
/// free there all the same. Places count fully up to where beams lie so far apart, and in proportion beyond.
struct CertaintyOptions {
  float gap = 0.4F;       ///< of an object: what moves is seldom lower [m]
  float fine_gap = 0.2F;  ///< of what is as low as a voxel [m]
  float least = 0.4F;     ///< of an object: places far away are not looked at by so many more scans
};

/// What the remembered turns saw, asked in points of the frame it was made for [m]. Valid until the history changes.
class SightView {
 public:
  struct Evidence {
    int free = 0;               ///< scans that saw through the place
    float certain_free = 0.0F;  ///< `free`, where each counts by how surely it looked at the place
    float fine_free = 0.0F;     ///< the same, where the place is as low as a voxel
    int surface = 0;            ///< scans that saw a surface there
    int hidden = 0;             ///< scans that saw something before it
    int stale_surface = 0;      ///< of `surface`: before the newest scan that saw through
    int lasting_surface = 0;    ///< of `surface`: at least kApproach before the newest scan
    double overlooked = 0.0;    ///< time since the newest scan that saw through in which it was out of view [s]

    /// What comes at walking pace is within the margin of a place for so long before it hits it [s].
    static constexpr double kApproach = 0.45;
  };

  /// What the scans later than `since` [s] saw at `point`; stops early once `enough` of them saw it free.
  Evidence ask(const Eigen::Vector3f& point, double since, int enough) const {
    return ask(point, since, enough, margin_);
  }
  /// The same within another margin [m].
  Evidence ask(const Eigen::Vector3f& point, double since, int enough, float margin) const;

 private:
  friend class SightHistory;
  /// Made anew for each scan, on the stack: as many as SightHistory keeps.
  static constexpr std::size_t kMostScans = 128;
  template <class Number>
  using PerScan = std::array<Number, kMostScans>;
  struct Kept {
    double stamp;
    const SightImage* image;
    double turn_lasted;  ///< where it is its turn's last one here; else 0 [s]
  };
  /// sensor_from_points of every image, number by number: a point is placed in all of them together.
  struct Placements {
    std::array<std::array<PerScan<float>, 3>, 3> rotation;  ///< by row, then column
    std::array<PerScan<float>, 3> translation;              ///< [m]
  };
  /// Where a point lies in the images, as SightPixels::Pixel.
  struct Pixels {
    PerScan<std::int32_t> valid, column, row;
    PerScan<float> range;  ///< [m]
  };

  void add(double stamp, const ImageSight& sight);
  void place(const Eigen::Vector3f& point, std::size_t count, Pixels& pixels) const;

  PerScan<Kept> kept_;  ///< newest first
  Placements placements_;
  std::size_t count_ = 0;
  float margin_ = 0.0F;  ///< [m]
  bool is_careful_ = true;
  CertaintyOptions certainty_;
};

/// Free evidence (algorithm: "Free evidence"): "never hit before" is not "was free before".
/// It is asked only of voxels that are newly hit, so what a sensor saw in a turn is kept as an image, nothing more.
/// Parts of a turn enter one image: they count as one look.
class SightHistory {
 public:
  /// Keeps turns of the last `length` [s], at most one every `spacing` [s], and never more than SightView holds.
  SightHistory(double length, double spacing, float margin, const SightImage::Reading& reading)
      : length_(length), spacing_(spacing), margin_(margin), reading_(reading) {}

  /// A cloud arrives; draw() and keep(), or add(), follow. Stamps never run backwards.
  TurnPart arrive(const Scan& scan, const std::vector<std::uint8_t>& is_echo,
                  const Workers& workers = Workers::alone());
  /// The directions of the cloud that arrived last.
  const SightPixels& newest() const { return pixels_; }
  const Turns& turns() const { return turns_; }
  /// Of the sensor whose cloud arrived last, from its newest turn that is over; none before.
  std::optional<MeasuredSensor> measured() const;
  /// Tangent of the angle between beams above one another, of the same sensor; 0 before.
  double beamsApart() const;
  /// Takes what the cloud saw that arrived last. Turns before the present one may be asked at the same time.
  void draw(const Scan& scan, const std::vector<std::uint8_t>& is_echo);
  /// From now on what was drawn is asked, too. Views made before are no longer valid.
  void keep();
  void add(const Scan& scan, const std::vector<std::uint8_t>& is_echo) {
    draw(scan, is_echo);
    keep();
  }

  /// What the turns before the present one saw; to be asked in points whose frame lies in the odometry's like this.
  SightView seenBefore(const Eigen::Isometry3d& odom_from_points) const;
  /// The same, with the present turn as far as it has come.
  SightView seenFrom(const Eigen::Isometry3d& odom_from_points) const;
  /// What was seen last in each direction, by the newest cloud's sensor where that looked.
  ScanSight newestSeenFrom(const Eigen::Isometry3d& odom_from_points) const;

  bool empty() const { return kept_.empty(); }
  void reset();
  std::size_t memoryBytes() const;
  /// What memoryBytes will be with a sensor of as many scans as are kept, of so many echoes [bytes].
  static double bytesFor(double length, double spacing, double echoes);

 private:
  struct Kept {
    double stamp;  ///< when its turn began [s]
    std::uint32_t turn;
    Eigen::Isometry3d base_from_sensor, sensor_from_odom;
    SightImage image;
  };

  void beginTurn(double stamp);
  SightImage::Reading readingOfNewest() const;
  const SightImage* newestMeasured() const;
  void forget(double until);
  void keepNoMoreThanAViewHolds();
  Kept& imageFor(const Scan& scan);
  SightImage newImage();
  SightView view(std::size_t newest, const Eigen::Isometry3d& odom_from_points) const;
  /// Images of turns before the present one.
  std::size_t countBefore() const;
  ImageSight sightOf(const Kept& kept, const Eigen::Isometry3d& odom_from_points) const {
    return {&kept.image, (kept.sensor_from_odom * odom_from_points).cast<float>()};
  }

  double length_, spacing_;
  float margin_;
  SightImage::Reading reading_;
  Turns turns_;
  SightPixels pixels_;    ///< of the newest cloud
  SightPixels in_image_;  ///< of a part that was not seen from where its turn's image is
  SightImage::Workspace workspace_;
  Eigen::Isometry3d newest_mounting_ = Eigen::Isometry3d::Identity();
  std::uint32_t turn_ = 0;    ///< of those that are kept
  double turn_began_ = 0.0;   ///< [s]
  double turn_lasted_ = 0.0;  ///< the one before, until this one began [s]
  bool keeps_turn_ = false;
  std::vector<Kept> kept_;          ///< oldest first
  std::optional<Kept> drawn_;       ///< an image that the present cloud began
  std::vector<SightImage> spares_;  ///< storage for the next images
};

}  // namespace donex
