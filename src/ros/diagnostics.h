// One plain status on /diagnostics, driven by a wall clock so that silence shows, too.
#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include "core/motion/odometry_check.h"
#include "ros/health.h"
#include "ros/pipeline.h"

namespace donex {

class Diagnostics {
 public:
  using Clock = std::chrono::steady_clock;

  Diagnostics(const ros::NodeHandle& nh, const ros::NodeHandle& pnh, const Pipeline& pipeline, bool needs_odometry);

  void cloudArrived(const ros::Time& stamp);
  void odometryArrived(const ros::Time& stamp);
  void scanPublished(const LabeledScan& scan);
  void dropped(DropReason reason, const std::string& text);
  /// From any thread.
  void odometryChecked(const OdometryFinding& finding);
  void strangeTimes(const std::string& text) { last_strange_times_ = text; }
  /// Of the check, fit to be appended: "odometry agrees with the scans within ...", or that it is not checked.
  std::string odometryText() const;
  void flooded(const std::string& text) { last_flood_ = text; }
  void strangeOrigin(const std::string& text) { strange_origin_ = text; }
  void unitFound(const std::string& text) { found_unit_ = text; }
  void refused(const std::string& text) { last_refusal_ = text; }
  void failed(const std::string& text) {
    ++failures_;
    last_failure_ = text;
  }

  /// Publishes; called about once a second.
  void publish() { updater_.force_update(); }

 private:
  struct Figures {
    Clock::time_point published;
    double processing, latency;  // [s]
    double since_last_echo;      // by the clock of the stamps [s]
  };
  using Times = std::deque<Clock::time_point>;

  double publishedRate() const;     // [Hz]
  double medianProcessing() const;  // [s]
  Health health() const;

  void report(diagnostic_updater::DiagnosticStatusWrapper& status);
  void addLine(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void addFigures(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void addCounts(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void addCheck(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  std::optional<OdometryFinding> checked() const;

  const Pipeline& pipeline_;
  diagnostic_updater::Updater updater_;
  bool needs_odometry_;
  Times arrivals_, odometry_arrivals_, drops_;  // of the last seconds
  std::deque<Figures> published_;               // of the last seconds
  std::optional<Clock::time_point> last_cloud_, last_odometry_;
  ros::Time newest_cloud_, newest_odometry_;  // stamps
  std::size_t failures_ = 0, failures_reported_ = 0;
  DropReason last_reason_ = DropReason::kInternalError;
  mutable std::mutex checked_mutex_;
  std::optional<OdometryFinding> checked_;  // odometry against the scans; empty where that is not asked
  std::string tracking_;                    // empty where the ego motion is not found in the clouds
  std::string last_drop_, last_refusal_, last_failure_, last_strange_times_, strange_origin_, last_flood_, found_unit_;
};

}  // namespace donex
