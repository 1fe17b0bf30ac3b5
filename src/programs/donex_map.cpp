// A map of what stands still, from a sequence or a bag.
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "evaluation/map_score.h"
#include "io/number_text.h"
#include "io/outputs.h"
#include "io/sequence.h"
#include "io/static_map.h"
#include "programs/program.h"
#ifdef DONEX_WITH_BAGS
#include "bag/ground_truth.h"
#include "bag/label_bag.h"
#endif

namespace donex {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string in, out;
  double map_voxel = 0.1;    ///< [m]
  double range = 50.0;       ///< [m]
  std::size_t memory = 500;  ///< [MB]
  std::size_t frames = 0;    ///< 0: all
  bool compare = false;
  bool overwrite = false;
  std::string points, odom;
};

/// In percent; "-" where there is no figure.
std::string percent(double rate) { return std::isnan(rate) ? "-" : fmt::format("{:.2f} %", 100.0 * rate); }

/// Takes the static echoes of scans into the map, and scores what it took where the truth is known.
class Mapper {
 public:
  explicit Mapper(const Arguments& arguments)
      : range_(arguments.range), map_(arguments.out, arguments.map_voxel, arguments.memory * 1000000U) {}

  void add(const Scan& scan, const EchoLabels& labels, const std::vector<std::uint32_t>& truth) {
    const Eigen::Isometry3d odom_from_sensor = scan.odomFromSensor();
    for (std::size_t i = 0; i < scan.echoes.size(); ++i) {
      const bool is_in_range = scan.echoes[i].head<2>().norm() <= range_ && std::abs(scan.echoes[i].z()) <= range_;
      if (!is_in_range) continue;
      const Eigen::Vector3d point = odom_from_sensor * scan.echoes[i].cast<double>();
      const bool is_kept = labels.dynamic[i] == 0;
      if (is_kept) map_.add(point);
      if (!truth.empty() && isScored(truth[i])) score_.add(point, isMoving(truth[i]), is_kept);
      kept_ += is_kept ? 1U : 0U;
      ++echoes_;
    }
    map_.settle(odom_from_sensor.translation());
    ++scans_;
  }

  void report(const Arguments& arguments) {
    const std::size_t tiles = map_.tilesPutAway();
    const std::size_t points = map_.write();
    fmt::print("{} scans, {} of {} echoes kept as static; {} points of {} m in {}\n", scans_, kept_, echoes_, points,
               numberText(arguments.map_voxel), arguments.out);
    const Eigen::Vector3d origin = map_.origin();
    if (!origin.isZero(0.0)) {
      fmt::print("coordinates begin at {} {} {} of the odometry frame\n", numberText(origin.x()),
                 numberText(origin.y()), numberText(origin.z()));
    }
    fmt::print("peak memory: {}; {} tiles were put away on the way\n", megabytes(peakMemory()), tiles);
    if (!arguments.compare) return;
    const MapScore::Rates r = score_.rates();
    fmt::print("\nby voxel of 0.2 m (ERASOR):   PR {}  RR {}  F1 {}   ({} static, {} dynamic voxels)\n",
               percent(r.preservation), percent(r.rejection), std::isnan(r.f1) ? "-" : fmt::format("{:.4f}", r.f1),
               r.static_voxels, r.dynamic_voxels);
    fmt::print("by echo (DynamicMap_Benchmark): SA {}  DA {}  AA {}   ({} static, {} moving)\n",
               percent(r.static_accuracy), percent(r.dynamic_accuracy), percent(r.associated), r.static_echoes,
               r.dynamic_echoes);
  }

 private:
  double range_;
  StaticMap map_;
  MapScore score_;
  std::size_t scans_ = 0, echoes_ = 0, kept_ = 0;
};

void mapSequence(const CLI::App& app, const Arguments& arguments, const Config& config, Mapper& mapper) {
  const SequenceReader sequence = openSequence(app, arguments.in);
  if (arguments.compare) requireTruth(sequence);
  const std::size_t scans = scansOf(sequence, arguments.frames);
  DriveRun drive(config);
  ProgressBar progress(scans * drive.passes());
  const auto take = [&](std::size_t i, const Scan& scan, const EchoLabels& labels) {
    const bool has_truth = arguments.compare && sequence.hasLabels(i);
    mapper.add(scan, labels, has_truth ? sequence.labels(i) : std::vector<std::uint32_t>());
  };
  drive.run(sequence, scans, take, [&] { progress.advance(); });
}

#ifdef DONEX_WITH_BAGS
void mapBag(const CLI::App& app, const Arguments& arguments, const Config& config, Mapper& mapper) {
  LabelBagOptions options;
  options.points = arguments.points;
  options.odom = arguments.odom;
  options.config = config;
  std::optional<ProgressBar> progress;
  bool has_truth = false;
  const auto take = [&](const LabeledScan& scan, const ros::Time&, std::size_t) {
    const auto truth = arguments.compare ? truthOf(*scan.cloud, scan.layout) : std::vector<std::uint32_t>();
    has_truth = has_truth || !truth.empty();
    mapper.add(scan.scan, scan.labels, truth);
  };
  const auto summary = judgeBag({arguments.in}, options, take, [&](std::size_t, std::size_t total) {
    if (!progress) progress.emplace(total);
    progress->advance();
  });
  progress.reset();
  for (const std::string& remark : summary.remarks) warn(app, remark);
  if (!arguments.compare || has_truth) return;
  throw DataError(
      fmt::format("{}: no cloud on {} has a field label (UINT32) to score by", arguments.in, summary.points));
}
#endif

void run(const CLI::App& app, const Arguments& arguments, const Config& config) {
  const fs::path directory = fs::absolute(arguments.out).parent_path();
  if (!fs::is_directory(directory)) throw DataError(directory.string() + ": is not a directory");
  const bool is_bag = fs::path(arguments.in).extension() == ".bag";
  Outputs outputs(arguments.overwrite);
  is_bag ? outputs.addInput(arguments.in) : outputs.addSequence(arguments.in);
  outputs.require(arguments.out);
  Mapper mapper(arguments);
#ifdef DONEX_WITH_BAGS
  if (is_bag && arguments.frames != 0) throw ArgumentError("--frames is for sequences");
  const bool has_topics = !arguments.points.empty() || !arguments.odom.empty();
  if (!is_bag && has_topics) throw ArgumentError("--points and --odom are for bags");
  is_bag ? mapBag(app, arguments, config, mapper) : mapSequence(app, arguments, config, mapper);
#else
  if (is_bag) throw ArgumentError(arguments.in + ": this donex_map was built without ROS and reads no bags");
  mapSequence(app, arguments, config, mapper);
#endif
  mapper.report(arguments);
}

}  // namespace
}  // namespace donex

int main(int argc, char** argv) {
  CLI::App app("Builds a map (PCD) of the static echoes of a drive, with any method.", "donex_map");
  donex::Arguments arguments;
  app.add_option("IN", arguments.in, "a .bag, or a sequence directory")->required();
  app.add_option("OUT.pcd", arguments.out, "x, y, z in the odometry frame, one point per voxel")->required();
  app.add_option("--map-voxel", arguments.map_voxel, "edge of a voxel of the map [m], by default 0.1")
      ->check(CLI::Range(0.01, 10.0));
  app.add_option("--range", arguments.range, "echoes within this range of the sensor [m], by default 50")
      ->check(CLI::PositiveNumber);
  app.add_option("--memory", arguments.memory, "most memory that the map's voxels take [MB], by default 500")
      ->check(CLI::Range(1, 10000000));
  app.add_option("--frames", arguments.frames, "only the first N scans of a sequence")->check(CLI::PositiveNumber);
  app.add_flag("--compare", arguments.compare,
               "score the map by the labels of the sequence or of the bag's clouds: PR, RR, F1, SA, DA, AA");
  app.add_option("--points", arguments.points, "topic of a bag's clouds; needed where there are several");
  app.add_option("--odom", arguments.odom, "topic of a bag's odometry; needed where there are several");
  donex::addOverwrite(app, arguments.overwrite);
  const donex::ConfigOptions config(app);
  donex::Config defaults;
  defaults.motion.source = donex::OdometrySource::kAuto;  // of bags; a sequence has poses
  return donex::runProgram(app, argc, argv, [&] { donex::run(app, arguments, config.config(defaults)); });
}
