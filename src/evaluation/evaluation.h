// Moving IoU, precision and recall of labels against ground truth.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace donex {

/// What is scored: the rules that all figures of docs/results.md follow.
struct ScoringRules {
  std::size_t first_scan = 5;  ///< scans before are warm-up
  double max_range = 50.0;     ///< of the sensor in x, y [m]
};

/// Pooled echoes. A ratio without a denominator is NaN.
struct Counts {
  std::uint64_t true_positives = 0;
  std::uint64_t false_positives = 0;
  std::uint64_t false_negatives = 0;
  std::uint64_t true_negatives = 0;

  void add(bool truly_moving, bool said_moving);
  std::uint64_t total() const;
  std::uint64_t moving() const { return true_positives + false_negatives; }
  double iou() const;
  double precision() const;
  double recall() const;
  /// Of all echoes that are in truth static: those called moving.
  double falsePositiveRate() const;
};

/// Ranges are split every 10 m: [0, 10), ..., [40, 50], and on to max_range.
inline constexpr double kRangeBand = 10.0;  // [m]

/// Speeds are split here [m/s]: below 1, 1 to 3, 3 to 8, 8 to 15, and above.
inline constexpr std::array<double, 4> kSpeedBandEnds{1.0, 3.0, 8.0, 15.0};
/// The band of a speed, 0 to kSpeedBandEnds.size(), and its name ("3 to 8 m/s").
std::size_t speedBand(double speed);
std::string speedBandName(std::size_t band);

/// Objects, not echoes: a moving instance in a scan is found when at least half of its scored echoes are called
/// moving. Those with fewer scored echoes than kLeastEchoes are not counted.
struct ObjectCounts {
  std::uint64_t found = 0;
  std::uint64_t all = 0;
  double recall() const;

  static constexpr std::uint64_t kLeastEchoes = 10;
};

/// The score of one predictor over one sequence (or several).
class Evaluation {
 public:
  explicit Evaluation(const ScoringRules& rules = {}) : rules_(rules) {}

  bool scores(std::size_t scan_index) const { return scan_index >= rules_.first_scan; }

  /// Adds a scan: echoes in the sensor frame, SemanticKITTI labels of truth and prediction. A scan before
  /// first_scan is ignored. Throws std::invalid_argument when the three differ in number.
  void add(std::size_t scan_index, const std::vector<Eigen::Vector3f>& echoes, const std::vector<std::uint32_t>& truth,
           const std::vector<std::uint32_t>& prediction);

  /// The same; `speed_of` tells the speed of a label's instance [m/s], or nothing, and fills bySpeed.
  using SpeedOf = std::function<std::optional<double>(std::uint32_t label)>;
  void add(std::size_t scan_index, const std::vector<Eigen::Vector3f>& echoes, const std::vector<std::uint32_t>& truth,
           const std::vector<std::uint32_t>& prediction, const SpeedOf& speed_of);

  std::size_t scans() const { return scans_; }
  /// False moving objects (phantoms.h), and their mean per scan; NaN without scans.
  std::size_t phantoms() const { return phantoms_; }
  double phantomsPerScan() const;
  const Counts& total() const { return total_; }
  /// By true class (lower 16 bits of the label).
  const std::map<std::uint32_t, Counts>& byClass() const { return by_class_; }
  /// By band of kRangeBand.
  const std::vector<Counts>& byRange() const { return by_range_; }
  /// Moving instances by band of speed (kSpeedBandEnds): only their hits and misses; instances without a speed are left
  /// out.
  const std::array<Counts, kSpeedBandEnds.size() + 1>& bySpeed() const { return by_speed_; }
  /// Moving instances, once per scan, and by true class.
  const ObjectCounts& objects() const { return objects_; }
  const std::map<std::uint32_t, ObjectCounts>& objectsByClass() const { return objects_by_class_; }

 private:
  void addEcho(double range, std::uint32_t truth, bool said_moving);
  void addObject(std::uint32_t truth, const Counts& counts, const std::optional<double>& speed);

  ScoringRules rules_;
  std::size_t scans_ = 0;
  std::size_t phantoms_ = 0;
  Counts total_;
  std::map<std::uint32_t, Counts> by_class_;
  std::vector<Counts> by_range_;
  std::array<Counts, kSpeedBandEnds.size() + 1> by_speed_;
  ObjectCounts objects_;
  std::map<std::uint32_t, ObjectCounts> objects_by_class_;
};

/// SemanticKITTI's name of a class ("moving car"), or "class N".
std::string className(std::uint32_t label);

/// What making a prediction took, where that is known.
struct RunFigures {
  std::string method;  ///< and its settings, in words
  std::size_t scans = 0;
  double median_time = 0.0, p99_time = 0.0, median_cpu_time = 0.0;  ///< per scan [s]; CPU 0: not measured
  double mean_cpu_time = 0.0;                                       ///< per scan, all passes [s]; 0: not measured
  std::size_t peak_memory = 0, method_memory = 0;  ///< of the process, of the method alone (0: not known) [bytes]
};

/// A column of the tables below.
struct NamedEvaluation {
  std::string name;
  const Evaluation* evaluation = nullptr;
  std::optional<RunFigures> figures = std::nullopt;
};

/// Text tables, predictions side by side: overall with time and memory, by class, by range, by speed.
std::string formatEvaluations(const std::vector<NamedEvaluation>& columns);

}  // namespace donex
