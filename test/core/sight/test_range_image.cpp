// The range image, and the see-through that a z-buffer makes of it.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/sight/range_image.h"
#include "core/sight/z_buffer.h"
#include "donex/detector.h"

namespace donex {
namespace {

Eigen::Vector3f inDirection(double azimuth, double elevation, double range) {
  return Eigen::Vector3d(range * std::cos(elevation) * std::cos(azimuth),
                         range * std::cos(elevation) * std::sin(azimuth), range * std::sin(elevation))
      .cast<float>();
}

TEST(RangeImage, APixelKeepsItsNearestEcho) {
  RangeImage image({1.0, 1.0});
  EXPECT_EQ(image.rangeTowards({10.0F, 0.1F, 0.1F}), 0.0F);
  for (const float range : {20.0F, 8.0F, 12.0F}) image.add(Eigen::Vector3f(1.0F, 0.005F, 0.005F).normalized() * range);
  EXPECT_FLOAT_EQ(image.rangeTowards({1.0F, 0.01F, 0.01F}), 8.0F);
  EXPECT_EQ(image.rangeTowards({-1.0F, 0.01F, 0.01F}), 0.0F);
  image.clear();
  EXPECT_EQ(image.rangeTowards({1.0F, 0.01F, 0.01F}), 0.0F);
}

TEST(RangeImage, PixelsAreAsWideAsTheResolutionSays) {
  RangeImage image({2.0, 4.0});
  const double degree = M_PI / 180.0;
  image.add(inDirection(31.0 * degree, 2.0 * degree, 5.0));  // columns 30 to 32, rows 0 to 4 degrees
  EXPECT_NEAR(image.rangeTowards(inDirection(30.1 * degree, 0.1 * degree, 9.0)), 5.0F, 1e-5F);
  EXPECT_NEAR(image.rangeTowards(inDirection(31.9 * degree, 3.9 * degree, 9.0)), 5.0F, 1e-5F);
  EXPECT_EQ(image.rangeTowards(inDirection(29.9 * degree, 2.0 * degree, 9.0)), 0.0F);
  EXPECT_EQ(image.rangeTowards(inDirection(31.0 * degree, 4.1 * degree, 9.0)), 0.0F);
}

TEST(RangeImage, WhatHasNoDirectionIsLeftOut) {
  RangeImage image;
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
  for (const Eigen::Vector3f& p : {Eigen::Vector3f(nan, 0, 0), Eigen::Vector3f(0, 0, infinite),
                                   Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(0, 0, 3), Eigen::Vector3f(1, 0, -3)}) {
    image.add(p);
    EXPECT_EQ(image.rangeTowards(p), 0.0F) << p.transpose();
  }
}

/// A vehicle at rest, 1 m voxels; the echo lies in the middle of a voxel.
class ZBuffer : public ::testing::Test {
 protected:
  ZBuffer() : detector_(makeDetector(config())) {}

  static Config config() {
    Config config = paperConfig(Method::kDonex3dZBuffer);
    config.voxel_size = 1.0;
    config.region = {-20.0, 20.0, -20.0, 20.0, -4.0, 4.0};
    return config;
  }

  std::vector<std::uint8_t> judge(std::vector<Eigen::Vector3f> echoes) {
    Scan scan;
    scan.stamp = stamp_ += 0.1;
    scan.odom_from_base.translation() << 0.5, 0.5, 0.5;
    scan.echoes = std::move(echoes);
    EchoLabels labels;
    detector_->process(scan, labels);
    return labels.dynamic;
  }

  std::unique_ptr<Detector> detector_;
  double stamp_ = 0.0;
};

TEST_F(ZBuffer, WhatItSawThroughIsNewAgain) {
  judge({{5, 0, 0}});
  EXPECT_EQ(judge({{5, 0, 0}}), std::vector<std::uint8_t>{0});
  judge({{9, 0, 0}});  // the pixel shows a surface behind the remembered voxel
  EXPECT_EQ(judge({{5, 0, 0}}), std::vector<std::uint8_t>{1});
}

TEST_F(ZBuffer, ASurfaceBeforeItOrNoneAtAllKeepsTheShadow) {
  judge({{5, 0, 0}});
  judge({{3, 0, 0}});   // hides it
  judge({{0, 12, 0}});  // looks elsewhere
  EXPECT_EQ(judge({{5, 0, 0}}), std::vector<std::uint8_t>{0});
}

TEST_F(ZBuffer, TheNearestEchoOfAPixelCounts) {
  judge({{5, 0, 0}});
  judge({{9, 0, 0}, {3, 0, 0}});  // the traversal would forget it: one line of sight goes through
  EXPECT_EQ(judge({{5, 0, 0}}), std::vector<std::uint8_t>{0});
}

}  // namespace
}  // namespace donex
