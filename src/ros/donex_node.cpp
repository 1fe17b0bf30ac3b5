#include "ros/donex_node.h"

#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include <ros/callback_queue_interface.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/buffer.h>

#include "donex/memory_bound.h"
#include "ros/cloud_subscription.h"
#include "ros/diagnostics.h"
#include "ros/odometry_monitor.h"
#include "ros/odometry_publisher.h"
#include "ros/parameters.h"
#include "ros/pipeline.h"
#include "ros/reconfigure.h"
#include "ros/scan_publisher.h"
#include "ros/tf_subscription.h"

namespace donex {
namespace {

constexpr double kLogPeriod = 5.0;     // between messages of one kind [s]
constexpr double kCheckPeriod = 30.0;  // the same of odometry that disagrees with the scans [s]
constexpr double kRetryPeriod = 0.01;  // waiting clouds are asked about this often at least [s]

/// Between subscriptions to the clouds' topic anew, while none of them can be read [s].
constexpr double kRenewal = 5.0;

/// A queue of roscpp's that is full drops silently. Ours takes whatever comes while one scan is judged; after that scan
/// the callbacks, which only enqueue, hand all of it to the pipeline, which bounds and counts.
constexpr std::uint32_t kUnbounded = 0;

/// A call to a function as an entry of a callback queue.
class QueuedCall : public ros::CallbackInterface {
 public:
  explicit QueuedCall(std::function<void()> function) : function_(std::move(function)) {}
  CallResult call() override {
    function_();
    return Success;
  }

 private:
  std::function<void()> function_;
};

}  // namespace

class DonexNode::Implementation {
 public:
  Implementation(const ros::NodeHandle& nh, const ros::NodeHandle& pnh);
  ~Implementation();

 private:
  void onCloud(const sensor_msgs::PointCloud2ConstPtr& cloud);
  void onUnreadable(const std::string& why);
  void onOdometry(const nav_msgs::OdometryConstPtr& odometry);
  bool onReset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response);
  void onChange(const Config& config);

  PipelineEvents events();
  void publish(const LabeledScan& scan);
  void checkOdometry(const LabeledScan& scan);
  void listenToClouds();
  void renewClouds();

  /// An exception out of a callback would end the whole manager.
  template <class Function>
  void guarded(const char* where, Function&& function);
  void schedule();
  void work();
  std::uint64_t queueId() const { return reinterpret_cast<std::uint64_t>(this); }

  ros::NodeHandle nh_, pnh_;
  Config config_;
  tf2_ros::Buffer tf_;
  std::optional<TfSubscription> tf_subscription_;
  ros::WallTime clouds_since_;   // when the clouds were subscribed to, or could be read last
  bool cannot_be_read_ = false;  // none of the clouds since then
  Pipeline pipeline_;
  Diagnostics diagnostics_;
  ScanPublisher publisher_;
  OdometryPublisher odometry_publisher_;
  std::unique_ptr<OdometryMonitor> odometry_monitor_;
  std::unique_ptr<Reconfigure> reconfigure_;
  bool work_is_queued_ = false;
  double work_queued_at_ = 0.0;  // [s]

  ros::ServiceServer reset_service_;
  ros::Subscriber cloud_subscriber_, odometry_subscriber_;
  ros::WallTimer retry_timer_, diagnostics_timer_;
};

DonexNode::Implementation::Implementation(const ros::NodeHandle& nh, const ros::NodeHandle& pnh)
    : nh_(nh),
      pnh_(pnh),
      config_(readParameters(pnh)),
      pipeline_(config_, tf_, events()),
      diagnostics_(nh, pnh, pipeline_, usesOdometry(config_.motion.source)),
      publisher_(pnh),
      odometry_publisher_(pnh, config_.motion) {
  ROS_INFO_STREAM_NAMED("donex", "memory that the grid takes for scans of "
                                     << kUsualScan << " echoes: " << std::lround(memoryBound(config_, kUsualScan) / 1e6)
                                     << " MB at most (memory_limit " << config_.memory_limit << " MB)");
  // A sensor at rest needs no tf.
  const bool needs_tf = config_.motion.source != OdometrySource::kNone;
  if (needs_tf) tf_subscription_.emplace(tf_, nh_);

  reset_service_ = pnh_.advertiseService("reset", &Implementation::onReset, this);
  reconfigure_ = std::make_unique<Reconfigure>(pnh_, config_, [this](const Config& config) { onChange(config); });

  listenToClouds();
  const auto hints = ros::TransportHints().tcpNoDelay();
  odometry_subscriber_ = nh_.subscribe("odom", kUnbounded, &Implementation::onOdometry, this, hints);
  retry_timer_ = nh_.createWallTimer(ros::WallDuration(kRetryPeriod), [this](const ros::WallTimerEvent&) {
    if (pipeline_.waiting() != 0) schedule();
  });
  diagnostics_timer_ = nh_.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) {
    guarded("diagnostics", [this] { diagnostics_.publish(); });
    renewClouds();
  });
}

DonexNode::Implementation::~Implementation() {
  retry_timer_.stop();
  diagnostics_timer_.stop();
  cloud_subscriber_.shutdown();
  odometry_subscriber_.shutdown();
  reset_service_.shutdown();
  reconfigure_.reset();
  nh_.getCallbackQueue()->removeByID(queueId());
  odometry_monitor_.reset();
}

void DonexNode::Implementation::listenToClouds() {
  const CloudReceiver receiver{[this](const sensor_msgs::PointCloud2ConstPtr& cloud) { onCloud(cloud); },
                               [this](const std::string& why) { onUnreadable(why); }};
  cloud_subscriber_.shutdown();  // first: a topic with a subscriber left is not connected anew
  cloud_subscriber_ = subscribeToClouds(nh_, "points", kUnbounded, receiver);
  clouds_since_ = ros::WallTime::now();
  cannot_be_read_ = false;
}

/// A subscription keeps to the definition of its first publisher, and refuses those with the right one.
void DonexNode::Implementation::renewClouds() {
  const bool is_due = cannot_be_read_ && (ros::WallTime::now() - clouds_since_).toSec() >= kRenewal;
  if (!is_due) return;
  ROS_WARN_STREAM_NAMED("donex", "no cloud can be read: subscribing to " << cloud_subscriber_.getTopic() << " anew");
  listenToClouds();
}

template <class Function>
void DonexNode::Implementation::guarded(const char* where, Function&& function) {
  try {
    function();
  } catch (const std::exception& error) {
    const std::string text = std::string(where) + ": " + error.what();
    ROS_ERROR_STREAM_THROTTLE_NAMED(kLogPeriod, "donex", text);
    diagnostics_.failed(text);
  }
}

void DonexNode::Implementation::onCloud(const sensor_msgs::PointCloud2ConstPtr& cloud) {
  guarded("cloud", [&] {
    clouds_since_ = ros::WallTime::now();
    cannot_be_read_ = false;
    diagnostics_.cloudArrived(cloud->header.stamp);
    pipeline_.addCloud(cloud, ros::Time::now().toSec());
    schedule();
  });
}

void DonexNode::Implementation::onUnreadable(const std::string& why) {
  cannot_be_read_ = true;
  guarded("cloud", [&] { pipeline_.refuseCloud("topic " + cloud_subscriber_.getTopic() + ": " + why); });
}

void DonexNode::Implementation::onOdometry(const nav_msgs::OdometryConstPtr& odometry) {
  guarded("odometry", [&] {
    diagnostics_.odometryArrived(odometry->header.stamp);
    pipeline_.addOdometry(*odometry);
    if (pipeline_.waiting() != 0) schedule();
  });
}

bool DonexNode::Implementation::onReset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  guarded("reset", [&] {
    pipeline_.reset();
    publisher_.clearMarkers();
    response.success = true;
    response.message = "the grid is forgotten";
  });
  return true;
}

void DonexNode::Implementation::onChange(const Config& config) {
  pipeline_.configure(config);
  config_ = config;
}

void DonexNode::Implementation::schedule() {
  if (work_is_queued_) return;
  work_is_queued_ = true;
  work_queued_at_ = ros::Time::now().toSec();
  // Behind whatever has arrived: messages are taken in first, so that the pipeline can see (and count) an overload.
  nh_.getCallbackQueue()->addCallback(boost::make_shared<QueuedCall>([this] { work(); }), queueId());
}

void DonexNode::Implementation::work() {
  work_is_queued_ = false;
  guarded("labelling", [this] {
    pipeline_.watchCells(publisher_.somebodyWatchesCells());
    // Not the time it is by now: what had arrived by then is taken in, so no cloud is given up on for lack of odometry
    // that is in the queue already.
    if (pipeline_.step(work_queued_at_) && pipeline_.waiting() != 0) schedule();
  });
}

PipelineEvents DonexNode::Implementation::events() {
  PipelineEvents events;
  events.labeled = [this](const LabeledScan& scan) { publish(scan); };
  events.dropped = [this](DropReason reason, const std::string& text) {
    const std::string full = std::string(describe(reason)) + ": " + text;
    ROS_WARN_STREAM_THROTTLE_NAMED(kLogPeriod, "donex", "cloud dropped, " << full);
    diagnostics_.dropped(reason, full);
    if (reason == DropReason::kNoTransform && tf_subscription_) tf_subscription_->transformIsMissing();
  };
  events.refused = [this](OdometryRefusal refusal, const std::string& text) {
    const std::string full = std::string(describe(refusal)) + ": " + text;
    ROS_WARN_STREAM_THROTTLE_NAMED(kLogPeriod, "donex", "odometry refused, " << full);
    diagnostics_.refused(full);
  };
  events.forgotten = [](const std::string& text) { ROS_WARN_STREAM_NAMED("donex", text); };
  events.remarked = [](CloudRemark kind, const std::string& text) {
    ROS_WARN_STREAM_NAMED("donex", describe(kind) << ": " << text);
  };
  events.motion_chosen = [](const std::string& text) { ROS_INFO_STREAM_NAMED("donex", text); };
  events.sensor_measured = [](const std::string& text) { ROS_INFO_STREAM_NAMED("donex", "the sensor: " << text); };
  events.odometry_completed = [](const std::string& text) { ROS_INFO_STREAM_NAMED("donex", text); };
  events.flooded = [this](const std::string& text) {
    const std::string full = text + ", " + diagnostics_.odometryText();
    ROS_WARN_STREAM_NAMED("donex", full);
    diagnostics_.flooded(full);
  };
  events.strange_origin = [this](const std::string& text) {
    ROS_WARN_STREAM_NAMED("donex", text);
    diagnostics_.strangeOrigin(text);
  };
  events.unit_found = [this](const std::string& text) {
    ROS_WARN_STREAM_NAMED("donex", text);
    diagnostics_.unitFound(text);
  };
  events.not_deskewed = [](const std::string& text) {
    ROS_WARN_STREAM_NAMED("donex", "clouds are de-skewed by " << text);
  };
  events.reading_found = [](const std::string& text) { ROS_WARN_STREAM_NAMED("donex", text); };
  events.strange_times = [this](const std::string& text) {
    ROS_WARN_STREAM_THROTTLE_NAMED(kLogPeriod, "donex", text);
    diagnostics_.strangeTimes(text);
  };
  return events;
}

void DonexNode::Implementation::publish(const LabeledScan& scan) {
  publisher_.publishLabels(scan);
  diagnostics_.scanPublished(scan);
  odometry_publisher_.publish(scan);
  checkOdometry(scan);
  publisher_.publishTheRest(scan, config_);
}

/// The thread begins with the first scan whose motion somebody else tells: that of auto is known only then.
void DonexNode::Implementation::checkOdometry(const LabeledScan& scan) {
  if (!isChecked(config_.motion, pipeline_.motion().source())) return;
  if (odometry_monitor_ == nullptr) {
    const auto tell = [this, was = Agreement::kTooEarly](const OdometryFinding& finding) mutable {
      const bool is_new = finding.agreement != was;
      was = finding.agreement;
      if (finding.agreement == Agreement::kDisagrees) {
        ROS_WARN_STREAM_THROTTLE_NAMED(kCheckPeriod, "donex", describe(finding));
      } else if (is_new) {
        ROS_INFO_STREAM_NAMED("donex", describe(finding));
      }
      diagnostics_.odometryChecked(finding);
    };
    odometry_monitor_ = std::make_unique<OdometryMonitor>(config_.motion, tell);
  }
  odometry_monitor_->add(scan);
}

DonexNode::DonexNode(const ros::NodeHandle& nh, const ros::NodeHandle& pnh)
    : implementation_(std::make_unique<Implementation>(nh, pnh)) {}

DonexNode::~DonexNode() = default;

}  // namespace donex
