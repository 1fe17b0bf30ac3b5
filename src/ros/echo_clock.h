// What the times of a sensor's echoes are: their unit, what they count from, and what the echoes are de-skewed by.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <sensor_msgs/PointCloud2.h>

#include "core/motion/azimuth_times.h"
#include "core/motion/deskew_choice.h"
#include "donex/config.h"
#include "ros/cloud_layout.h"
#include "ros/conversions.h"
#include "ros/time_unit.h"

namespace donex {

/// Of the clouds of one frame.
class EchoClock {
 public:
  explicit EchoClock(const Config& config);

  /// Takes the clouds in the order of their arrival; true when the unit is another one than before: clouds that have
  /// been read are to be read again.
  bool observe(const sensor_msgs::PointCloud2& cloud, CloudLayout& layout);

  /// Echoes, and their times as they are to be used; these empty where nothing is to be undone.
  void read(const sensor_msgs::PointCloud2& cloud, const CloudLayout& layout, std::vector<Eigen::Vector3f>& echoes,
            EchoTimes& times);

  /// Where the sensor of the cloud that was read last was at its stamp [s]; true when its times are to be read
  /// differently from now on.
  bool follow(double stamp, const Eigen::Isometry3d& odom_from_sensor);

  /// What was found of the unit, and of what the times count from; empty where both are as usual.
  const std::string& unitFinding() const { return unit_.finding(); }
  const std::string& readingFinding() const { return reading_finding_; }

  /// "times in 'time'", or "nothing: " and why.
  const std::string& deskewedBy() const { return deskewed_by_; }
  /// Why there is nothing to de-skew by, although nobody has made a mistake that is known: once, else empty.
  std::string untoldLack();
  /// Whether the cloud that was read last carries no times.
  bool isByAzimuth() const { return is_by_azimuth_; }
  /// Whether the configured field is missing.
  bool lacksToldField() const { return state_ == State::kTold; }

  /// Poses cannot be compared with those before.
  void reset() {
    choice_.reset();
    choice_by_firings_.reset();
    choice_by_rows_.reset();
  }

 private:
  enum class State {
    kNotYet,
    kOff,
    kAtRest,
    kTold,
    kNoField,
    kNotUnderstood,
    kAlike,
    kStrange,
    kUndone,
    kTimes,
    kAzimuth
  };

  bool isAsked() const;
  bool lacksTimes(const CloudLayout& layout, const CloudLayout& used, const EchoTimes& times) const;
  void tellByAzimuth(double stamp, const CloudLayout& layout, const std::vector<Eigen::Vector3f>& echoes,
                     EchoTimes& times);
  DeskewChoice& choice() { return is_by_azimuth_ ? byAzimuth() : choice_; }
  DeskewChoice& byAzimuth() { return azimuth_times_.spin().isByFirings() ? choice_by_firings_ : choice_by_rows_; }
  const DeskewChoice& byAzimuth() const {
    return azimuth_times_.spin().isByFirings() ? choice_by_firings_ : choice_by_rows_;
  }
  State stateOf(const CloudLayout& layout, const CloudLayout& used, const EchoTimes& times) const;
  std::string describe(State state, const sensor_msgs::PointCloud2& cloud, const CloudLayout& layout,
                       const EchoTimes& times) const;
  std::string azimuth() const;
  std::string azimuthLack() const;

  MotionConfig motion_;
  std::string wanted_;  // time_field
  TimeUnit unit_;
  DeskewChoice choice_, choice_by_firings_, choice_by_rows_;
  AzimuthTimes azimuth_times_;
  bool has_order_ = false;  // of the cloud that was looked at last
  // The cloud that was read last:
  bool is_compared_ = false, is_by_azimuth_ = false;
  double first_ = 0.0, last_ = 0.0;  // its times, as they are read [s]
  std::string reading_finding_;
  int not_understood_ = 0;  // clouds in a row whose field only looks like times
  State state_ = State::kNotYet;
  std::string deskewed_by_ = "not known yet";
  State told_lack_ = State::kNotYet;
};

/// Sensors on one topic differ in what their times are; they are told apart by the frames of their clouds.
class EchoClocks {
 public:
  explicit EchoClocks(const Config& config) : config_(config) {}

  EchoClock& of(const std::string& frame);
  /// What EchoClock::deskewedBy() says; of several sensors with their frames.
  std::string deskewedBy() const;
  void reset();

 private:
  static constexpr std::size_t kMostFrames = 64;  // more on one topic are no sensors

  Config config_;
  std::map<std::string, EchoClock> clocks_;
};

}  // namespace donex
