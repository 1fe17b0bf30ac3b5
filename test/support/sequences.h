// Small sequences on disk for the tests.
#pragma once

#include <filesystem>
#include <random>
#include <vector>

#include "io/sequence.h"

namespace donex::test {

inline Pose randomPose(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const auto draw = [&] { return normal(random); };
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() << 100.0 * draw(), 100.0 * draw(), draw();
  pose.linear() = Eigen::Quaterniond(draw(), draw(), draw(), draw()).normalized().toRotationMatrix();
  return Pose::fromIsometry(pose);
}

/// `echoes` random echoes at time 0.1 * index.
inline SequenceScan randomScan(std::mt19937& random, std::size_t index, std::size_t echoes) {
  std::uniform_real_distribution<float> coordinate(-60.0F, 60.0F);
  SequenceScan scan;
  scan.stamp = 0.1 * static_cast<double>(index);
  scan.odom_from_sensor = randomPose(random);
  for (std::size_t i = 0; i < echoes; ++i) {
    const float x = coordinate(random);
    const float y = coordinate(random);
    scan.echoes.emplace_back(x, y, 0.1F * coordinate(random));
    scan.intensities.push_back(0.5F);
  }
  return scan;
}

/// A sound sequence of `scans` scans of ten echoes, all labelled static.
inline void writeSoundSequence(const std::filesystem::path& directory, std::size_t scans) {
  std::mt19937 random(1);
  SequenceWriter writer(directory);
  for (std::size_t i = 0; i < scans; ++i) {
    writer.add(randomScan(random, i, 10), std::vector<std::uint32_t>(10, kLabelStatic));
  }
}

}  // namespace donex::test
