// Scores label files against the labels of a sequence.
#include <fmt/format.h>

#include "evaluation/comparison.h"
#include "io/outputs.h"
#include "io/whole_file.h"
#include "programs/program.h"

namespace donex {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string sequence;
  std::vector<std::string> predictions;
  std::size_t frames = 0;  ///< 0: all
  std::string csv, json, html;
  bool overwrite = false;
};

std::vector<std::pair<std::string, fs::path>> directoriesOf(const Arguments& arguments) {
  Faults faults;
  std::vector<std::pair<std::string, fs::path>> directories;
  for (const std::string& directory : arguments.predictions) {
    if (!fs::is_directory(directory)) faults.add(directory + ": is not a directory");
    directories.emplace_back(directory, directory);
  }
  faults.throwIfAny();
  return directories;
}

void requireOutputs(const Arguments& arguments) {
  Outputs outputs(arguments.overwrite);
  outputs.addSequence(arguments.sequence);
  for (const std::string& prediction : arguments.predictions) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(prediction, ignored)) outputs.addInput(entry.path());
  }
  for (const std::string& file : {arguments.csv, arguments.json, arguments.html}) {
    if (!file.empty()) outputs.require(file);
  }
}

void writeReports(const CLI::App& app, const Arguments& arguments, const SequenceComparison& sequence) {
  Comparison comparison;
  comparison.title = "donex_evaluate: " + sequence.name;
  comparison.command = app.get_name() + ' ' + arguments.sequence;
  for (const std::string& prediction : arguments.predictions) comparison.command += ' ' + prediction;
  comparison.sequences = {sequence};
  if (!arguments.csv.empty()) writeWhole(arguments.csv, toCsv(comparison));
  if (!arguments.json.empty()) writeWhole(arguments.json, toJson(comparison));
  if (!arguments.html.empty()) writeWhole(arguments.html, toHtml(comparison));
}

void run(const CLI::App& app, const Arguments& arguments) {
  const SequenceReader sequence = openSequence(app, arguments.sequence);
  requireTruth(sequence);
  requireOutputs(arguments);
  const auto directories = directoriesOf(arguments);
  const std::size_t scans = scansOf(sequence, arguments.frames);
  SequenceComparison comparison;
  {
    ProgressBar progress(scans);
    comparison = compareOnSequence(sequence, scans, directories, [&] { progress.advance(); });
  }
  fmt::print("{}", formatEvaluations(comparison.columns()));
  std::fflush(stdout);
  writeReports(app, arguments, comparison);
  Faults faults;
  for (const ScoredPrediction& prediction : comparison.predictions) {
    if (!prediction.faults.empty()) faults.add(prediction.faults.text());
  }
  faults.throwIfAny();
}

}  // namespace
}  // namespace donex

int main(int argc, char** argv) {
  CLI::App app("Scores predicted labels: moving IoU, precision, recall, by class, range, speed, and by objects.",
               "donex_evaluate");
  donex::Arguments arguments;
  app.add_option("SEQ_DIR", arguments.sequence, "a sequence with labels/NNNNNN.label")->required();
  app.add_option("PRED_DIR", arguments.predictions, "directories of NNNNNN.label, above 250 is moving")->required();
  app.add_option("--frames", arguments.frames, "only the first N scans")->check(CLI::PositiveNumber);
  app.add_option("--csv", arguments.csv, "write every count to this file");
  app.add_option("--json", arguments.json, "the same as JSON");
  app.add_option("--html", arguments.html, "a report with plots and pictures, one page that holds all it shows");
  donex::addOverwrite(app, arguments.overwrite);
  return donex::runProgram(app, argc, argv, [&] { donex::run(app, arguments); });
}
