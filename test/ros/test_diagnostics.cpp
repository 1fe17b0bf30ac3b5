// What /diagnostics says: the level that the status line has, and the figures an engineer asks for first.
#include <cmath>
#include <cstdlib>
#include <optional>

#include "ros/diagnostics.h"
#include "ros/manager_rig.h"

namespace donex {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using test::waitFor;

/// A pipeline and its diagnostics, without a node around them.
class DiagnosticsTest : public testing::Test {
 protected:
  DiagnosticsTest() {
    tf_.setTransform(test::transformAt(0.0, "base_link", "lidar", 0.0, 1.7), "test", true);
    subscriber_ = nh_.subscribe("/diagnostics", 50, &DiagnosticsTest::onDiagnostics, this);
    EXPECT_TRUE(waitFor([this] { return subscriber_.getNumPublishers() == 1; }));
  }

  /// What is told now.
  const DiagnosticStatus& tellNow() {
    told_.reset();
    diagnostics_.publish();
    EXPECT_TRUE(waitFor([this] { return told_.has_value(); }));
    if (!told_) told_.emplace();
    return *told_;
  }
  void odometry(double stamp) {
    diagnostics_.odometryArrived(ros::Time(stamp));
    pipeline_.addOdometry(test::odometryAt(stamp));
  }
  void cloud(double stamp) {
    diagnostics_.cloudArrived(ros::Time(stamp));
    pipeline_.addCloud(test::plainCloud(test::ring(), stamp), stamp);
    pipeline_.step(stamp);
  }
  void scan() {
    now_ += 0.1;
    odometry(now_);
    cloud(now_);
  }
  std::string valueOf(const std::string& key) const {
    for (const auto& value : told_->values) {
      if (value.key == key) return value.value;
    }
    ADD_FAILURE() << "nothing is told of '" << key << "'";
    return "";
  }
  /// NaN unless all of the text is a number.
  double numberOf(const std::string& key) const {
    const std::string text = valueOf(key);
    char* end = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    return text.empty() || *end != '\0' ? std::nan("") : number;
  }

  double now_ = 100.0;  // [s]
  ros::NodeHandle nh_, pnh_{"~"};
  tf2::BufferCore tf_;
  Pipeline pipeline_{test::smallConfig(), tf_, events()};
  Diagnostics diagnostics_{nh_, pnh_, pipeline_, true};

 private:
  PipelineEvents events() {
    PipelineEvents events;
    events.labeled = [this](const LabeledScan& scan) { diagnostics_.scanPublished(scan); };
    events.dropped = [this](DropReason reason, const std::string& text) { diagnostics_.dropped(reason, text); };
    events.refused = [this](OdometryRefusal, const std::string& text) { diagnostics_.refused(text); };
    events.forgotten = [](const std::string&) {};
    events.strange_times = [this](const std::string& text) { diagnostics_.strangeTimes(text); };
    return events;
  }
  void onDiagnostics(const diagnostic_msgs::DiagnosticArrayConstPtr& array) {
    for (const DiagnosticStatus& status : array->status) {
      const bool is_ours = status.name == ros::this_node::getName().substr(1) + ": classifier";
      const bool is_first = status.message == "Node starting up";  // diagnostic_updater's own
      if (is_ours && !is_first) told_ = status;
    }
  }

  std::optional<DiagnosticStatus> told_;
  ros::Subscriber subscriber_;
};

TEST_F(DiagnosticsTest, TheLevelIsThatOfTheStatusLine) {
  EXPECT_EQ(tellNow().level, DiagnosticStatus::WARN);
  EXPECT_EQ(tellNow().message, "WARN: no clouds yet, no odometry yet");

  // A machine that stalls for a second makes that a WARN: the next scan makes it good.
  DiagnosticStatus status;
  EXPECT_TRUE(waitFor([&] {
    scan();
    status = tellNow();
    return status.level == DiagnosticStatus::OK;
  })) << status.message;
  EXPECT_EQ(status.message.substr(0, 3), "OK:");

  diagnostics_.failed("labelling: bad_alloc");
  status = tellNow();
  EXPECT_EQ(status.level, DiagnosticStatus::ERROR);
  EXPECT_EQ(status.message, "ERROR: labelling: bad_alloc");
  EXPECT_NE(tellNow().level, DiagnosticStatus::ERROR) << "told once";

  cloud(now_ - 50.0);  // older than all that is labelled, alone: dropped with the next one
  scan();
  status = tellNow();
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_NE(status.message.find("1 scan dropped (out of order)"), std::string::npos) << status.message;
}

TEST_F(DiagnosticsTest, KeyFiguresAreNumbers) {
  for (int i = 0; i < 5; ++i) scan();
  cloud(now_ + 0.3);  // waits for its odometry
  tellNow();
  for (const auto* key : {"clouds in [Hz]", "clouds labelled [Hz]", "odometry in [Hz]", "time a scan, median [ms]",
                          "time a scan, p99 [ms]", "latency in to out, median [ms]", "latency in to out, p99 [ms]",
                          "latency last echo to labels, median [ms]", "latency last echo to labels, p99 [ms]",
                          "memory of the grid [MB]", "memory of the process [MB]"}) {
    EXPECT_GT(numberOf(key), 0.0) << key << ": " << valueOf(key);
  }
  EXPECT_NEAR(numberOf("odometry behind the clouds [s]"), 0.3, 1e-3);
  EXPECT_GE(numberOf("time a scan, p99 [ms]"), numberOf("time a scan, median [ms]"));
  EXPECT_GE(numberOf("memory of the process [MB]"), numberOf("memory of the grid [MB]"));
  EXPECT_EQ(valueOf("the sensor"), "not measured") << "it has a single ring";
  EXPECT_EQ(numberOf("clouds in"), 6.0);
  EXPECT_EQ(numberOf("clouds labelled"), 5.0);
  EXPECT_EQ(numberOf("clouds waiting"), 1.0);
  EXPECT_EQ(numberOf("clouds dropped"), 0.0);
  EXPECT_EQ(numberOf("internal errors"), 0.0);
}

}  // namespace
}  // namespace donex

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "diagnostics_test");
  ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
