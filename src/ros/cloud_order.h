// Which clouds of a topic come in time: one sensor's in order, several sensors' within a bound.
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include <sensor_msgs/PointCloud2.h>

namespace donex {

/// How a cloud comes after those before it.
enum class Arrival {
  kInTime,       ///< to be judged; perhaps a little behind another sensor's
  kDuplicate,    ///< the same cloud again, or one of a sensor whose stamps stand still
  kWentBack,     ///< older than one of the same sensor that is labelled
  kOtherClock,   ///< of a sensor that has been farther behind the others all along
  kClockIsLeft,  ///< the same, and the others are gone
};

/// Sensors are told apart by the frames of their clouds.
class CloudOrder {
 public:
  static constexpr double kBetweenSensors = 0.2;       ///< [s] behind another's: a turn's length, and the way here
  static constexpr double kLeft = 5.0;                 ///< [s] without a sensor of the first clock: it is gone
  static constexpr std::size_t kMostOfOneStamp = 256;  ///< clouds of a frame: more parts than a turn is sent in
  static constexpr std::size_t kMostSensors = 64;      ///< more frames on one topic are no sensors

  Arrival judge(const sensor_msgs::PointCloud2& cloud);
  /// Why the cloud that was judged last does not come in time, in words.
  const std::string& why() const { return why_; }

  /// The cloud will be judged.
  void admit(const sensor_msgs::PointCloud2& cloud);
  void labeled(const std_msgs::Header& header);
  const std::optional<ros::Time>& newestLabeled() const { return newest_labeled_; }

  void reset();

 private:
  struct Known {
    ros::Time stamp;
    std::size_t content;
  };
  struct Sensor {
    std::deque<Known> known;  // within kBetweenSensors
    std::optional<ros::Time> labeled;
  };

  bool isKnown(const Sensor& sensor, const sensor_msgs::PointCloud2& cloud);
  Arrival behind(const sensor_msgs::PointCloud2& cloud);

  std::map<std::string, Sensor> sensors_;
  std::optional<ros::Time> newest_labeled_;
  std::optional<ros::Time> other_since_;  // the first cloud of another clock since one came in time
  std::string why_;
};

}  // namespace donex
