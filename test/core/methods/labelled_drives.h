// Labels of whole drives, for the tests of the whole detector.
#pragma once

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "donex/detector.h"
#include "support/simulated_drive.h"

namespace donex::testing {

inline Config configOf(Method method) {
  Config config;
  config.method = method;
  return config;
}

inline std::vector<EchoLabels> labelsOf(Detector& detector, const std::vector<TrueScan>& drive) {
  std::vector<EchoLabels> all(drive.size());
  for (std::size_t k = 0; k < drive.size(); ++k) detector.process(drive[k].scan, all[k]);
  return all;
}

inline std::vector<EchoLabels> labelsOf(const Config& config, const std::vector<TrueScan>& drive) {
  return labelsOf(*makeDetector(config), drive);
}

inline std::size_t dynamicEchoes(const EchoLabels& labels) {
  return static_cast<std::size_t>(std::count(labels.dynamic.begin(), labels.dynamic.end(), 1));
}

inline void expectSame(const std::vector<EchoLabels>& a, const std::vector<EchoLabels>& b) {
  ASSERT_EQ(a.size(), b.size());
  std::size_t dynamic = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    ASSERT_EQ(a[k].dynamic, b[k].dynamic) << "scan " << k;
    ASSERT_EQ(a[k].observed, b[k].observed) << "scan " << k;
    dynamic += dynamicEchoes(a[k]);
  }
  EXPECT_GT(dynamic, 50U) << "nothing to compare";
}

/// A short drive that several tests share.
inline const std::vector<TrueScan>& street() {
  static const std::vector<TrueScan> drive = simulatedDrive("street", 32, 12, 2);
  return drive;
}

}  // namespace donex::testing
