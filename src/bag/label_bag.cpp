#include "donex/bag/label_bag.h"

#include <set>

#include <fmt/format.h>
#include <rosbag/view.h>
#include <tf2_msgs/TFMessage.h>

#include "donex/bag/bag_file.h"
#include "topics.h"

namespace donex {
namespace fs = std::filesystem;
namespace {

/// Feeds a bag's messages to the pipeline as the node gets them, and adds what comes out to the copy.
class Labeler {
 public:
  Labeler(const LabelBagOptions& options, rosbag::Bag& out, LabelBagSummary& summary)
      : labeled_topic_(absoluteTopic(options.labeled)),
        out_(out),
        summary_(summary),
        pipeline_(options.config, tf_, events()) {}

  void add(const rosbag::MessageInstance& message);
  void finish();

 private:
  PipelineEvents events();
  void write(const LabeledScan& scan);
  void remark(const std::string& kind, const std::string& text);
  void addTransforms(const rosbag::MessageInstance& message, bool are_static);
  void feed(const rosbag::MessageInstance& message);

  std::string labeled_topic_;
  rosbag::Bag& out_;
  LabelBagSummary& summary_;
  std::set<std::string> remarked_;
  ros::Time now_;
  tf2::BufferCore tf_;
  Pipeline pipeline_;  // last: it uses the others
};

/// The message of that type; throws where the bytes are none.
template <class Message>
typename Message::ConstPtr parse(const rosbag::MessageInstance& message) {
  try {
    const auto parsed = message.instantiate<Message>();
    if (parsed) return parsed;
  } catch (const ros::Exception& error) {
    throw DataError(fmt::format("{} at {:.9f} s: cannot be read ({})", message.getTopic(), message.getTime().toSec(),
                                error.what()));
  }
  throw DataError(fmt::format("{} at {:.9f} s: is not a {}", message.getTopic(), message.getTime().toSec(),
                              ros::message_traits::DataType<Message>::value()));
}

PipelineEvents Labeler::events() {
  PipelineEvents events;
  events.labeled = [this](const LabeledScan& scan) { write(scan); };
  events.dropped = [this](DropReason reason, const std::string& text) {
    remark(fmt::format("clouds dropped, {}", describe(reason)), text);
  };
  events.refused = [this](OdometryRefusal reason, const std::string& text) {
    remark(fmt::format("odometry refused, {}", describe(reason)), text);
  };
  events.forgotten = [this](const std::string& text) { remark("grid forgotten", text); };
  events.strange_times = [this](const std::string& text) { remark("clouds not de-skewed", text); };
  return events;
}

void Labeler::remark(const std::string& kind, const std::string& text) {
  if (remarked_.insert(kind).second) summary_.remarks.push_back(kind + ", first: " + text);
}

void Labeler::write(const LabeledScan& scan) {
  summary_.times.push_back(scan.processing_time);
  summary_.echoes += scan.labels.dynamic.size();
  out_.write(labeled_topic_, now_, *labelCloud(*scan.cloud, scan.layout, scan.labels));
}

void Labeler::addTransforms(const rosbag::MessageInstance& message, bool are_static) {
  const auto parsed = parse<tf2_msgs::TFMessage>(message);
  for (const auto& transform : parsed->transforms) tf_.setTransform(transform, "bag", are_static);
}

void Labeler::feed(const rosbag::MessageInstance& message) {
  const std::string topic = absoluteTopic(message.getTopic());
  if (topic == absoluteTopic(summary_.points)) {
    pipeline_.addCloud(parse<sensor_msgs::PointCloud2>(message), now_.toSec());
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
}

void Labeler::finish() {
  pipeline_.finish();
  summary_.counts = pipeline_.counts();
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

LabelBagSummary chooseTopics(rosbag::View& view, const LabelBagOptions& options, const std::string& file) {
  LabelBagSummary summary;
  requireNewTopic(view, options.labeled, file);
  summary.points = chooseTopic(view, options.points, "sensor_msgs/PointCloud2", file, "--points");
  const OdometrySource source = options.config.motion.source;
  const bool needs_odometry = source == OdometrySource::kPose || source == OdometrySource::kTwist;
  if (needs_odometry) summary.odom = chooseTopic(view, options.odom, "nav_msgs/Odometry", file, "--odom");
  return summary;
}

}  // namespace

LabelBagSummary labelBag(const fs::path& in, const fs::path& out, const LabelBagOptions& options,
                         const LabelBagProgress& progress) {
  rosbag::Bag input;
  openBag(in, input);
  rosbag::View view(input);
  LabelBagSummary summary = chooseTopics(view, options, in.string());
  BagWriter output(out, in);
  Labeler labeler(options, output.bag(), summary);
  try {
    for (const rosbag::MessageInstance& message : view) {
      labeler.add(message);
      progress(summary.messages, view.size());
    }
  } catch (const std::exception& error) {
    throw DataError(fmt::format("{}: after {} messages: {}", in.string(), summary.messages, error.what()));
  }
  labeler.finish();
  requireLabels(summary, in.string());
  output.commit();
  return summary;
}

}  // namespace donex
