// Clouds that are parts of a turn, and several sensors on one topic: some twice, some lost, some by another clock.
#include "ros/faults_rig.h"

namespace donex {
namespace {

using test::FaultsTest;
using test::waitFor;

class FaultsOfParts : public FaultsTest {
 protected:
  static constexpr std::size_t kParts = 10;  // per turn

  void sendFrom(const std::string& frame, double stamp, const std::vector<Eigen::Vector3f>& echoes = test::ring()) {
    ++clouds_sent_;
    clouds_.publish(test::plainCloud(echoes, stamp, frame));
  }
  /// One of so many parts of a turn that ends now.
  void sendPart(std::size_t part, std::size_t parts = kParts) {
    constexpr std::size_t kEchoes = 100;
    const auto turn = test::ring(kEchoes * parts);
    const auto first = turn.begin() + static_cast<std::ptrdiff_t>(kEchoes * part);
    const double stamp = now_ - kPeriod + kPeriod * static_cast<double>(part + 1) / static_cast<double>(parts);
    sendFrom("lidar", stamp, {first, first + kEchoes});
  }
  /// A second sensor, 1 m before the vehicle's origin.
  void mountAnother() { transforms_.sendTransform(test::transformAt(0.0, "base_link", "front", 1.0, 0.8)); }
  void expectLabeled(std::size_t clouds) { ASSERT_TRUE(waitForLabeled(clouds)) << status_; }
};

TEST_F(FaultsOfParts, Twice) {
  load();
  sendOdometry(now_);
  for (int turn = 0; turn < 5; ++turn) {
    advance();
    sendOdometry(now_);
    for (std::size_t part = 0; part < kParts; ++part) {
      for (int time = 0; time < 2; ++time) sendPart(part);
    }
    expectLabeled(kParts * static_cast<std::size_t>(turn + 1));
  }
  EXPECT_EQ(received_.size(), 5 * kParts);
  conclude("ten parts per turn, each twice", "every part labelled, once");
}

TEST_F(FaultsOfParts, Lost) {
  load();
  sendOdometry(now_);
  std::size_t sent = 0;
  for (std::size_t turn = 0; turn < 8; ++turn) {
    advance();
    sendOdometry(now_);
    for (std::size_t part = 0; part < kParts; ++part) {
      const bool is_lost = (3 * turn + 7 * part) % 4 == 0 || turn == 5;
      if (is_lost) continue;
      sendPart(part);
      ++sent;
    }
    expectLabeled(sent);
  }
  conclude("ten parts per turn, a quarter of them and one whole turn lost", "every part that came labelled");
}

/// Some drivers publish each packet; how many may wait is learned from the turn before.
TEST_F(FaultsOfParts, PacketsBeforeTheirOdometry) {
  constexpr std::size_t kPackets = 150;
  load();
  sendOdometry(now_);
  for (std::size_t turn = 0; turn < 5; ++turn) {
    advance();
    const bool is_first = turn == 0;
    if (is_first) sendOdometry(now_);
    for (std::size_t packet = 0; packet < kPackets; ++packet) {
      sendPart(packet, kPackets);
      if (is_first) expectLabeled(packet + 1);
    }
    ASSERT_TRUE(waitForDiagnostic("clouds in", std::to_string(clouds_sent_))) << status_;
    if (!is_first) sendOdometry(now_);
    expectLabeled(kPackets * (turn + 1));
  }
  conclude("150 clouds per turn, each turn before its odometry", "every cloud labelled");
}

TEST_F(FaultsOfParts, ASensorFallsSilent) {
  mountAnother();
  load();
  std::size_t sent = 0;
  for (int scan = 0; scan < 45; ++scan) {
    advance();
    sendOdometry(now_);
    sendFrom("lidar", now_);
    ++sent;
    const bool is_silent = scan >= 5 && scan < 35;
    if (!is_silent) sendFrom("front", now_);
    sent += is_silent ? 0U : 1U;
    expectLabeled(sent);
  }
  conclude("two sensors with the same stamps, one of them silent for 3 s", "every cloud labelled");
}

TEST_F(FaultsOfParts, SensorsComeNewestFirst) {
  mountAnother();
  transforms_.sendTransform(test::transformAt(0.0, "base_link", "rear", -1.0, 0.8));
  load();
  sendOdometry(now_);
  for (std::size_t scan = 1; scan <= 10; ++scan) {
    advance();
    sendOdometry(now_);
    sendFrom("lidar", now_);
    sendFrom("front", now_ - 0.03);
    sendFrom("rear", now_ - 0.06);
    expectLabeled(3 * scan);
  }
  conclude("three sensors whose clouds come newest first, 30 ms apart", "every cloud labelled");
}

TEST_F(FaultsOfParts, StampsOfTwoClocks) {
  mountAnother();
  load();
  for (std::size_t scan = 1; scan <= 20; ++scan) {
    advance();
    sendOdometry(now_);
    sendFrom("lidar", now_);
    expectLabeled(scan);
    sendFrom("front", now_ - 2.0);
  }
  conclude("two sensors, the stamps of one 2 s behind the other's", "the other's clouds labelled, how far it is said");
}

/// The clouds of the one that is left are behind all that was labelled before.
TEST_F(FaultsOfParts, TheSensorOfTheNewerClockVanishes) {
  mountAnother();
  load();
  for (std::size_t scan = 1; scan <= 30; ++scan) {
    advance();
    sendOdometry(now_);
    sendFrom("lidar", now_);
    expectLabeled(scan);
    sendFrom("front", now_ - 2.0);
  }
  for (int scan = 0; scan < 90; ++scan) {
    advance();
    sendOdometry(now_);
    sendFrom("front", now_ - 2.0);
  }
  ASSERT_TRUE(waitFor([this] { return received_.back()->header.frame_id == "front"; })) << status_;
  conclude("two sensors, the stamps of one 2 s behind; the other vanishes", "labels of the one that is left after 7 s");
}

TEST_F(FaultsOfParts, StampsOfAClockAhead) {
  mountAnother();
  load();
  for (std::size_t scan = 1; scan <= 20; ++scan) {
    advance();
    sendOdometry(now_);
    sendFrom("front", now_ + 60.0);
    sendFrom("lidar", now_);
    expectLabeled(scan);
  }
  for (int wait = 0; wait < 8; ++wait) advance();
  conclude("two sensors, the stamps of one 60 s ahead of odometry and the other", "the other's clouds labelled");
}

}  // namespace
}  // namespace donex
