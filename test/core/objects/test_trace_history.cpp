// Traces of objects over time, against lists that are never forgotten.
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "core/objects/trace_history.h"
#include "support/judged_scene.h"

namespace donex {
namespace {

constexpr double kLookBack = 1.0, kLongestGap = 0.6;  // [s]

/// An object of one echo, at x.
Segment segmentOf(const testing::JudgedScene& scene, std::size_t echo) {
  Segment segment;
  segment.echoes = {static_cast<std::uint32_t>(echo)};
  describeEchoes(scene.judged, segment);
  return segment;
}

/// All traces an object ever left: stamp and place.
using Left = std::vector<std::pair<double, double>>;

const std::pair<double, double>* lastUntil(const Left& left, double stamp) {
  const std::pair<double, double>* last = nullptr;
  for (const auto& trace : left) {
    if (trace.first <= stamp) last = &trace;
  }
  return last;
}

TEST(TraceHistory, FindsWhatListsFind) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  TraceHistory history(kLookBack, kLongestGap);
  struct Followed {
    TraceHistory::Id last;
    double last_seen = 0.0;
    Left left;
  };
  std::map<int, Followed> followed;
  double stamp = 0.0;
  std::size_t found = 0;
  for (int k = 0; k < 400; ++k) {
    stamp += k % 100 < 50 ? 0.1 : 0.02 + 0.7 * uniform(random);
    history.begin(stamp);
    testing::JudgedScene scene(stamp);
    for (int id = 0; id < 12; ++id) scene.echo({uniform(random) * 50.0, 1.0 * id, 1.0}, Place::kNew);
    for (int id = 0; id < 12; ++id) {
      Followed& it = followed[id];
      for (const double ago : {0.3, 0.6, kLookBack}) {
        Trace trace;
        const auto* expected = lastUntil(it.left, stamp - ago);
        ASSERT_EQ(history.find(it.last, stamp - ago, trace), expected != nullptr) << "scan " << k << ", " << ago;
        if (expected == nullptr) continue;
        ++found;
        EXPECT_EQ(trace.stamp, expected->first);
        EXPECT_NEAR(trace.center().x(), expected->second, 1e-4);
        ASSERT_EQ(trace.size(), 1U);
        EXPECT_NEAR(trace.begin()->x(), expected->second, 1e-4);
      }
      if (uniform(random) < 0.3) continue;  // hidden
      const Segment segment = segmentOf(scene, static_cast<std::size_t>(id));
      it.last = history.leave(scene.judged, segment, it.last);
      it.left.emplace_back(stamp, segment.center().x());
      it.last_seen = stamp;
    }
    for (auto& [id, it] : followed) {
      if (it.last_seen < stamp - kLongestGap) it = Followed{};
    }
  }
  EXPECT_GT(found, 5000U);
}

TEST(TraceHistory, KeepsNoMoreThanItIsAskedFor) {
  TraceHistory history(kLookBack, kLongestGap);
  testing::JudgedScene scene(0.0);
  scene.face({8.0, 0.0, 0.4}, {0.0, 2.0, 0.0}, 2.0, Place::kNew, 0.1);
  Segment segment;
  for (std::uint32_t i = 0; i < 400; ++i) segment.echoes.push_back(i);
  TraceHistory::Id last;
  std::size_t after_warm_up = 0;
  for (int k = 0; k < 1000; ++k) {
    history.begin(0.1 * k);
    last = history.leave(scene.judged, segment, last);
    if (k == 100) after_warm_up = history.memoryBytes();
  }
  EXPECT_EQ(history.memoryBytes(), after_warm_up);
  Trace trace;
  EXPECT_FALSE(history.find(last, 90.0, trace)) << "long forgotten";
  ASSERT_TRUE(history.find(last, 99.0, trace));
  EXPECT_LE(trace.size(), Trace::kMostPoints);
  EXPECT_GT(trace.size(), Trace::kMostPoints / 2);
  history.reset();
  EXPECT_FALSE(history.find(last, 99.9, trace));
}

}  // namespace
}  // namespace donex
