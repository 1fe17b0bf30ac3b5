// More clouds than can be judged: the newest are labelled, no more than queue_size wait, every one is accounted for.
#include "ros/faults_rig.h"

namespace donex {
namespace {

using test::FaultsTest;
using test::waitFor;

class FaultsOfLoad : public FaultsTest {
 protected:
  /// Stamps of `count` clouds from `first` on, so close to each other that no motion lies between them [s].
  static std::vector<double> burstAfter(double first, int count) {
    std::vector<double> stamps;
    for (int i = 0; i < count; ++i) stamps.push_back(first + kWithoutOdometry + kSpacing * i);
    return stamps;
  }
  /// All at once. Their odometry is still to come: however fast the classifier is, all of them are there before it can
  /// judge one.
  void sendAtOnce(const std::vector<double>& stamps) {
    std::vector<sensor_msgs::PointCloud2ConstPtr> clouds;
    clouds.reserve(stamps.size());
    for (const double stamp : stamps) clouds.push_back(test::plainCloud(test::ring(), stamp));
    for (const auto& cloud : clouds) clouds_.publish(cloud);
    clouds_sent_ += clouds.size();
  }
  /// Latency is bounded: whatever is labelled of a burst is the newest of it, as many as may wait.
  void expectOnlyTheNewest(const std::vector<double>& stamps) {
    ASSERT_TRUE(waitFor([&] { return hasLabeled(stamps.back()); })) << "the newest wins: " << status_;
    const auto oldest = stamps.end() - NodeConfig().queue_size;
    for (auto stamp = stamps.begin(); stamp != stamps.end(); ++stamp) {
      EXPECT_EQ(hasLabeled(*stamp), stamp >= oldest) << stamp - stamps.begin() << " of " << stamps.size();
    }
  }

  static constexpr double kWithoutOdometry = 0.03;  // further than a pose is extrapolated [s]
  static constexpr double kSpacing = 1e-4;          // [s]
};

TEST_F(FaultsOfLoad, CloudsFasterThanTheyCanBeProcessed) {
  load();
  driveWell();
  const auto burst = burstAfter(now_, 80);
  sendAtOnce(burst);
  sendOdometry(burst.back());
  setClock(now_ + kPeriod);
  expectOnlyTheNewest(burst);
  recover();
  conclude("80 clouds at once: the 12 newest are labelled");
}

TEST_F(FaultsOfLoad, FiveHundredCloudsWhileOneIsJudged) {
  load();
  driveWell();
  const double big = now_ + 0.001;
  sendOdometry(big);
  ++clouds_sent_;
  clouds_.publish(test::plainCloud(test::ring(500000), big));
  const auto burst = burstAfter(big, 500);
  sendAtOnce(burst);
  sendOdometry(burst.back());
  setClock(now_ + 2.0 * kPeriod);
  expectOnlyTheNewest(burst);
  recover();
  conclude("500 clouds while one scan is judged: the 12 newest are labelled");
}

TEST_F(FaultsOfLoad, BurstAfterBurst) {
  load();
  driveWell();
  constexpr int kBursts = 4, kClouds = 40;
  const std::string most = std::to_string(NodeConfig().queue_size);
  for (int i = 0; i < kBursts; ++i) {
    const auto burst = burstAfter(now_, kClouds);
    sendAtOnce(burst);
    ASSERT_TRUE(waitForDiagnostic("clouds in", std::to_string(clouds_sent_)));
    EXPECT_EQ(diagnostic("clouds waiting"), most) << "no more are kept";
    sendOdometry(burst.back());
    ASSERT_TRUE(waitForDiagnostic("clouds waiting", "0"));
    expectOnlyTheNewest(burst);
    EXPECT_EQ(count("clouds labelled") + count("clouds dropped"), clouds_sent_);
    EXPECT_EQ(count("dropped: queue full"), count("clouds dropped"));
    setClock(now_ + kPeriod);
  }
  recover();
  conclude("4 times 40 clouds at once: no more than 12 wait");
}

}  // namespace
}  // namespace donex
