// The paper's comparison in numbers: every method over every sequence, and one report.
#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "evaluation/comparison.h"
#include "io/number_text.h"
#include "io/outputs.h"
#include "io/whole_file.h"
#include "programs/program.h"

namespace donex {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::vector<std::string> sequences;
  std::string out;
  std::string methods;     ///< separated by commas; empty: all
  std::size_t frames = 0;  ///< 0: all
  bool skip_table_1 = false;
  bool overwrite = false;
};

/// A method with its settings.
struct Contender {
  MethodNote note;
  Config config;
};

/// A method as it is by default.
Contender defaultOf(Method method) {
  const MethodInfo& info = infoOf(method);
  Contender contender{{info.name, info.what, info.source, !info.needs_whole_drive}, Config()};
  contender.config.method = method;
  return contender;
}

/// The paper's rule alone, as config/paper_3d.yaml has it.
Contender paperOf(Method method, const char* name, const char* what) {
  return {{name, what, infoOf(method).source, true}, paperConfig(method, Compensation::kResample)};
}

std::vector<Contender> allContenders() {
  std::vector<Contender> all{
      defaultOf(Method::kDonex3d), defaultOf(Method::kDonex2d),
      paperOf(Method::kDonex3d, "paper_3d", "the paper's 3D rule alone, see-through by traversal"),
      paperOf(Method::kDonex3dZBuffer, "paper_3d_zbuffer", "the same, see-through by a z-buffer"),
      paperOf(Method::kDonex2d, "paper_2d", "the paper's 2D rule alone, no line of sight")};
  for (const Method method : allMethods()) {
    if (infoOf(method).kind == MethodKind::kComparison) all.push_back(defaultOf(method));
  }
  return all;
}

std::vector<Contender> chooseContenders(const std::string& names) {
  std::vector<Contender> all = allContenders(), chosen;
  if (names.empty()) return all;
  std::istringstream list(names);
  for (std::string name; std::getline(list, name, ',');) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const Contender& c) { return c.note.name == name; });
    if (found == all.end()) {
      std::string known;
      for (const Contender& contender : all) known += (known.empty() ? "" : ", ") + contender.note.name;
      throw ArgumentError(fmt::format("there is no method {}, only {}", name, known));
    }
    chosen.push_back(*found);
  }
  return chosen;
}

/// Runs `work` in a process of its own, so that peak memory is that of one method; throws where it failed.
void inOwnProcess(const std::string& what, const std::function<void()>& work) {
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw DataError(what + ": no process can be started");
  if (child == 0) {
    int code = 0;
    try {
      work();
    } catch (const std::exception& error) {
      fmt::print(stderr, "donex_compare: {}: {}\n", what, error.what());
      code = 1;
    }
    std::fflush(nullptr);
    _exit(code);
  }
  int status = 0;
  const bool has_ended = waitpid(child, &status, 0) == child;
  if (has_ended && WIFSIGNALED(status)) throw DataError(fmt::format("{}: ended by signal {}", what, WTERMSIG(status)));
  const bool is_done = has_ended && WIFEXITED(status) && WEXITSTATUS(status) == 0;
  if (!is_done) throw DataError(what + ": could not be run");
}

/// Labels where `with_labels`, and run.json.
void runContender(const SequenceReader& sequence, std::size_t scans, const Config& config, const fs::path& out,
                  bool with_labels) {
  createDirectory(out);
  DriveRun drive(config);
  const auto keep = [&](std::size_t i, const Scan&, const EchoLabels& labels) {
    if (with_labels) writeLabels(out / (scanName(i) + ".label"), asSemanticKitti(labels));
  };
  ProgressBar progress(scans * drive.passes());
  drive.run(sequence, scans, keep, [&] { progress.advance(); });
  writeRunFigures(out, figuresOf(drive, config));
}

/// The sequence's name, with a number where two are called alike.
std::string nameOf(const SequenceReader& sequence, std::set<std::string>& taken) {
  std::string unique = sequence.name();
  for (int i = 2; !taken.insert(unique).second; ++i) unique = fmt::format("{}_{}", sequence.name(), i);
  return unique;
}

SequenceComparison compare(const SequenceReader& sequence, const std::string& name, const Arguments& arguments,
                           const std::vector<Contender>& contenders) {
  const std::size_t scans = scansOf(sequence, arguments.frames);
  std::vector<std::pair<std::string, fs::path>> predictions;
  for (const Contender& contender : contenders) {
    const fs::path out = fs::path(arguments.out) / "predictions" / name / contender.note.name;
    fmt::print("{}: {}\n", name, contender.note.name);
    inOwnProcess(contender.note.name + " on " + name,
                 [&] { runContender(sequence, scans, contender.config, out, true); });
    predictions.emplace_back(contender.note.name, out);
  }
  SequenceComparison comparison = compareOnSequence(sequence, scans, predictions, [] {});
  comparison.name = name;
  return comparison;
}

/// The paper's Table 1 (measured on an i7-8650U, 160,000 echoes), its region, on this sequence.
void fillTable1(Comparison& comparison, const std::string& directory, const std::string& out) {
  const SequenceReader sequence(directory);
  const std::size_t scans = scansOf(sequence, 30);
  const auto measure = [&](Method method, double voxel_size) {
    Config config = paperConfig(method, Compensation::kResample);
    config.voxel_size = voxel_size;
    config.region = {0.0, 75.0, -25.0, 25.0, -4.0, 6.0};
    const fs::path place = fs::path(out) / "table_1" / fmt::format("{}_{}", nameOf(method), numberText(voxel_size));
    inOwnProcess(place.filename().string(), [&] { runContender(sequence, scans, config, place, false); });
    return readRunFigures(place)->median_cpu_time;
  };
  comparison.table_1 = {
      {0.3, "8-9 ms", "175-185 ms"}, {0.15, "12-14 ms", "550-560 ms"}, {0.1, "21-23 ms", "1300-1350 ms"}};
  std::size_t echoes = 0;
  for (std::size_t i = 0; i < scans; ++i) echoes += sequence.echoes(i) / scans;
  comparison.table_1_setting = fmt::format(
      "Region x 0 to 75 m, y -25 to 25 m, the paper's rule. Published: 160,000 echoes, i7-8650U. Measured: {}, {} "
      "scans of {} echoes in all directions, those outside the region only see through it; median CPU time.",
      comparison.sequences.front().name, scans, echoes);
  fmt::print("Table 1\n");
  for (Table1Row& row : comparison.table_1) {
    row.measured_2d = measure(Method::kDonex2d, row.voxel_size);
    row.measured_3d = measure(Method::kDonex3d, row.voxel_size);
    row.measured_z_buffer = measure(Method::kDonex3dZBuffer, row.voxel_size);
  }
}

void writeReports(const Comparison& comparison, const fs::path& out) {
  writeWhole(out / "report.csv", toCsv(comparison));
  writeWhole(out / "report.json", toJson(comparison));
  writeWhole(out / "report.html", toHtml(comparison));
  for (const SequenceComparison& sequence : comparison.sequences) {
    fmt::print("\n{}\n{}", sequence.name, formatEvaluations(sequence.columns()));
  }
  fmt::print("\n{}\n", (out / "report.html").string());
}

void requireOutputs(const Arguments& arguments) {
  const std::set<std::string> ours{"report.csv", "report.json", "report.html", "predictions", "table_1"};
  Outputs outputs(arguments.overwrite);
  for (const std::string& directory : arguments.sequences) outputs.addSequence(directory);
  outputs.requireIn(arguments.out, [&](const std::string& name) { return ours.count(name) != 0; });
}

void run(const CLI::App& app, const Arguments& arguments) {
  const auto contenders = chooseContenders(arguments.methods);
  Comparison comparison;
  comparison.title = "DONEX and the systems it is compared with";
  comparison.command = "donex_compare";
  for (const std::string& sequence : arguments.sequences) comparison.command += " " + sequence;
  for (const Contender& contender : contenders) comparison.methods.push_back(contender.note);
  for (const std::string& directory : arguments.sequences) {  // all faults of the input before the first hour of work
    requireTruth(openSequence(app, directory));
  }
  requireOutputs(arguments);
  createDirectory(arguments.out);
  std::set<std::string> names;
  for (const std::string& directory : arguments.sequences) {
    const SequenceReader sequence(directory);
    comparison.sequences.push_back(compare(sequence, nameOf(sequence, names), arguments, contenders));
  }
  if (!arguments.skip_table_1) fillTable1(comparison, arguments.sequences.front(), arguments.out);
  writeReports(comparison, arguments.out);
}

}  // namespace
}  // namespace donex

int main(int argc, char** argv) {
  CLI::App app("Runs DONEX and the systems of the paper's comparison over labelled sequences; writes one report.",
               "donex_compare");
  donex::Arguments arguments;
  app.add_option("SEQ_DIR", arguments.sequences, "sequences with labels/NNNNNN.label")->required();
  app.add_option("--out", arguments.out, "directory for report.html, .csv, .json and predictions/")->required();
  // One text, not a list: a list would swallow the sequences behind it.
  app.add_option("--methods", arguments.methods, "only these, separated by commas; by default all");
  app.add_option("--frames", arguments.frames, "only the first N scans")->check(CLI::PositiveNumber);
  app.add_flag("--skip-table-1", arguments.skip_table_1, "leave out the times of the paper's Table 1");
  donex::addOverwrite(app, arguments.overwrite);
  return donex::runProgram(app, argc, argv, [&] { donex::run(app, arguments); });
}
