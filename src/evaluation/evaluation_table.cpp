#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "evaluation/evaluation.h"
#include "io/number_text.h"
#include "io/sequence.h"

namespace donex {
namespace {

const std::map<std::uint32_t, std::string>& classNames() {
  static const std::map<std::uint32_t, std::string> names{{9, "static"},
                                                          {10, "car"},
                                                          {11, "bicycle"},
                                                          {13, "bus"},
                                                          {15, "motorcycle"},
                                                          {16, "on-rails"},
                                                          {18, "truck"},
                                                          {20, "other vehicle"},
                                                          {30, "person"},
                                                          {31, "bicyclist"},
                                                          {32, "motorcyclist"},
                                                          {40, "road"},
                                                          {44, "parking"},
                                                          {48, "sidewalk"},
                                                          {49, "other ground"},
                                                          {50, "building"},
                                                          {51, "fence"},
                                                          {52, "other structure"},
                                                          {60, "lane marking"},
                                                          {70, "vegetation"},
                                                          {71, "trunk"},
                                                          {72, "terrain"},
                                                          {80, "pole"},
                                                          {81, "traffic sign"},
                                                          {99, "other object"},
                                                          {251, "moving"},
                                                          {252, "moving car"},
                                                          {253, "moving bicyclist"},
                                                          {254, "moving person"},
                                                          {255, "moving motorcyclist"},
                                                          {256, "moving on-rails"},
                                                          {257, "moving bus"},
                                                          {258, "moving truck"},
                                                          {259, "moving other vehicle"}};
  return names;
}

std::string number(double value) { return std::isnan(value) ? "-" : fmt::format("{:.4f}", value); }

/// First column to the left, all others to the right, as wide as their widest cell.
std::string formatRows(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    text += fmt::format("{:<{}}", row[0], widths[0]);
    for (std::size_t i = 1; i < row.size(); ++i) text += fmt::format("  {:>{}}", row[i], widths[i]);
    text += '\n';
  }
  return text;
}

/// What a prediction took, where that is known.
std::vector<std::string> figuresOf(const NamedEvaluation& column) {
  if (!column.figures) return {"-", "-", "-"};
  const RunFigures& figures = *column.figures;
  return {fmt::format("{:.1f} ms", 1e3 * figures.median_time),
          figures.mean_cpu_time == 0.0 ? "-" : fmt::format("{:.1f} ms", 1e3 * figures.mean_cpu_time),
          fmt::format("{:.0f} MB", 1e-6 * static_cast<double>(figures.peak_memory))};
}

std::string overallTable(const std::vector<NamedEvaluation>& columns) {
  std::vector<std::vector<std::string>> rows{
      {"prediction", "IoU", "P", "R", "scans", "echoes", "moving", "objects", "phantoms", "a scan", "CPU", "memory"}};
  for (const auto& column : columns) {
    const Counts& total = column.evaluation->total();
    const ObjectCounts& objects = column.evaluation->objects();
    rows.push_back({column.name, number(total.iou()), number(total.precision()), number(total.recall()),
                    fmt::format("{}", column.evaluation->scans()), fmt::format("{}", total.total()),
                    fmt::format("{}", total.moving()), fmt::format("{} of {}", objects.found, objects.all),
                    fmt::format("{:.2f} a scan", column.evaluation->phantomsPerScan())});
    for (const std::string& figure : figuresOf(column)) rows.back().push_back(figure);
  }
  return formatRows(rows);
}

std::vector<std::string> header(const std::string& first, const std::vector<NamedEvaluation>& columns) {
  std::vector<std::string> row{first, "echoes"};
  for (const auto& column : columns) row.push_back(column.name);
  return row;
}

Counts countsOf(const Evaluation& evaluation, std::uint32_t label) {
  const auto found = evaluation.byClass().find(label);
  return found == evaluation.byClass().end() ? Counts() : found->second;
}

/// Share of a class's echoes with the right label: recall of moving classes, 1 - false positive rate of others.
std::string classTable(const std::vector<NamedEvaluation>& columns) {
  std::set<std::uint32_t> labels;
  for (const auto& column : columns) {
    for (const auto& entry : column.evaluation->byClass()) labels.insert(entry.first);
  }
  std::vector<std::vector<std::string>> rows{header("echoes labelled right, by class", columns)};
  for (const std::uint32_t label : labels) {
    std::uint64_t echoes = 0;
    std::vector<std::string> cells;
    for (const auto& column : columns) {
      const Counts counts = countsOf(*column.evaluation, label);
      echoes = std::max(echoes, counts.total());
      cells.push_back(number(isMoving(label) ? counts.recall() : 1.0 - counts.falsePositiveRate()));
    }
    cells.insert(cells.begin(), {className(label), fmt::format("{}", echoes)});
    rows.push_back(cells);
  }
  return formatRows(rows);
}

std::string rangeTable(const std::vector<NamedEvaluation>& columns) {
  std::size_t bands = 0;
  for (const auto& column : columns) bands = std::max(bands, column.evaluation->byRange().size());
  std::vector<std::vector<std::string>> rows{header("IoU / P / R, by range", columns)};
  for (std::size_t band = 0; band < bands; ++band) {
    std::uint64_t moving = 0;
    std::vector<std::string> cells;
    for (const auto& column : columns) {
      const auto& by_range = column.evaluation->byRange();
      const Counts counts = band < by_range.size() ? by_range[band] : Counts();
      moving = std::max(moving, counts.moving());
      cells.push_back(
          fmt::format("{} / {} / {}", number(counts.iou()), number(counts.precision()), number(counts.recall())));
    }
    const double from = kRangeBand * static_cast<double>(band);
    cells.insert(cells.begin(), {fmt::format("{} to {} m", numberText(from), numberText(from + kRangeBand)),
                                 fmt::format("{}", moving)});
    rows.push_back(cells);
  }
  rows.front()[1] = "moving";
  return formatRows(rows);
}

/// Recall of moving instances by their speed; no row where the labels have no instances.
std::string speedTable(const std::vector<NamedEvaluation>& columns) {
  std::vector<std::vector<std::string>> rows{header("recall of moving instances, by speed", columns)};
  for (std::size_t band = 0; band <= kSpeedBandEnds.size(); ++band) {
    std::uint64_t moving = 0;
    std::vector<std::string> cells;
    for (const auto& column : columns) {
      const Counts& counts = column.evaluation->bySpeed()[band];
      moving = std::max(moving, counts.moving());
      cells.push_back(number(counts.recall()));
    }
    if (moving == 0) continue;
    cells.insert(cells.begin(), {speedBandName(band), fmt::format("{}", moving)});
    rows.push_back(cells);
  }
  return rows.size() == 1 ? "" : '\n' + formatRows(rows);
}

}  // namespace

std::string speedBandName(std::size_t band) {
  if (band == 0) return fmt::format("below {} m/s", numberText(kSpeedBandEnds.front()));
  if (band == kSpeedBandEnds.size()) return fmt::format("{} m/s and more", numberText(kSpeedBandEnds.back()));
  return fmt::format("{} to {} m/s", numberText(kSpeedBandEnds[band - 1]), numberText(kSpeedBandEnds[band]));
}

std::string className(std::uint32_t label) {
  const auto found = classNames().find(classOfLabel(label));
  return found == classNames().end() ? fmt::format("class {}", classOfLabel(label)) : found->second;
}

std::string formatEvaluations(const std::vector<NamedEvaluation>& columns) {
  return overallTable(columns) + '\n' + classTable(columns) + '\n' + rangeTable(columns) + speedTable(columns);
}

}  // namespace donex
