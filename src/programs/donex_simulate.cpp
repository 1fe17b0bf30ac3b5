// A simulated drive as a sequence or as a bag, with ground truth.
#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "donex/motion/ego_motion.h"
#include "io/number_text.h"
#include "io/outputs.h"
#include "io/sequence.h"
#include "programs/option_adder.h"
#include "programs/program.h"
#include "simulation/simulator.h"
#ifdef DONEX_WITH_BAGS
#include "bag/bag_file.h"
#include "bag/simulation_bag.h"
#endif

namespace donex {
namespace {

using simulation::OdometryOptions;
using simulation::SimulatedScan;
using simulation::Simulator;
using simulation::SimulatorOptions;

struct Arguments {
  std::string scene, out;
  std::string poses = "true";
  std::string compression = "none";
  bool overwrite = false;
  SimulatorOptions options;
};

std::string listOfPatterns() {
  std::string text;
  for (const simulation::Pattern& pattern : simulation::patterns()) {
    text += fmt::format("{:<18} {}\n", pattern.name, pattern.meaning);
  }
  return text;
}

std::string listOfRigs() {
  std::string text;
  for (const simulation::Rig& rig : simulation::rigs()) text += fmt::format("{:<18} {}\n", rig.name, rig.meaning);
  return text;
}

std::string listOfScenes() {
  std::string text;
  for (const std::string& name : simulation::sceneNames()) {
    text += fmt::format("{:<18} {}\n", name, simulation::sceneMeaning(name));
  }
  return text;
}

void check(const Arguments& arguments) {
  std::vector<std::string> faults = simulation::faultsOf(arguments.scene, arguments.options);
  const bool endless = arguments.options.duration == 0.0;
  if (endless) faults.emplace_back("duration is 0: no file is endless");
  if (!faults.empty()) throw ArgumentError(fmt::format("{}", fmt::join(faults, "\n")));
}

/// The scan as the layout holds it; its pose is the true one or what the odometry says.
class SequenceScans {
 public:
  SequenceScans(bool from_odometry, const OdometryOptions& odometry) : from_odometry_(from_odometry) {
    constexpr double kMargin = 0.1;  // [s]
    const double period = 1.0 / odometry.rate;
    EgoMotion::Options options;
    options.max_gap = period + kMargin;
    // Odometry that comes late or seldom: the newest is known.
    options.max_extrapolation = period + std::max(0.0, -odometry.stamp_offset) + kMargin;
    motion_ = EgoMotion(options);
  }

  SequenceScan convert(const SimulatedScan& scan) {
    for (const OdometrySample& sample : scan.odometry) motion_.add(sample);
    SequenceScan result;
    result.stamp = scan.sent;
    for (const simulation::SimulatedEcho& echo : scan.echoes) {
      result.echoes.push_back(echo.position);
      result.intensities.push_back(echo.intensity);
    }
    const Eigen::Isometry3d odom_from_base = from_odometry_ ? reported(scan.stamp) : scan.odom_from_base;
    result.odom_from_sensor = Pose::fromIsometry(odom_from_base * scan.base_from_sensor);
    return result;
  }

 private:
  Eigen::Isometry3d reported(double stamp) const {
    const auto pose = motion_.poseAt(stamp);
    if (!pose) throw DataError(fmt::format("no pose at {} s: {}", numberText(stamp), describe(pose.fault())));
    return *pose;
  }

  bool from_odometry_;
  EgoMotion motion_;
};

struct Count {
  std::size_t echoes = 0, moving = 0;
};

void writeSequence(const CLI::App& app, const Arguments& arguments) {
  if (arguments.options.mountings().size() > 1) {
    throw ArgumentError("a sequence cannot tell which sensor a scan is of: write a bag of rig " +
                        arguments.options.rig);
  }
  if (arguments.options.distortion) {
    warn(app, "the layout of a sequence has no time for each echo: the distortion cannot be undone; write a bag");
  }
  Simulator simulator(arguments.scene, arguments.options);
  SequenceWriter writer(arguments.out, arguments.overwrite);
  SequenceScans scans(arguments.poses == "odometry", arguments.options.odometry);
  std::optional<ProgressBar> progress(simulator.size());
  SimulatedScan scan;
  Count count;
  while (simulator.next(scan)) {
    writer.add(scans.convert(scan), scan.labels);
    count.echoes += scan.echoes.size();
    count.moving += static_cast<std::size_t>(std::count_if(scan.labels.begin(), scan.labels.end(), isMoving));
    progress->advance();
  }
  progress.reset();
  const double percent =
      100.0 * static_cast<double>(count.moving) / static_cast<double>(std::max<std::size_t>(count.echoes, 1));
  fmt::print("{} scans, {} echoes, {:.2f} % of them moving\n", writer.size(), count.echoes, percent);
}

#ifdef DONEX_WITH_BAGS
void writeBag(const CLI::App& app, Arguments& arguments) {
  double& start = arguments.options.start_stamp;
  const double least = leastStart(arguments.options.odometry);
  const bool is_asked_for_less = app.count("--start-stamp") > 0 && start < least;
  if (is_asked_for_less) {
    warn(app, fmt::format("start_stamp is {} s, not {} s: a bag knows no time before 0", numberText(least),
                          numberText(start)));
  }
  start = std::max(start, least);
  Simulator simulator(arguments.scene, arguments.options);
  std::optional<ProgressBar> progress(simulator.size());
  const auto summary = writeSimulationBag(simulator, arguments.out, parseCompression(arguments.compression),
                                          [&] { progress->advance(); });
  progress.reset();
  fmt::print("{} clouds on /points, {} odometry messages on /odom, tf odom <- base_link <- {}\n", summary.clouds,
             summary.odometry, fmt::join(summary.frames, ", "));
}

#else
void writeBag(const CLI::App&, const Arguments&) { throw ArgumentError("this program was built without ROS: no bags"); }
#endif

void run(const CLI::App& app, Arguments& arguments) {
  check(arguments);
  const bool is_bag = std::filesystem::path(arguments.out).extension() == ".bag";
  if (is_bag) Outputs(arguments.overwrite).require(arguments.out);
  is_bag ? writeBag(app, arguments) : writeSequence(app, arguments);
}

}  // namespace
}  // namespace donex

int main(int argc, char** argv) {
  CLI::App app("Writes a simulated drive with ground truth.", "donex_simulate");
  donex::Arguments arguments;
  app.footer("Scenes:\n" + donex::listOfScenes() + "\nPatterns:\n" + donex::listOfPatterns() + "\nRigs:\n" +
             donex::listOfRigs());
  app.add_option("SCENE", arguments.scene, "one of the scenes below")->required();
  app.add_option("OUT", arguments.out, "a .bag, or a directory for a sequence (SemanticKITTI layout)")->required();
  app.add_option("--poses", arguments.poses, "of a sequence: true, or odometry with its errors; by default true")
      ->check(CLI::IsMember({"true", "odometry"}));
  app.add_option("--compression", arguments.compression, "of a bag: none, lz4 or bz2; by default none")
      ->check(CLI::IsMember({"none", "lz4", "bz2"}));
  donex::addOverwrite(app, arguments.overwrite);
  visitOptions(arguments.options, donex::OptionAdder{app});
  return donex::runProgram(app, argc, argv, [&] { donex::run(app, arguments); });
}
