// Scans that a stream must not hold are refused before they touch a memory.
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>

#include "core/methods/labelled_drives.h"
#include "core/methods/stream_guard.h"

namespace donex {
namespace {

using testing::configOf;
using testing::expectSame;
using testing::street;
using testing::TrueScan;

/// Scans that a stream must not hold; the memory is as if they had never come.
class Refusals : public ::testing::TestWithParam<std::pair<Method, bool>> {
 protected:
  Config config() const { return GetParam().second ? paperConfig(GetParam().first) : configOf(GetParam().first); }
};

TEST_P(Refusals, LeaveTheMemoryAsItWas) {
  const std::vector<TrueScan>& drive = street();
  const auto detector = makeDetector(config()), undisturbed = makeDetector(config());
  std::vector<EchoLabels> labels(drive.size()), expected(drive.size());
  for (std::size_t k = 0; k < drive.size(); ++k) {
    detector->process(drive[k].scan, labels[k]);
    undisturbed->process(drive[k].scan, expected[k]);
    const auto refuses = [&](auto spoil) {
      Scan bad = drive[k].scan;
      bad.stamp += 0.05;
      spoil(bad);
      EchoLabels unused;
      EXPECT_THROW(detector->process(bad, unused), std::invalid_argument);
    };
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    refuses([&](Scan& s) { s.stamp = std::nextafter(drive[k].scan.stamp, 0.0); });
    refuses([](Scan& s) { s.stamp -= 1.0; });
    refuses([](Scan& s) { s.stamp = kNan; });
    refuses([](Scan& s) { s.stamp = std::numeric_limits<double>::infinity(); });
    refuses([](Scan& s) { s.odom_from_base.translation().y() = kNan; });
    refuses([](Scan& s) { s.odom_from_base.translation().x() = 1e8; });
    refuses([](Scan& s) { s.odom_from_base.linear()(0, 1) = kNan; });
    refuses([](Scan& s) { s.odom_from_base.linear() *= 1.01; });
    refuses([](Scan& s) { s.odom_from_base.linear().col(1) *= -1.0; });
    refuses([](Scan& s) { s.base_from_sensor.linear().setZero(); });
    refuses([](Scan& s) { s.base_from_sensor.translation().z() = kNan; });
  }
  expectSame(labels, expected);
}

INSTANTIATE_TEST_SUITE_P(Methods, Refusals,
                         ::testing::Values(std::pair{Method::kDonex3d, false}, std::pair{Method::kDonex2d, false},
                                           std::pair{Method::kDonex3d, true}, std::pair{Method::kDonex2d, true}));

TEST(StreamGuard, SensorsMayShareAStamp) {
  StreamGuard guard;
  Scan scan;
  scan.stamp = 5.0;
  guard.admit(scan);
  EXPECT_NO_THROW(guard.admit(scan));
}

TEST(StreamGuard, AfterAResetTimeMayStartAgain) {
  StreamGuard guard;
  Scan scan;
  scan.stamp = 5.0;
  guard.admit(scan);
  scan.stamp = 1.0;
  EXPECT_THROW(guard.admit(scan), std::invalid_argument);
  guard.reset();
  EXPECT_NO_THROW(guard.admit(scan));
}

}  // namespace
}  // namespace donex
