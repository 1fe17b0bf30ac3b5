// Predictions scored side by side on a sequence, with a picture of a scan, and reports of several such comparisons.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "evaluation/evaluation.h"
#include "io/data_error.h"
#include "io/sequence.h"

namespace donex {

/// How an echo was labelled; where several fall into one cell of a picture, the last of these is shown.
enum class EchoOutcome : std::uint8_t {
  kStatic,      ///< rightly static, or not judged and called static
  kUnjudged,    ///< called dynamic where the truth says nothing
  kFound,       ///< rightly dynamic
  kFalseAlarm,  ///< static in truth, called dynamic
  kMissed,      ///< dynamic in truth, called static
};

/// A scan from above: the occupied cells of a square around the sensor, and the outcome of each prediction there.
struct BirdView {
  std::size_t scan = 0;
  std::vector<std::uint16_t> cells;                 ///< column (along x), row (along y), ...
  std::vector<std::vector<std::uint8_t>> outcomes;  ///< by prediction: an EchoOutcome per cell

  static constexpr double kCell = 0.2;  ///< [m]
  static constexpr int kWidth = 500;    ///< cells along an edge: 50 m to each side
};

/// `predictions` may hold empty ones (nothing was predicted there); others have a label per echo.
BirdView makeBirdView(std::size_t scan, const std::vector<Eigen::Vector3f>& echoes,
                      const std::vector<std::uint32_t>& truth,
                      const std::vector<std::vector<std::uint32_t>>& predictions);

/// One directory of label files.
struct ScoredPrediction {
  std::string name;
  std::filesystem::path directory;
  Evaluation evaluation;
  std::optional<RunFigures> figures;
  Faults faults;  ///< scans whose file is missing or has another number of labels: left out
};

struct SequenceComparison {
  std::string name;
  std::size_t scans = 0;
  std::vector<ScoredPrediction> predictions;
  std::optional<BirdView> view;  ///< of the scored scan with most moving echoes, in the second half if any

  std::vector<NamedEvaluation> columns() const;
};

/// Scores label files (NNNNNN.label, anybody's) of the first `scans` scans. `progress` is called once per scan.
/// Throws DataError where the sequence cannot be read.
SequenceComparison compareOnSequence(const SequenceReader& sequence, std::size_t scans,
                                     const std::vector<std::pair<std::string, std::filesystem::path>>& predictions,
                                     const std::function<void()>& progress);

/// What the report says of a method beside its figures.
struct MethodNote {
  std::string name, what, source;
  bool live = true;
};

/// One line of the paper's Table 1 [s]; a time of 0 was not measured.
struct Table1Row {
  double voxel_size = 0.0;  ///< [m]
  std::string published_2d, published_3d;
  double measured_2d = 0.0, measured_3d = 0.0, measured_z_buffer = 0.0;
};

struct Comparison {
  std::string title, command;
  std::vector<SequenceComparison> sequences;
  std::vector<MethodNote> methods;
  std::vector<Table1Row> table_1;
  std::string table_1_setting;  ///< what was measured there, in words
};

std::string toJson(const Comparison& comparison);
/// One entry of that document's "predictions".
std::string toJson(const ScoredPrediction& prediction);
/// One line per sequence, prediction, group (total, class, range, speed) and member.
std::string toCsv(const Comparison& comparison);
/// One page that holds all it shows: no other file, no network.
std::string toHtml(const Comparison& comparison);

/// The figures of a run beside its label files, run.json. Empty where the file is missing; throws DataError where it
/// cannot be understood.
void writeRunFigures(const std::filesystem::path& directory, const RunFigures& figures);
std::optional<RunFigures> readRunFigures(const std::filesystem::path& directory);

}  // namespace donex
