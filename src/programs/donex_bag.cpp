// A bag with labelled clouds from a bag with clouds, as fast as the machine can.
#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "bag/label_bag.h"
#include "core/timing.h"
#include "evaluation/comparison.h"
#include "io/outputs.h"
#include "io/whole_file.h"
#include "programs/program.h"

namespace donex {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::vector<std::string> files;  ///< IN.bag OUT.bag; with `directory` the parts of a recording
  std::string directory;           ///< where the labelled parts go
  std::string summary;
  bool check_odometry = false;  ///< nothing is written
  bool overwrite = false;
};

/// What is read and, part by part, what is written.
struct Files {
  BagParts in, out;
};

/// Files of the parts' names.
BagParts outputsIn(const fs::path& directory, const BagParts& in) {
  BagParts outputs;
  for (const fs::path& part : in) {
    const fs::path output = directory / part.filename();
    const bool is_taken = std::find(outputs.begin(), outputs.end(), output) != outputs.end();
    if (is_taken)
      throw ArgumentError(part.filename().string() + ": two parts have this name, one would overwrite the other");
    outputs.push_back(output);
  }
  return outputs;
}

Files filesOf(const Arguments& arguments) {
  BagParts given(arguments.files.begin(), arguments.files.end());
  if (!arguments.directory.empty()) return {given, outputsIn(arguments.directory, given)};
  if (given.size() == 1) throw ArgumentError("OUT.bag or --out DIR is required");
  if (given.size() > 2) {
    throw ArgumentError(
        fmt::format("{} bags and no --out DIR: IN.bag OUT.bag, or the parts of a recording and --out", given.size()));
  }
  return {{given[0]}, {given[1]}};
}

/// Faults before the first byte is written.
void requireOutputs(const Arguments& arguments, const Files& files) {
  Outputs outputs(arguments.overwrite);
  for (const fs::path& part : files.in) outputs.addInput(part);
  for (const fs::path& output : files.out) outputs.require(output);
  if (!arguments.summary.empty()) outputs.require(arguments.summary);
}

void report(const LabelBagSummary& summary) {
  const PipelineCounts& counts = summary.counts;
  fmt::print("{} messages; clouds {}, odometry {}\n", summary.messages, summary.points,
             summary.odom.empty() ? "not needed" : summary.odom);
  if (!summary.sensor.empty()) fmt::print("the sensor: {}\n", summary.sensor);
  fmt::print("ego motion: {}\n", summary.motion);
  if (!summary.check.empty()) fmt::print("{}\n", summary.check);
  if (counts.jumps > 0) fmt::print("the odometry jumped {} times, and the grid was forgotten\n", counts.jumps);
  if (counts.degenerate > 0) {
    fmt::print("ego motion left open in part by {} clouds, and predicted there: their labels are less sure\n",
               counts.degenerate);
  }
  fmt::print("{} of {} clouds labelled, {} dropped; {} of {} odometry messages refused\n", counts.clouds_labeled,
             counts.clouds_in, counts.dropped.total(), counts.refused.total(), counts.odometry_in);
  fmt::print("time a scan: median {:.2f} ms, p99 {:.2f} ms\n", 1e3 * quantile(summary.times, 0.5),
             1e3 * quantile(summary.times, 0.99));
  fmt::print("peak memory: {}\n", megabytes(peakMemory()));
  if (summary.evaluation.scans() == 0) return;
  fmt::print("\nscored by the clouds' field label:\n{}", formatEvaluations({{"this run", &summary.evaluation}}));
}

/// A ratio of nothing is null.
std::string jsonNumber(double value) { return std::isfinite(value) ? fmt::format("{:.6f}", value) : "null"; }

/// What a workflow gathers from many runs.
void keepSummary(const fs::path& file, const LabelBagSummary& summary, const Config& config) {
  double seconds = 0.0;
  for (const double time : summary.times) seconds += time;
  const PipelineCounts& counts = summary.counts;
  const Counts& score = summary.evaluation.total();
  const RunFigures figures = figuresOf(summary.times, config);
  const ScoredPrediction prediction{nameOf(config.method), {}, summary.evaluation, figures, {}};
  writeWhole(file, fmt::format("{{\"method\": \"{}\", \"duration\": {:.3f}, \"messages\": {}, \"clouds\": {}, "
                               "\"labeled\": {}, \"dropped\": {}, \"echoes\": {}, \"labelling_time\": {:.3f}, "
                               "\"median_time\": {:.6f}, \"p99_time\": {:.6f}, \"peak_memory\": {}, "
                               "\"iou\": {}, \"precision\": {}, \"recall\": {}, \"prediction\": {}}}\n",
                               nameOf(config.method), summary.duration, summary.messages, counts.clouds_in,
                               counts.clouds_labeled, counts.dropped.total(), summary.echoes, seconds,
                               figures.median_time, figures.p99_time, figures.peak_memory, jsonNumber(score.iou()),
                               jsonNumber(score.precision()), jsonNumber(score.recall()), toJson(prediction)));
}

/// What the clouds say of the odometry; writes nothing.
void checkOdometry(const CLI::App& app, const Arguments& arguments, const LabelBagOptions& options) {
  std::optional<ProgressBar> progress;
  const BagParts in(arguments.files.begin(), arguments.files.end());
  const auto ignore = [](const LabeledScan&, const ros::Time&, std::size_t) {};
  const auto summary = judgeBag(in, options, ignore, [&](std::size_t, std::size_t total) {
    if (!progress) progress.emplace(total);
    progress->advance();
  });
  progress.reset();
  for (const std::string& remark : summary.remarks) warn(app, remark);
  fmt::print("ego motion: {}\n", summary.motion);
  if (summary.check.empty()) throw DataError("there is neither odometry nor tf to check against the clouds");
  fmt::print("{}\n", summary.check);
  for (const std::string& line : summary.calibration) fmt::print("{}\n", line);
}

void run(const CLI::App& app, const Arguments& arguments, const LabelBagOptions& options) {
  const Files files = filesOf(arguments);
  requireOutputs(arguments, files);
  if (!arguments.directory.empty()) createDirectory(arguments.directory);
  std::optional<ProgressBar> progress;
  const auto summary = labelBag(files.in, files.out, options, [&](std::size_t, std::size_t total) {
    if (!progress) progress.emplace(total);
    progress->advance();
  });
  progress.reset();
  for (const std::string& remark : summary.remarks) warn(app, remark);
  report(summary);
  if (!arguments.summary.empty()) keepSummary(arguments.summary, summary, options.config);
}

}  // namespace
}  // namespace donex

int main(int argc, char** argv) {
  CLI::App app("Copies a bag and adds its clouds with labels, the same that the live node gives.", "donex_bag");
  donex::Arguments arguments;
  donex::LabelBagOptions options;
  app.footer(
      "donex_bag IN.bag OUT.bag\n"
      "donex_bag PART_0.bag PART_1.bag ... --out DIR   (a split recording, labelled as one)\n"
      "donex_bag IN.bag --check-odometry   (writes nothing)");
  app.add_option("BAGS", arguments.files,
                 "IN.bag OUT.bag: everything of IN and its labelled clouds; with --out only what is read")
      ->required()
      ->expected(1, 100000);
  app.add_option("--out", arguments.directory, "directory for the labelled bags, which keep their names");
  donex::addOverwrite(app, arguments.overwrite);
  app.add_option("--points", options.points, "topic of the clouds; needed where there are several");
  app.add_option("--odom", options.odom,
                 "topic of the odometry; needed where there are several. By default (odometry_source auto) the ego "
                 "motion is that of "
                 "the odometry, else of tf, else it is found in the clouds");
  app.add_option("--labeled", options.labeled, "topic of the labelled clouds, by default " + options.labeled);
  app.add_flag("--check-odometry", arguments.check_odometry,
               "only say whether the odometry agrees with the clouds, and what they tell of mounting, scale and stamps")
      ->excludes("--out");
  app.add_option("--summary", arguments.summary, "write counts, times and memory to this file (JSON)");
  const donex::ConfigOptions config(app);
  return donex::runProgram(app, argc, argv, [&] {
    donex::Config defaults;
    defaults.motion.source = donex::OdometrySource::kAuto;
    options.config = config.config(defaults);
    options.calibrate = arguments.check_odometry;
    options.config.motion.odometry_check |= arguments.check_odometry;
    if (arguments.check_odometry) return donex::checkOdometry(app, arguments, options);
    donex::run(app, arguments, options);
  });
}
