// A sequence on disk as the bag a vehicle would have recorded.
#include <optional>

#include <fmt/format.h>

#include "bag/bag_file.h"
#include "bag/sequence_bag.h"
#include "evaluation/scan_parts.h"
#include "io/number_text.h"
#include "io/outputs.h"
#include "programs/program.h"

namespace donex {
namespace {

struct Arguments {
  std::string sequence, file;
  std::string compression = "none";
  SequenceBagOptions options;
  bool overwrite = false;
};

void run(const CLI::App& app, Arguments& arguments) {
  arguments.options.compression = parseCompression(arguments.compression);
  const SequenceReader sequence = openSequence(app, arguments.sequence);
  Outputs outputs(arguments.overwrite);
  outputs.addSequence(arguments.sequence);
  outputs.require(arguments.file);
  std::optional<ProgressBar> progress(sequence.size());
  const auto summary = writeSequenceBag(sequence, arguments.file, arguments.options, [&] { progress->advance(); });
  progress.reset();
  fmt::print("{} clouds on /points, {} odometry messages on /odom, tf odom <- base_link <- velodyne\n", summary.clouds,
             summary.odometry);
  if (summary.shift != 0.0)
    fmt::print("all times moved by {} s: a bag knows no time before 0\n", numberText(summary.shift));
}

}  // namespace
}  // namespace donex

int main(int argc, char** argv) {
  CLI::App app("Writes a sequence (SemanticKITTI layout) as a bag with clouds, odometry and tf.",
               "donex_sequence_to_bag");
  donex::Arguments arguments;
  app.add_option("SEQ_DIR", arguments.sequence, "velodyne/NNNNNN.bin, poses.txt, times.txt")->required();
  app.add_option("OUT.bag", arguments.file, "must not exist, unless --overwrite")->required();
  app.add_option("--odom-rate", arguments.options.odometry.rate,
                 "odometry messages a second, evenly between two scans and one at each scan's stamp; by default 10")
      ->check(CLI::Range(0.1, 10000.0));
  app.add_option("--odom-offset", arguments.options.odometry.offset,
                 "moves the odometry against the scans [s], so that poses are interpolated; by default 0")
      ->check(CLI::Range(-10.0, 10.0));
  app.add_option("--parts", arguments.options.parts,
                 "clouds per scan, sectors that are sent as the sensor turns; by default 1")
      ->check(CLI::Range(std::size_t{1}, donex::ScanParts::kMost));
  app.add_option("--compression", arguments.compression, "none, lz4 or bz2; by default none")
      ->check(CLI::IsMember({"none", "lz4", "bz2"}));
  donex::addOverwrite(app, arguments.overwrite);
  return donex::runProgram(app, argc, argv, [&] { donex::run(app, arguments); });
}
