// A bag with labelled clouds from a bag with clouds, as fast as the machine can.
#include <optional>

#include <fmt/format.h>

#include "donex/bag/label_bag.h"
#include "program.h"

namespace donex {
namespace {

namespace fs = std::filesystem;

void requireOtherFile(const std::string& in, const std::string& out) {
  std::error_code ignored;  // where the input is missing, that is told when it is opened
  const bool same = fs::equivalent(in, out, ignored);
  if (same) throw ArgumentError("OUT.bag is IN.bag, which would be overwritten");
}

void report(const LabelBagSummary& summary) {
  const PipelineCounts& counts = summary.counts;
  fmt::print("{} messages; clouds {}, odometry {}\n", summary.messages, summary.points,
             summary.odom.empty() ? "not needed" : summary.odom);
  fmt::print("{} of {} clouds labelled, {} dropped; {} of {} odometry messages refused\n", counts.clouds_labeled,
             counts.clouds_in, counts.dropped.total(), counts.refused.total(), counts.odometry_in);
  fmt::print("time a scan: median {:.2f} ms, p99 {:.2f} ms\n", 1e3 * quantile(summary.times, 0.5),
             1e3 * quantile(summary.times, 0.99));
  fmt::print("peak memory: {}\n", megabytes(peakMemory()));
}

void run(const CLI::App& app, const std::string& in, const std::string& out, const LabelBagOptions& options) {
  requireOtherFile(in, out);
  std::optional<ProgressBar> progress;
  const auto summary = labelBag(in, out, options, [&](std::size_t, std::size_t total) {
    if (!progress) progress.emplace(total);
    progress->advance();
  });
  progress.reset();
  for (const std::string& remark : summary.remarks) warn(app, remark);
  report(summary);
}

}  // namespace
}  // namespace donex

int main(int argc, char** argv) {
  CLI::App app("Copies a bag and adds its clouds with labels, the same that the live node gives.", "donex_bag");
  std::string in, out;
  donex::LabelBagOptions options;
  app.add_option("IN.bag", in, "clouds, odometry, tf")->required();
  app.add_option("OUT.bag", out, "everything of IN.bag and the labelled clouds; overwritten")->required();
  app.add_option("--points", options.points, "topic of the clouds; needed where there are several");
  app.add_option("--odom", options.odom, "topic of the odometry; needed where there are several");
  app.add_option("--labeled", options.labeled, "topic of the labelled clouds, by default " + options.labeled);
  const donex::ConfigOptions config(app);
  return donex::runProgram(app, argc, argv, [&] {
    options.config = config.config();
    donex::run(app, in, out, options);
  });
}
