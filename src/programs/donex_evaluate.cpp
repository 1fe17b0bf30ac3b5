// Scores label files against the labels of a sequence.
#include <fmt/format.h>

#include "donex/io/evaluation.h"
#include "donex/io/sequence.h"
#include "program.h"

namespace donex {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string sequence;
  std::vector<std::string> predictions;
  std::size_t frames = 0;  ///< 0: all
};

/// One directory of predictions. A scan whose prediction is missing or has another number of labels than the
/// scan has echoes is left out and told: nothing is guessed.
struct Candidate {
  fs::path directory;
  Evaluation evaluation;
  Faults faults;

  void add(std::size_t index, const std::vector<Eigen::Vector3f>& echoes, const std::vector<std::uint32_t>& truth) {
    const fs::path file = directory / (scanName(index) + ".label");
    try {
      const auto prediction = readLabels(file);
      if (prediction.size() == echoes.size()) return evaluation.add(index, echoes, truth, prediction);
      faults.add(
          fmt::format("{}: {} labels for {} echoes, not scored", file.string(), prediction.size(), echoes.size()));
    } catch (const DataError& error) {
      faults.add(std::string(error.what()) + ", not scored");
    }
  }
};

std::vector<Candidate> openCandidates(const std::vector<std::string>& directories) {
  Faults faults;
  std::vector<Candidate> candidates;
  for (const std::string& directory : directories) {
    if (!fs::is_directory(directory)) faults.add(directory + ": is not a directory");
    candidates.push_back({directory, Evaluation(), Faults()});
  }
  faults.throwIfAny();
  return candidates;
}

void evaluate(const SequenceReader& sequence, std::size_t scans, std::vector<Candidate>& candidates) {
  ProgressBar progress(scans);
  for (std::size_t i = 0; i < scans; ++i) {
    const bool is_scored = sequence.hasLabels(i) && Evaluation().scores(i);
    if (is_scored) {
      const auto truth = sequence.labels(i);
      const SequenceScan scan = sequence.scan(i);
      for (Candidate& candidate : candidates) candidate.add(i, scan.echoes, truth);
    }
    progress.advance();
  }
}

void run(const CLI::App& app, const Arguments& arguments) {
  const SequenceReader sequence(arguments.sequence);
  for (const std::string& note : sequence.notes()) warn(app, note);
  if (!sequence.hasLabels())
    throw DataError((sequence.directory() / "labels").string() + ": holds no labels to score by");
  auto candidates = openCandidates(arguments.predictions);
  evaluate(sequence, arguments.frames == 0 ? sequence.size() : std::min(arguments.frames, sequence.size()), candidates);
  std::vector<NamedEvaluation> columns;
  Faults faults;
  for (const Candidate& candidate : candidates) {
    columns.push_back({candidate.directory.string(), &candidate.evaluation});
    if (!candidate.faults.empty()) faults.add(candidate.faults.text());
  }
  fmt::print("{}", formatEvaluations(columns));
  std::fflush(stdout);
  faults.throwIfAny();
}

}  // namespace
}  // namespace donex

int main(int argc, char** argv) {
  CLI::App app("Scores predicted labels: moving IoU, precision, recall, by class and by range.", "donex_evaluate");
  donex::Arguments arguments;
  app.add_option("SEQ_DIR", arguments.sequence, "a sequence with labels/NNNNNN.label")->required();
  app.add_option("PRED_DIR", arguments.predictions, "directories of NNNNNN.label, above 250 is moving")->required();
  app.add_option("--frames", arguments.frames, "only the first N scans")->check(CLI::PositiveNumber);
  return donex::runProgram(app, argc, argv, [&] { donex::run(app, arguments); });
}
