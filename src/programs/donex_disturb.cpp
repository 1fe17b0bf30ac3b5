// A sequence with rain, dust and other matter that lies added to it, with truth.
#include "io/outputs.h"
#include "io/sequence.h"
#include "programs/option_adder.h"
#include "programs/program.h"
#include "simulation/disturbance.h"

namespace donex {
namespace {

using simulation::Disturbance;
using simulation::SimulatedEcho;

struct Arguments {
  std::string sequence, out;
  int seed = 1;
  std::size_t frames = 0;  ///< 0: all
  bool overwrite = false;
  simulation::SimulatorOptions options;  ///< of which only the disturbance counts
};

std::vector<SimulatedEcho> echoesOf(const SequenceScan& scan) {
  std::vector<SimulatedEcho> echoes(scan.echoes.size());
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    echoes[i].position = scan.echoes[i];
    echoes[i].intensity = scan.intensities[i];
  }
  return echoes;
}

void disturb(const Disturbance& disturbance, std::size_t number, SequenceScan& scan,
             std::vector<std::uint32_t>& labels) {
  std::vector<SimulatedEcho> echoes = echoesOf(scan);
  disturbance.apply(number, echoes, labels);
  scan.echoes.clear();
  scan.intensities.clear();
  for (const SimulatedEcho& echo : echoes) {
    scan.echoes.push_back(echo.position);
    scan.intensities.push_back(echo.intensity);
  }
}

void check(const Arguments& arguments) {
  std::string text;
  for (const std::string& fault : arguments.options.faults()) text += (text.empty() ? "" : "\n") + fault;
  if (text.empty() && !arguments.options.disturbance.any()) text = "nothing to add: name --rain, --dust or another";
  if (!text.empty()) throw ArgumentError(text);
}

/// The sequence itself is never written over.
void requireOutput(const Arguments& arguments) {
  Outputs outputs(arguments.overwrite);
  outputs.addSequence(arguments.sequence);
  outputs.requireIn(arguments.out, [](const std::string& name) {
    return name == "velodyne" || name == "labels" || name == "poses.txt" || name == "times.txt" || name == "calib.txt";
  });
}

void run(const CLI::App& app, const Arguments& arguments) {
  check(arguments);
  const SequenceReader sequence = openSequence(app, arguments.sequence);
  requireOutput(arguments);
  const std::size_t scans = scansOf(sequence, arguments.frames);
  const Disturbance disturbance(arguments.options.disturbance, static_cast<std::uint64_t>(arguments.seed));
  SequenceWriter writer(arguments.out, arguments.overwrite);
  ProgressBar progress(scans);
  for (std::size_t i = 0; i < scans; ++i) {
    SequenceScan scan = sequence.scan(i);
    const bool has_labels = sequence.hasLabels(i);
    std::vector<std::uint32_t> labels(scan.echoes.size());
    if (has_labels) labels = sequence.labels(i);
    disturb(disturbance, i, scan, labels);
    has_labels ? writer.add(scan, labels) : writer.add(scan);
    progress.advance();
  }
}

}  // namespace
}  // namespace donex

int main(int argc, char** argv) {
  CLI::App app("Adds rain, dust and other matter that lies to a sequence (SemanticKITTI layout), with truth.",
               "donex_disturb");
  donex::Arguments arguments;
  app.add_option("SEQ_DIR", arguments.sequence, "velodyne/NNNNNN.bin, poses.txt, times.txt, labels/")->required();
  app.add_option("OUT", arguments.out, "a directory for the sequence")->required();
  app.add_option("--seed", arguments.seed, "the same seed gives the same echoes; by default 1")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--frames", arguments.frames, "only the first N scans")->check(CLI::PositiveNumber);
  donex::addOverwrite(app, arguments.overwrite);
  donex::simulation::visitDisturbances<donex::simulation::OptionInfo>(arguments.options.disturbance,
                                                                      donex::OptionAdder{app});
  return donex::runProgram(app, argc, argv, [&] { donex::run(app, arguments); });
}
