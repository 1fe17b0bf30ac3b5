// The status line, fault by fault.
#include <gtest/gtest.h>

#include "ros/health.h"

namespace donex {
namespace {

Health goodHealth() {
  Health health;
  health.labeled_rate = 9.93;
  health.median_time = 0.0112;
  health.silent = 0.05;
  health.odometry_age = 0.01;
  return health;
}

struct Case {
  const char* text;
  HealthLine::Level level;
  void (*spoil)(Health&);
};

TEST(Health, SaysWhatAnEngineerUnderstands) {
  using Level = HealthLine::Level;
  const Case cases[] = {
      {"OK: 9.9 Hz, 11 ms a scan", Level::kOk, [](Health&) {}},
      {"WARN: odometry 1.2 s old, 12 scans dropped (no odometry in time)", Level::kWarn,
       [](Health& health) {
         health.odometry_age = 1.23;
         health.drops = 12;
         health.last_drop = "no odometry in time";
       }},
      {"WARN: 1 scan dropped (queue full)", Level::kWarn,
       [](Health& health) {
         health.drops = 1;
         health.last_drop = "queue full";
       }},
      {"WARN: 0.2 % of the echoes lie in the region", Level::kWarn,
       [](Health& health) { health.region_fault = "0.2 % of the echoes lie in the region"; }},
      {"WARN: odometry disagrees with the scans (its scale, 1.050 times the true lengths)", Level::kWarn,
       [](Health& health) { health.odometry_fault = "its scale, 1.050 times the true lengths"; }},
      {"WARN: no clouds for 3.0 s", Level::kWarn, [](Health& health) { health.silent = 3.0; }},
      {"WARN: no clouds yet, no odometry yet", Level::kWarn, [](Health& health) { health = Health(); }},
      {"OK: 9.9 Hz, 11 ms a scan", Level::kOk,
       [](Health& health) {
         health.needs_odometry = false;
         health.odometry_age.reset();
       }},
      {"WARN: no scan labelled yet, 3 waiting", Level::kWarn,
       [](Health& health) {
         health.labeled_rate = 0.0;
         health.waiting = 3;
       }},
      {"ERROR: labelling: bad_alloc", Level::kError, [](Health& health) { health.failure = "labelling: bad_alloc"; }},
  };
  for (const Case& one : cases) {
    Health health = goodHealth();
    one.spoil(health);
    const HealthLine line = tell(health);
    EXPECT_EQ(line.text, one.text);
    EXPECT_EQ(line.level, one.level) << one.text;
  }
}

}  // namespace
}  // namespace donex
