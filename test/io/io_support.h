// Small sequences on disk for the tests.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>

#include "donex/io/sequence.h"

namespace donex::test {

/// A new directory, removed at the end.
class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    std::string name = (std::filesystem::temp_directory_path() / "donex_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary directory");
    path_ = name;
  }
  ~TemporaryDirectory() { std::filesystem::remove_all(path_); }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline void writeText(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  if (!stream) throw std::runtime_error("cannot write " + file.string());
}

inline std::string readText(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

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
