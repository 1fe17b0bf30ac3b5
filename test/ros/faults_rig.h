// A classifier in a manager under a simulated clock, fed as a vehicle would: scan after scan, with a fault between.
#pragma once

#include <algorithm>
#include <string>

#include <dynamic_reconfigure/Reconfigure.h>
#include <rosgraph_msgs/Clock.h>
#include <std_srvs/Trigger.h>

#include "ros/fault_table.h"
#include "ros/manager_rig.h"

namespace donex::test {

class FaultsTest : public ManagerTest {
 protected:
  FaultsTest() {
    clock_ = nh_.advertise<rosgraph_msgs::Clock>("/clock", 10);
    setClock(kBegin);
  }

  static constexpr double kBegin = 100.0;      // [s]
  static constexpr double kPeriod = 0.1;       // of the scans [s]
  static constexpr std::size_t kGood = 5;      // scans before the fault
  static constexpr std::size_t kPatience = 2;  // scans until it is as before
  static constexpr double kDropped = 10.0;     // a scan that is not labelled by then has been dropped [s]

  /// Returns when this process's clock, and so the classifier's, shows it.
  void setClock(double now) {
    now_ = now;
    ASSERT_TRUE(waitFor([&] {
      rosgraph_msgs::Clock message;
      message.clock.fromSec(now);
      clock_.publish(message);
      return std::abs(ros::Time::now().toSec() - now) < 1e-6;
    }));
  }
  /// The vehicle's next scan. A vehicle has a rhythm of its own, here six times as fast as a real one: nothing waits
  /// for it. (The classifier looks after waiting clouds by the wall clock, which the simulated one must not outrun.)
  void advance() {
    setClock(now_ + kPeriod);
    rhythm_.sleep();
  }
  void drive(std::size_t scans) {
    for (std::size_t i = 0; i < scans; ++i) {
      advance();
      send(now_);
    }
  }
  /// Good scans, each labelled.
  void driveWell(std::size_t scans = kGood) {
    const std::size_t before = received_.size();
    drive(scans);
    ASSERT_TRUE(waitForLabeled(before + scans)) << status_;
  }

  /// Good scans until one is labelled; kPatience at most.
  void recover() {
    for (std::size_t scan = 0; scan < kPatience; ++scan) {
      advance();
      send(now_);
      const bool is_labeled = waitFor([&] { return hasLabeled(now_); }, kDropped);
      if (is_labeled) return driveWell(3);
    }
    ADD_FAILURE() << "nothing is labelled two scans after the fault: " << status_;
  }
  bool hasLabeled(double stamp) const {
    return std::any_of(received_.begin(), received_.end(),
                       [&](const auto& cloud) { return std::abs(cloud->header.stamp.toSec() - stamp) < 1e-6; });
  }

  /// Waits until every cloud is accounted for, then writes the row: which drops and refusals are counted.
  void conclude(const std::string& fault, const std::string& after = "labels within 2 scans") {
    ASSERT_TRUE(waitForDiagnostic("clouds in", std::to_string(clouds_sent_)));
    ASSERT_TRUE(waitForDiagnostic("clouds waiting", "0"));
    EXPECT_EQ(std::stoul(diagnostic("clouds labelled")) + std::stoul(diagnostic("clouds dropped")), clouds_sent_);
    EXPECT_EQ(diagnostic("internal errors"), "0") << diagnostic("last internal error");
    if (HasFailure()) return;
    FaultTable::instance().add(fault, counted(), after);
  }
  /// The names of all counts that are not zero.
  std::string counted() const {
    std::string text;
    for (const auto& [key, value] : values_) {
      const bool is_reason = key.rfind("dropped: ", 0) == 0 || key.rfind("odometry refused: ", 0) == 0;
      if (is_reason && value != "0") text += (text.empty() ? "`" : ", `") + key + "`";
    }
    return text.empty() ? "nothing dropped" : text;
  }
  /// 0 where the key has not been told yet: keys of reasons appear with the first cloud that is dropped for them.
  std::size_t count(const std::string& key) {
    const std::string told = diagnostic(key);
    return told.empty() ? 0 : std::stoul(told);
  }

  void sendCloud(double stamp) {
    ++clouds_sent_;
    ManagerTest::sendCloud(stamp);
  }
  void send(double stamp) {
    sendOdometry(stamp);
    sendCloud(stamp);
  }

  double now_ = kBegin;
  std::size_t clouds_sent_ = 0;
  ros::Publisher clock_;
  ros::WallRate rhythm_{60.0};
};

}  // namespace donex::test
