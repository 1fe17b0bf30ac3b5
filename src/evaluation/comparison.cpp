#include "evaluation/comparison.h"

#include <algorithm>

#include <fmt/format.h>

#include "evaluation/object_speeds.h"

namespace donex {
namespace {

namespace fs = std::filesystem;
using Labels = std::vector<std::uint32_t>;

/// The labels of a scan, or nothing and a fault.
std::optional<Labels> readPrediction(ScoredPrediction& prediction, std::size_t index, std::size_t echoes) {
  const fs::path file = prediction.directory / (scanName(index) + ".label");
  try {
    Labels labels = readLabels(file);
    if (labels.size() == echoes) return labels;
    prediction.faults.add(fmt::format("{}: {} labels for {} echoes, not scored", file.string(), labels.size(), echoes));
  } catch (const DataError& error) {
    prediction.faults.add(std::string(error.what()) + ", not scored");
  }
  return std::nullopt;
}

void scoreScan(const SequenceReader& sequence, std::size_t index, const ObjectSpeeds& speeds, const Labels& truth,
               std::vector<ScoredPrediction>& predictions) {
  const std::vector<Eigen::Vector3f> echoes = sequence.scan(index).echoes;
  const auto speed_of = [&](std::uint32_t label) { return speeds.at(label, sequence.stamp(index)); };
  for (ScoredPrediction& prediction : predictions) {
    const auto labels = readPrediction(prediction, index, echoes.size());
    if (labels) prediction.evaluation.add(index, echoes, truth, *labels, speed_of);
  }
}

BirdView viewOf(const SequenceReader& sequence, std::size_t index, const std::vector<ScoredPrediction>& predictions) {
  const std::vector<Eigen::Vector3f> echoes = sequence.scan(index).echoes;
  std::vector<Labels> labels;
  labels.reserve(predictions.size());
  for (ScoredPrediction prediction : predictions) {  // a copy: its faults have been told
    labels.push_back(readPrediction(prediction, index, echoes.size()).value_or(Labels()));
  }
  return makeBirdView(index, echoes, sequence.labels(index), labels);
}

}  // namespace

std::vector<NamedEvaluation> SequenceComparison::columns() const {
  std::vector<NamedEvaluation> columns;
  for (const ScoredPrediction& prediction : predictions) {
    columns.push_back({prediction.name, &prediction.evaluation, prediction.figures});
  }
  return columns;
}

SequenceComparison compareOnSequence(const SequenceReader& sequence, std::size_t scans,
                                     const std::vector<std::pair<std::string, fs::path>>& predictions,
                                     const std::function<void()>& progress) {
  SequenceComparison comparison;
  comparison.name = sequence.name();
  comparison.scans = scans;
  for (const auto& [name, labels] : predictions) {
    comparison.predictions.push_back({name, labels, Evaluation(), readRunFigures(labels), Faults()});
  }
  const ObjectSpeeds speeds(sequence, scans);
  std::pair<bool, std::size_t> best{false, 0};  // whether it moves in the second half, moving echoes
  std::optional<std::size_t> best_scan;
  for (std::size_t i = 0; i < scans; ++i) {
    if (sequence.hasLabels(i) && Evaluation().scores(i)) {
      const Labels truth = sequence.labels(i);
      scoreScan(sequence, i, speeds, truth, comparison.predictions);
      const auto moving = static_cast<std::size_t>(std::count_if(truth.begin(), truth.end(), isMoving));
      const std::pair own(moving > 0 && 2 * i >= scans, moving);
      if (!best_scan || own > best) best = own, best_scan = i;
    }
    progress();
  }
  if (best_scan) comparison.view = viewOf(sequence, *best_scan, comparison.predictions);
  return comparison;
}

}  // namespace donex
