// A scan that is cut into parts, and their labels put together again.
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "evaluation/scan_parts.h"

namespace donex {
namespace {

TEST(ScanParts, EveryEchoIsInOnePartInItsSector) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-40.0F, 40.0F);
  Scan scan;
  scan.stamp = 7.0;
  scan.odom_from_base = Eigen::Translation3d(1.0, 2.0, 3.0) * scan.odom_from_base;
  for (int i = 0; i < 2000; ++i) scan.echoes.emplace_back(uniform(random), uniform(random), uniform(random));
  for (const std::size_t count : {1U, 2U, 4U, 10U, 40U}) {
    ScanParts parts(count);
    parts.cut(scan, 0.1);
    std::size_t echoes = 0;
    for (std::size_t k = 0; k < count; ++k) {
      EXPECT_NEAR(parts[k].stamp, 7.0 + 0.1 * static_cast<double>(k) / static_cast<double>(count), 1e-9);
      EXPECT_TRUE(parts[k].odom_from_base.isApprox(scan.odom_from_base));
      echoes += parts[k].echoes.size();
      for (const Eigen::Vector3f& echo : parts[k].echoes) {
        const double azimuth = std::atan2(echo.y(), echo.x());
        const double turn = azimuth / (2.0 * M_PI) + (azimuth < 0.0 ? 1.0 : 0.0);
        const double sectors = static_cast<double>(count);
        EXPECT_NEAR(turn, (static_cast<double>(k) + 0.5) / sectors, 0.5001 / sectors);
      }
    }
    EXPECT_EQ(echoes, scan.echoes.size());
  }
}

TEST(ScanParts, LabelsComeBackToTheirEchoes) {
  Scan scan;
  for (int i = 0; i < 360; ++i) {
    const double angle = (i * 77 % 360 + 0.5) * M_PI / 180.0;
    scan.echoes.emplace_back(static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0.0F);
  }
  scan.echoes.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F);
  ScanParts parts(10);
  parts.cut(scan, 0.1);
  EchoLabels whole;
  whole.assign(scan.echoes.size());
  for (std::size_t k = 0; k < parts.count(); ++k) {
    EchoLabels labels;
    labels.assign(parts[k].echoes.size());
    for (std::size_t i = 0; i < labels.dynamic.size(); ++i) {
      labels.dynamic[i] = parts[k].echoes[i].y() > 0.0F ? 1 : 0;
      labels.observed[i] = std::isfinite(parts[k].echoes[i].x()) ? 1 : 0;
    }
    parts.putBack(k, labels, whole);
  }
  for (std::size_t i = 0; i < scan.echoes.size(); ++i) {
    EXPECT_EQ(whole.dynamic[i] != 0, scan.echoes[i].y() > 0.0F) << i;
    EXPECT_EQ(whole.observed[i] != 0, std::isfinite(scan.echoes[i].x())) << i;
  }
}

TEST(ScanParts, NoPartsAndTooManyAreRefused) {
  EXPECT_THROW(ScanParts(0), std::invalid_argument);
  EXPECT_THROW(ScanParts(ScanParts::kMost + 1), std::invalid_argument);
}

}  // namespace
}  // namespace donex
