#include "bag/label_bag.h"

#include <algorithm>
#include <exception>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>

#include <fmt/format.h>
#include <rosbag/view.h>
#include <tf2_msgs/TFMessage.h>

#include "bag/bag_cloud.h"
#include "bag/bag_file.h"
#include "bag/checked_message.h"
#include "bag/ground_truth.h"
#include "bag/topics.h"
#include "core/motion/odometry_calibration.h"
#include "donex/whole_drive.h"
#include "io/sequence.h"
#include "ros/odometry_monitor.h"

namespace donex {
namespace fs = std::filesystem;
namespace {

using Bags = std::vector<std::unique_ptr<rosbag::Bag>>;

/// Feeds a bag's messages to the pipeline as the node gets them, and hands on what comes out.
class Labeler {
 public:
  Labeler(const LabelBagOptions& options, const LabelBagSink& sink, LabelBagSummary& summary,
          std::shared_ptr<Detector> detector)
      : sink_(sink),
        summary_(summary),
        calibrates_(options.calibrate),
        pipeline_(options.config, tf_, events(), std::move(detector)) {
    if (isChecked(options.config.motion, options.config.motion.source))
      check_.emplace(options.config.motion, options.calibrate);
  }

  void beginPart(std::size_t part) { part_ = part; }
  void add(const rosbag::MessageInstance& message);
  void finish();
  /// Throws what the sink has thrown: the pipeline takes that for a cloud that cannot be labelled, and goes on.
  void requireSink() const {
    if (sink_fault_) std::rethrow_exception(sink_fault_);
  }

 private:
  PipelineEvents events();
  void take(const LabeledScan& scan);
  std::size_t scansBefore(double stamp);
  void remark(const std::string& kind, const std::string& text);
  void addTransforms(const rosbag::MessageInstance& message, bool are_static);
  void feed(const rosbag::MessageInstance& message);

  const LabelBagSink& sink_;
  LabelBagSummary& summary_;
  std::set<std::string> remarked_;
  ros::Time now_;
  std::size_t part_ = 0;
  double first_stamp_ = 0.0;  // [s]
  std::exception_ptr sink_fault_;
  struct Mounting {
    Eigen::Isometry3d base_from_sensor = Eigen::Isometry3d::Identity();
    std::string base_frame, sensor_frame;
  };
  Mounting mounting_;  // of the sensor that is checked
  bool calibrates_;
  OneSensor checked_sensor_;
  std::optional<LabeledScanCheck> check_;
  tf2::BufferCore tf_;
  Pipeline pipeline_;  // last: it uses the others
};

PipelineEvents Labeler::events() {
  const auto as = [this](const char* kind) { return [this, kind](const std::string& text) { remark(kind, text); }; };
  PipelineEvents events;
  events.labeled = [this](const LabeledScan& scan) { take(scan); };
  events.dropped = [this](DropReason reason, const std::string& text) {
    remark(fmt::format("clouds dropped, {}", describe(reason)), text);
  };
  events.refused = [this](OdometryRefusal reason, const std::string& text) {
    remark(fmt::format("odometry refused, {}", describe(reason)), text);
  };
  events.forgotten = as("grid forgotten");
  events.flooded = [this](const std::string& text) {
    remark("alarm", text + (check_ ? ", " + describe(check_->finding()) : ""));
  };
  events.strange_origin = as("origin of the clouds");
  events.unit_found = as("echo times");
  events.reading_found = as("meaning of the echo times");
  events.not_deskewed = as("clouds de-skewed by");
  events.remarked = [this](CloudRemark kind, const std::string& text) { remark(describe(kind), text); };
  events.sensor_measured = [this](const std::string& text) { summary_.sensor = text; };
  events.odometry_completed = as("ego motion");
  events.strange_times = as("clouds not de-skewed");
  return events;
}

void Labeler::remark(const std::string& kind, const std::string& text) {
  if (remarked_.insert(kind).second) summary_.remarks.push_back(kind + ", first: " + text);
}

void Labeler::take(const LabeledScan& scan) {
  summary_.times.push_back(scan.processing_time);
  summary_.echoes += scan.labels.dynamic.size();
  if (checked_sensor_.isIt(scan.cloud->header.frame_id)) {
    if (check_) check_->check(LabeledScanCheck::questionOf(scan));
    mounting_ = {scan.motion.base_from_sensor, scan.motion.base_frame, scan.cloud->header.frame_id};
  }
  const auto truth = truthOf(*scan.cloud, scan.layout);
  if (!truth.empty()) {
    summary_.evaluation.add(scansBefore(scan.scan.stamp), scan.scan.echoes, truth, asSemanticKitti(scan.labels));
  }
  try {
    if (!sink_fault_) sink_(scan, now_, part_);
  } catch (...) {
    sink_fault_ = std::current_exception();
  }
}

/// Whole scans at 10 Hz, for the warm-up: parts of turns, and several sensors' clouds, are as many as their time says.
std::size_t Labeler::scansBefore(double stamp) {
  constexpr double kScan = 0.1;     // [s]
  constexpr double kJitter = 0.05;  // of a scan: stamps that come a little early
  if (summary_.times.size() == 1) first_stamp_ = stamp;
  const double scans = std::max(0.0, (stamp - first_stamp_) / kScan + kJitter);
  return std::min(summary_.times.size() - 1, static_cast<std::size_t>(scans));
}

void Labeler::addTransforms(const rosbag::MessageInstance& message, bool are_static) {
  const auto parsed = parse<tf2_msgs::TFMessage>(message);
  for (const auto& transform : parsed->transforms) tf_.setTransform(transform, "bag", are_static);
}

void Labeler::feed(const rosbag::MessageInstance& message) {
  const std::string topic = absoluteTopic(message.getTopic());
  if (topic == absoluteTopic(summary_.points)) {
    pipeline_.addCloud(parseCloud(message), now_.toSec());
  } else if (!summary_.odom.empty() && topic == absoluteTopic(summary_.odom)) {
    pipeline_.addOdometry(*parse<nav_msgs::Odometry>(message));
  } else if (topic == "/tf" || topic == "/tf_static") {
    addTransforms(message, topic == "/tf_static");
  }
}

void Labeler::add(const rosbag::MessageInstance& message) {
  now_ = message.getTime();
  ++summary_.messages;
  feed(message);
  while (pipeline_.step(now_.toSec())) {
  }
  requireSink();
}

void Labeler::finish() {
  pipeline_.finish();
  requireSink();
  summary_.counts = pipeline_.counts();
  if (!check_) return;
  summary_.check = summaryOf(check_->finding());
  if (!calibrates_) return;
  const OdometryCalibration calibration = calibrate(check_->details().scans(), ComparisonWindow());
  summary_.calibration =
      describe(calibration, mounting_.base_from_sensor, mounting_.base_frame, mounting_.sensor_frame);
}

std::string remarksOf(const LabelBagSummary& summary) {
  std::string text;
  for (const std::string& remark : summary.remarks) text += "\n  " + remark;
  return text;
}

void requireLabels(const LabelBagSummary& summary, const std::string& file) {
  if (summary.counts.clouds_labeled > 0) return;
  throw DataError(fmt::format("{}: none of the {} clouds on {} could be labelled{}", file, summary.counts.clouds_in,
                              summary.points, remarksOf(summary)));
}

/// Why odometry_source auto takes it, and what to set otherwise.
std::string whyOf(OdometrySource source, const std::string& frames) {
  switch (source) {
    case OdometrySource::kPose: return " (chosen: the bag holds odometry; otherwise set odometry_source)";
    case OdometrySource::kTf:
      return " (chosen: the bag holds no nav_msgs/Odometry, its tf knows these frames; otherwise set odometry_source)";
    default:
      return fmt::format(
          " (chosen: the bag holds no nav_msgs/Odometry, and its tf does not know {}; otherwise set fixed_frame and "
          "base_frame, or odometry_source)",
          frames);
  }
}

std::string motionOf(OdometrySource source, const std::string& odom, const MotionConfig& config) {
  switch (source) {
    case OdometrySource::kPose: return "poses of odometry on " + odom;
    case OdometrySource::kTwist: return "velocities of odometry on " + odom;
    case OdometrySource::kTf: return fmt::format("tf, {} in {}", config.base_frame, config.fixed_frame);
    case OdometrySource::kNone: return "none, the sensor is at rest";
    default: return "found in the clouds";
  }
}

LabelBagSummary chooseTopics(rosbag::View& view, const LabelBagOptions& options, const std::string& file) {
  LabelBagSummary summary;
  summary.points = chooseTopic(view, options.points, cloudTypes(), file, "--points");
  const OdometrySource source = options.config.motion.source;
  if (usesOdometry(source)) summary.odom = chooseTopic(view, options.odom, {"nav_msgs/Odometry"}, file, "--odom");
  summary.motion = motionOf(source, summary.odom, options.config.motion);
  return summary;
}

/// Whether a bag's tf tells where the vehicle is, judged by the first of it.
bool tellsMotionByTf(const Bags& bags, const MotionConfig& config) {
  constexpr std::size_t kSome = 3000;  // messages; at 50 Hz from two sources half a minute
  tf2::BufferCore tf;
  std::size_t read = 0;
  rosbag::View view;
  for (const auto& bag : bags)
    view.addQuery(*bag, rosbag::TopicQuery(std::vector<std::string>{"/tf", "/tf_static", "tf", "tf_static"}));
  for (const rosbag::MessageInstance& message : view) {
    const bool is_static = absoluteTopic(message.getTopic()) == "/tf_static";
    const auto parsed = parse<tf2_msgs::TFMessage>(message);
    for (const auto& transform : parsed->transforms) tf.setTransform(transform, "bag", is_static);
    if (tf.canTransform(config.fixed_frame, config.base_frame, ros::Time(0))) return true;
    if (++read >= kSome) break;
  }
  return false;
}

/// odometry_source auto: odometry where there is a topic of it, else tf, else the clouds.
LabelBagOptions chosenMotion(const LabelBagOptions& options, rosbag::View& view, const Bags& bags) {
  LabelBagOptions chosen = options;
  OdometrySource& source = chosen.config.motion.source;
  if (source != OdometrySource::kAuto) return chosen;
  const bool has_odometry = !options.odom.empty() || hasTopicOf(view, "nav_msgs/Odometry");
  if (has_odometry) {
    source = OdometrySource::kPose;
  } else {
    source = tellsMotionByTf(bags, chosen.config.motion) ? OdometrySource::kTf : OdometrySource::kLidar;
  }
  return chosen;
}

LabelBagSummary explained(LabelBagSummary summary, const LabelBagOptions& asked, const LabelBagOptions& chosen) {
  const MotionConfig& motion = chosen.config.motion;
  const bool is_chosen = asked.config.motion.source != motion.source;
  if (is_chosen) summary.motion += whyOf(motion.source, motion.base_frame + " in " + motion.fixed_frame);
  return summary;
}

/// The parts of a recording, open.
class Recording {
 public:
  explicit Recording(const BagParts& files) : files_(files) {
    for (const fs::path& file : files) {
      openBag(file, *bags_.emplace_back(std::make_unique<rosbag::Bag>()));
      all_.addQuery(*bags_.back());
      views_.push_back(std::make_unique<rosbag::View>(*bags_.back()));
      if (views_.size() > 1) requireSuccessor(views_.size() - 1);
    }
  }

  std::size_t parts() const { return bags_.size(); }
  const Bags& bags() const { return bags_; }
  rosbag::View& part(std::size_t i) { return *views_[i]; }
  rosbag::View& all() { return all_; }
  std::string name(std::size_t part = 0) const { return files_[part].string(); }

 private:
  void requireSuccessor(std::size_t part) {
    constexpr double kOverlap = 1.0, kGap = 10.0;  // [s] what a recorder splits has neither
    if (views_[part]->size() == 0 || views_[part - 1]->size() == 0) return;
    const double gap = (views_[part]->getBeginTime() - views_[part - 1]->getEndTime()).toSec();
    if (gap >= -kOverlap && gap <= kGap) return;
    throw DataError(fmt::format("{}: begins {:.1f} s after {} ends: they are no parts of one recording", name(part),
                                gap, name(part - 1)));
  }

  BagParts files_;
  Bags bags_;
  std::vector<std::unique_ptr<rosbag::View>> views_;
  rosbag::View all_;
};

/// One time through the recording. Throws DataError that tells where, and what the sink throws as it is.
void pass(Recording& recording, Labeler& labeler, LabelBagSummary& summary, const std::function<void()>& progress) {
  std::size_t part = 0;
  try {
    for (; part < recording.parts(); ++part) {
      labeler.beginPart(part);
      for (const rosbag::MessageInstance& message : recording.part(part)) {
        labeler.add(message);
        progress();
      }
    }
    labeler.finish();
  } catch (const std::exception& error) {
    labeler.requireSink();
    throw DataError(fmt::format("{}: after {} messages: {}", recording.name(std::min(part, recording.parts() - 1)),
                                summary.messages, error.what()));
  }
}

LabelBagSummary judge(Recording& recording, const LabelBagOptions& options, const LabelBagSink& sink,
                      const LabelBagProgress& progress) {
  LabelBagSummary topics = chooseTopics(recording.all(), options, recording.name());
  const std::size_t messages = recording.all().size();
  if (messages != 0) topics.duration = (recording.all().getEndTime() - recording.all().getBeginTime()).toSec();
  std::shared_ptr<WholeDriveDetector> whole;
  if (needsWholeDrive(options.config.method)) whole = makeWholeDriveDetector(options.config);
  const std::size_t passes = whole == nullptr ? 1U : static_cast<std::size_t>(whole->passes());
  const LabelBagSink no_sink = [](const LabeledScan&, const ros::Time&, std::size_t) {};
  LabelBagSummary summary;
  std::size_t done = 0;
  do {
    summary = topics;
    const bool counts = whole == nullptr || whole->isLastPass();
    std::shared_ptr<Detector> detector = whole;
    if (detector == nullptr) detector = makeDetector(options.config);
    Labeler labeler(options, counts ? sink : no_sink, summary, detector);
    pass(recording, labeler, summary, [&] { progress(++done, passes * messages); });
  } while (whole != nullptr && whole->nextPass());
  requireLabels(summary, recording.name());
  return summary;
}

}  // namespace

LabelBagSummary judgeBag(const BagParts& in, const LabelBagOptions& options, const LabelBagSink& sink,
                         const LabelBagProgress& progress) {
  Recording recording(in);
  const LabelBagOptions chosen = chosenMotion(options, recording.all(), recording.bags());
  return explained(judge(recording, chosen, sink, progress), options, chosen);
}

LabelBagSummary labelBag(const BagParts& in, const BagParts& out, const LabelBagOptions& options,
                         const LabelBagProgress& progress) {
  if (in.empty() || in.size() != out.size()) throw std::invalid_argument("a bag has no output, or an output no bag");
  Recording recording(in);  // faults before the first copy
  requireNewTopic(recording.all(), options.labeled, recording.name());
  const LabelBagOptions chosen = chosenMotion(options, recording.all(), recording.bags());
  chooseTopics(recording.all(), chosen, recording.name());
  const std::string topic = absoluteTopic(options.labeled);
  std::size_t writing = 0;
  auto writer = std::make_unique<BagWriter>(out[0], in[0]);
  const auto advance = [&](std::size_t part) {
    while (writing < part) {
      writer->commit();
      ++writing;
      writer = std::make_unique<BagWriter>(out[writing], in[writing]);
    }
  };
  const auto write = [&](const LabeledScan& scan, const ros::Time& now, std::size_t part) {
    advance(part);
    writer->write(topic, now, *labelCloud(*scan.cloud, scan.layout, scan.labels));
  };
  LabelBagSummary summary = judge(recording, chosen, write, progress);
  advance(out.size() - 1);
  writer->commit();
  return explained(std::move(summary), options, chosen);
}

}  // namespace donex
