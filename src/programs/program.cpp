#include "programs/program.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <sstream>

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include "core/timing.h"
#include "io/config_file.h"
#include "io/number_text.h"
#include "io/outputs.h"

namespace donex {
namespace {

constexpr int kDone = 0;
constexpr int kFailedOnData = 1;
constexpr int kWrongArguments = 2;

int parseArguments(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    return kDone;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kWrongArguments;
  }
}

/// What there is for --method, a line each, columns separated by tabs; the run ends.
void listMethods() {
  for (const Method method : allMethods()) {
    const MethodInfo& info = infoOf(method);
    const char* kind = info.kind == MethodKind::kDonex ? "donex" : info.needs_whole_drive ? "whole drive" : "live";
    fmt::print("{}\t{}\t{}\t{}\n", info.name, kind, info.what, info.source);
  }
  throw CLI::Success();
}

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

int runBody(const CLI::App& app, const std::function<void()>& body) {
  try {
    body();
    return kDone;
  } catch (const SettingError& error) {
    warn(app, error.what());
    return kWrongArguments;
  } catch (const OutputRefused& error) {
    warn(app, error.what());
    return kWrongArguments;
  } catch (const ArgumentError& error) {
    warn(app, error.what());
    return kWrongArguments;
  } catch (const std::exception& error) {
    warn(app, error.what());
    return kFailedOnData;
  }
}

}  // namespace

int runProgram(CLI::App& app, int argc, char** argv, const std::function<void()>& body) {
  // CLI11 calls this only when the arguments are sound, so that --help is not followed by a run.
  int result = kDone;
  app.callback([&] { result = runBody(app, body); });
  const int parsed = parseArguments(app, argc, argv);
  return parsed == kDone ? result : parsed;
}

void warn(const CLI::App& app, const std::string& text) { fmt::print(stderr, "{}: {}\n", app.get_name(), text); }

void addOverwrite(CLI::App& app, bool& overwrite) {
  app.add_flag("--overwrite", overwrite, "replace outputs that are there already; inputs never are");
}

SequenceReader openSequence(const CLI::App& app, const std::string& directory) {
  SequenceReader sequence(directory);
  for (const std::string& note : sequence.notes()) warn(app, note);
  return sequence;
}

void requireTruth(const SequenceReader& sequence) {
  if (sequence.hasLabels()) return;
  throw DataError((sequence.directory() / "labels").string() + ": holds no labels to score by");
}

std::size_t scansOf(const SequenceReader& sequence, std::size_t frames) {
  return frames == 0 ? sequence.size() : std::min(frames, sequence.size());
}

ConfigOptions::ConfigOptions(CLI::App& app) {
  app.add_flag_callback("--list-methods", listMethods, "every method: its name, kind, what it does, and its source");
  // Joined, not lists: a list would swallow the positional arguments behind it.
  app.add_option("--config", files_,
                 "a file of parameters, as the node reads it; may be repeated, the later over the earlier")
      ->multi_option_policy(CLI::MultiOptionPolicy::Join);
  app.add_option("--method", method_, "the classifier, over --config");
  app.add_option("--voxel-size", voxel_size_, "edge length of a voxel [m], over --config");
  app.add_option("--set", settings_, "name=value: any parameter, over all others; may be repeated")
      ->multi_option_policy(CLI::MultiOptionPolicy::Join);
}

Config ConfigOptions::config(const Config& base) const {
  Config config = base;
  for (const std::string& file : linesOf(files_)) config = readConfigFile(file, config);
  std::vector<std::string> settings;
  if (!method_.empty()) settings.push_back("method=" + method_);
  if (!voxel_size_.empty()) settings.push_back("voxel_size=" + voxel_size_);
  for (const std::string& setting : linesOf(settings_)) settings.push_back(setting);
  applySettings(config, settings);
  return config;
}

ProgressBar::ProgressBar(std::size_t total) : total_(total), on_terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (on_terminal_ && done_ > 0) std::fputs("\r\033[K", stderr);
}

void ProgressBar::advance() {
  ++done_;
  constexpr std::size_t kWidth = 40;
  const std::size_t shown = std::min(done_, total_);
  const int percent = total_ == 0 ? 100 : static_cast<int>(100 * shown / total_);
  if (!on_terminal_ || percent == drawn_percent_) return;
  drawn_percent_ = percent;
  const std::size_t filled = kWidth * static_cast<std::size_t>(percent) / 100;
  fmt::print(stderr, "\r[{}{}] {:3d} %  {} of {}", std::string(filled, '='), std::string(kWidth - filled, ' '), percent,
             shown, total_);
  std::fflush(stderr);
}

std::size_t peakMemory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024U;
}

RunFigures figuresOf(const std::vector<double>& times, const Config& config) {
  RunFigures figures;
  figures.method = fmt::format("{}, {} m", nameOf(config.method), numberText(config.voxel_size));
  figures.scans = times.size();
  figures.median_time = quantile(times, 0.5);
  figures.p99_time = quantile(times, 0.99);
  figures.peak_memory = peakMemory();
  return figures;
}

RunFigures figuresOf(const DriveRun& drive, const Config& config) {
  RunFigures figures = figuresOf(drive.times(), config);
  figures.median_cpu_time = quantile(drive.cpuTimes(), 0.5);
  const double cpu_time = std::accumulate(drive.cpuTimes().begin(), drive.cpuTimes().end(), 0.0);
  figures.mean_cpu_time = cpu_time / static_cast<double>(std::max<std::size_t>(figures.scans, 1));
  figures.method_memory = drive.memoryBytes();
  return figures;
}

std::string megabytes(std::size_t bytes) { return fmt::format("{:.1f} MB", static_cast<double>(bytes) / 1e6); }

}  // namespace donex
