// Moving IoU, precision and recall of labels against ground truth.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace donex {

/// What is scored: the rules that all figures of this package's README follow.
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

/// The score of one predictor over one sequence (or several).
class Evaluation {
 public:
  explicit Evaluation(const ScoringRules& rules = {}) : rules_(rules) {}

  bool scores(std::size_t scan_index) const { return scan_index >= rules_.first_scan; }

  /// Adds a scan: echoes in the sensor frame, SemanticKITTI labels of truth and prediction. A scan before
  /// first_scan is ignored. Throws std::invalid_argument when the three differ in number: nothing is guessed.
  void add(std::size_t scan_index, const std::vector<Eigen::Vector3f>& echoes, const std::vector<std::uint32_t>& truth,
           const std::vector<std::uint32_t>& prediction);

  std::size_t scans() const { return scans_; }
  const Counts& total() const { return total_; }
  /// By true class (lower 16 bits of the label).
  const std::map<std::uint32_t, Counts>& byClass() const { return by_class_; }
  /// By band of kRangeBand.
  const std::vector<Counts>& byRange() const { return by_range_; }

 private:
  void addEcho(double range, std::uint32_t truth, bool said_moving);

  ScoringRules rules_;
  std::size_t scans_ = 0;
  Counts total_;
  std::map<std::uint32_t, Counts> by_class_;
  std::vector<Counts> by_range_;
};

/// SemanticKITTI's name of a class ("moving car"), or "class N".
std::string className(std::uint32_t label);

/// A column of the tables below.
struct NamedEvaluation {
  std::string name;
  const Evaluation* evaluation = nullptr;
};

/// Text tables, predictions side by side: overall, by class, by range.
std::string formatEvaluations(const std::vector<NamedEvaluation>& columns);

}  // namespace donex
