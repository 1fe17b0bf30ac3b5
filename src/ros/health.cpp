#include "ros/health.h"

#include <array>
#include <cstdio>
#include <vector>

namespace donex {
namespace {

template <class... Values>
std::string textOf(const char* format, Values... values) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

void addSilence(const Health& health, std::vector<std::string>& problems) {
  if (!health.silent) {
    problems.emplace_back("no clouds yet");
  } else if (*health.silent >= kSilence) {
    problems.push_back(textOf("no clouds for %.1f s", *health.silent));
  }
}

void addOdometry(const Health& health, std::vector<std::string>& problems) {
  if (!health.needs_odometry) return;
  if (!health.odometry_age) {
    problems.emplace_back("no odometry yet");
  } else if (*health.odometry_age >= kSilence) {
    problems.push_back(textOf("odometry %.1f s old", *health.odometry_age));
  }
}

void addOdometryFault(const Health& health, std::vector<std::string>& problems) {
  if (health.odometry_fault.empty()) return;
  problems.push_back("odometry disagrees with the scans (" + health.odometry_fault + ")");
}

void addDrops(const Health& health, std::vector<std::string>& problems) {
  if (health.drops == 0) return;
  const char* scans = health.drops == 1 ? "scan" : "scans";
  problems.push_back(textOf("%zu %s dropped (%s)", health.drops, scans, health.last_drop.c_str()));
}

}  // namespace

HealthLine tell(const Health& health) {
  if (!health.failure.empty()) return {HealthLine::Level::kError, "ERROR: " + health.failure};
  std::vector<std::string> problems;
  addSilence(health, problems);
  addOdometry(health, problems);
  addOdometryFault(health, problems);
  addDrops(health, problems);
  if (!health.region_fault.empty()) problems.push_back(health.region_fault);
  const bool stuck = problems.empty() && health.labeled_rate <= 0.0;
  if (stuck) problems.push_back(textOf("no scan labelled yet, %zu waiting", health.waiting));
  if (problems.empty()) {
    return {HealthLine::Level::kOk,
            textOf("OK: %.1f Hz, %.0f ms a scan", health.labeled_rate, 1e3 * health.median_time)};
  }
  std::string text = "WARN: ";
  for (const std::string& problem : problems) text += (&problem == &problems.front() ? "" : ", ") + problem;
  return {HealthLine::Level::kWarn, text};
}

}  // namespace donex
