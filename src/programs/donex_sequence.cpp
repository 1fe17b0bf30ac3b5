// A SemanticKITTI-layout sequence through the detector: labels, time and score.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/pi.h"
#include "core/timing.h"
#include "donex/memory_bound.h"
#include "evaluation/comparison.h"
#include "evaluation/drift.h"
#include "io/number_text.h"
#include "io/outputs.h"
#include "io/sequence.h"
#include "io/whole_file.h"
#include "programs/program.h"

namespace donex {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string sequence;
  std::string out;
  std::size_t frames = 0;  ///< 0: all
  std::size_t parts = 1;   ///< per scan
  std::string odometry = "given";
  bool overwrite = false;
};

struct Run {
  std::size_t echoes = 0;
  std::size_t dynamic = 0;
  Evaluation evaluation;
};

/// Creates the directory of the predictions, unless that would write over anything.
void prepareOutput(const Arguments& arguments) {
  if (arguments.out.empty()) return;
  const fs::path out = fs::weakly_canonical(arguments.out);
  if (out == fs::weakly_canonical(fs::path(arguments.sequence) / "labels")) {
    throw ArgumentError("--out " + arguments.out + " holds the ground truth, it would be overwritten");
  }
  Outputs outputs(arguments.overwrite);
  outputs.addSequence(arguments.sequence);
  outputs.requireIn(arguments.out, [](const std::string& name) {
    return isLabelFile(name) || name == "run.json" || name == "poses.txt";
  });
  createDirectory(arguments.out);
}

Run runSequence(const SequenceReader& sequence, std::size_t scans, DriveRun& drive, const std::string& out) {
  Run run;
  ProgressBar progress(scans * drive.passes());
  const auto take = [&](std::size_t i, const Scan& scan, const EchoLabels& labels) {
    const auto prediction = asSemanticKitti(labels);
    run.echoes += prediction.size();
    run.dynamic += static_cast<std::size_t>(std::count(prediction.begin(), prediction.end(), kLabelMoving));
    if (!out.empty()) writeLabels(fs::path(out) / (scanName(i) + ".label"), prediction);
    if (sequence.hasLabels(i)) run.evaluation.add(i, scan.echoes, sequence.labels(i), prediction);
  };
  drive.run(sequence, scans, take, [&] { progress.advance(); });
  return run;
}

void report(const Run& run, const Config& config, const DriveRun& drive, bool has_labels) {
  double seconds = 0.0;
  for (const double time : drive.times()) seconds += time;
  fmt::print("{} scans, {} echoes, {} dynamic; {}, {} m\n", drive.times().size(), run.echoes, run.dynamic,
             nameOf(config.method), numberText(config.voxel_size));
  fmt::print("time a scan: median {:.2f} ms, p99 {:.2f} ms (CPU: median {:.2f} ms)\n",
             1e3 * quantile(drive.times(), 0.5), 1e3 * quantile(drive.times(), 0.99),
             1e3 * quantile(drive.cpuTimes(), 0.5));
  fmt::print("echoes a second: {:.1f} million\n", 1e-6 * static_cast<double>(run.echoes) / seconds);
  const std::size_t a_scan = run.echoes / std::max<std::size_t>(drive.times().size(), 1);
  fmt::print("peak memory: {} used; set aside for the grid: {}, said beforehand for scans of {} echoes: {}\n",
             megabytes(peakMemory()), megabytes(drive.memoryBytes()), a_scan,
             megabytes(static_cast<std::size_t>(memoryBound(config, a_scan))));
  if (run.evaluation.scans() > 0) {
    fmt::print("\n{}", formatEvaluations({{"this run", &run.evaluation}}));
  } else {
    fmt::print("not scored: {}\n", has_labels ? "no labelled scan after the warm-up" : "the sequence has no labels");
  }
}

void reportCompletion(const DriveRun& drive) {
  if (drive.completed() == 0) return;
  fmt::print(
      "height, roll and pitch of {} scans were found in the scans: the poses never leave their plane; CPU time "
      "median {:.2f} ms, p99 {:.2f} ms\n",
      drive.completed(), 1e3 * quantile(drive.odometryTimes(), 0.5), 1e3 * quantile(drive.odometryTimes(), 0.99));
}

void reportCheck(const DriveRun& drive) {
  if (drive.check() == nullptr) return;
  fmt::print("{}\n", summaryOf(drive.check()->finding()));
  if (drive.jumps() > 0) fmt::print("the poses jumped {} times, and the grid was forgotten\n", drive.jumps());
}

/// Of the newest scan: what tells whether a start is right.
void reportLastStep(const std::vector<Eigen::Isometry3d>& found, const std::vector<Eigen::Isometry3d>& given) {
  if (found.size() < 2) return;
  const auto stepOf = [](const std::vector<Eigen::Isometry3d>& poses) {
    return poses[poses.size() - 2].inverse() * poses.back();
  };
  const Eigen::Isometry3d difference = stepOf(given).inverse() * stepOf(found);
  const double angle = std::abs(Eigen::AngleAxisd(Eigen::Matrix3d(difference.linear())).angle());
  fmt::print("its last step against poses.txt: {:.3f} m, {:.3f} degrees\n", difference.translation().norm(),
             angle * 180.0 / kPi);
}

/// Poses of the scans against those that the sequence comes with.
void reportOdometry(const SequenceReader& sequence, const DriveRun& drive) {
  constexpr double kPiece = 10.0;  // [m]
  std::vector<Eigen::Isometry3d> found, given;
  std::size_t degenerate = 0, lost = 0;
  for (const TrackedScan& tracked : drive.tracked()) {
    given.push_back(sequence.pose(found.size()).isometry());
    found.push_back(tracked.odom_from_sensor);
    degenerate += tracked.status == TrackingStatus::kDegenerate ? 1U : 0U;
    lost += tracked.status == TrackingStatus::kLost ? 1U : 0U;
  }
  if (found.empty()) return;
  const Drift drift = driftOver(found, given, kPiece);
  fmt::print("odometry from the scans: {} degenerate, {} lost; CPU time median {:.2f} ms, p99 {:.2f} ms\n", degenerate,
             lost, 1e3 * quantile(drive.odometryTimes(), 0.5), 1e3 * quantile(drive.odometryTimes(), 0.99));
  reportLastStep(found, given);
  if (drift.pieces == 0) return;
  fmt::print("its drift against poses.txt over {:.0f} m: {:.2f} %, {:.3f} degrees\n", drift.length,
             100.0 * drift.translation, drift.rotation * 180.0 / kPi);
}

/// As a sequence's own poses.txt, in a frame of their own.
void writeFoundPoses(const fs::path& out, const DriveRun& drive) {
  if (drive.tracked().empty()) return;
  WholeFile file(out / "poses.txt");
  for (const TrackedScan& tracked : drive.tracked()) {
    file.stream() << poseLine(Pose::fromIsometry(tracked.odom_from_sensor));
  }
  file.commit();
}

void run(const CLI::App& app, const Arguments& arguments, const ConfigOptions& options) {
  const Config config = options.config();
  const SequenceReader sequence = openSequence(app, arguments.sequence);
  const bool is_from_scans = arguments.odometry == "lidar";
  prepareOutput(arguments);
  const std::size_t scans = scansOf(sequence, arguments.frames);
  DriveRun drive(config, is_from_scans ? DriveOdometry::kLidar : DriveOdometry::kGiven);
  drive.cutScansInto(arguments.parts);
  const Run run = runSequence(sequence, scans, drive, arguments.out);
  report(run, config, drive, sequence.hasLabels());
  reportOdometry(sequence, drive);
  reportCompletion(drive);
  reportCheck(drive);
  if (arguments.out.empty()) return;
  writeRunFigures(arguments.out, figuresOf(drive, config));
  writeFoundPoses(arguments.out, drive);
}

}  // namespace
}  // namespace donex

int main(int argc, char** argv) {
  CLI::App app("Labels the echoes of a sequence (SemanticKITTI layout) dynamic or static.", "donex_sequence");
  donex::Arguments arguments;
  app.add_option("SEQ_DIR", arguments.sequence, "velodyne/NNNNNN.bin, poses.txt, times.txt, labels/")->required();
  app.add_option(
      "--out", arguments.out,
      "directory for NNNNNN.label (251 moving, 9 static), and for poses.txt where poses are found from the scans; "
      "without it only figures");
  app.add_option("--frames", arguments.frames, "only the first N scans")->check(CLI::PositiveNumber);
  app.add_option("--odometry", arguments.odometry,
                 "given: the poses of poses.txt; lidar: found from the scans, and compared with those; by default " +
                     arguments.odometry)
      ->check(CLI::IsMember({"given", "lidar"}));
  app.add_option("--parts", arguments.parts,
                 "cut each scan into N sectors that are judged one after the other, at times of their own; labels, "
                 "times and figures are those of whole scans")
      ->check(CLI::Range(std::size_t{1}, donex::ScanParts::kMost));
  donex::addOverwrite(app, arguments.overwrite);
  const donex::ConfigOptions options(app);
  return donex::runProgram(app, argc, argv, [&] { donex::run(app, arguments, options); });
}
