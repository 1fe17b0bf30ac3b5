#include <cmath>
#include <fstream>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/comparison.h"
#include "evaluation/report_page.h"
#include "io/number_text.h"
#include "io/sequence.h"
#include "io/whole_file.h"

namespace donex {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string base64(const std::uint8_t* bytes, std::size_t size) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < size; i += 3) {
    std::uint32_t triple = 0;
    for (std::size_t k = 0; k < 3; ++k) triple = triple << 8U | (i + k < size ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= size ? kDigits[triple >> (18U - 6U * k) & 63U] : '=';
    }
  }
  return text;
}

/// A ratio without a denominator is null.
json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json countsOf(const Counts& counts) {
  return {{"tp", counts.true_positives},       {"fp", counts.false_positives},
          {"fn", counts.false_negatives},      {"tn", counts.true_negatives},
          {"iou", number(counts.iou())},       {"precision", number(counts.precision())},
          {"recall", number(counts.recall())}, {"false_positive_rate", number(counts.falsePositiveRate())}};
}

json objectsOf(const ObjectCounts& objects) {
  return {{"found", objects.found}, {"all", objects.all}, {"recall", number(objects.recall())}};
}

/// Null where nothing was measured: 0 would be false.
template <class Figure>
json measured(Figure value) {
  return value == 0 ? json(nullptr) : json(value);
}

json figuresOf(const RunFigures& figures) {
  return {{"method", figures.method},
          {"scans", figures.scans},
          {"median_time", figures.median_time},
          {"p99_time", figures.p99_time},
          {"median_cpu_time", measured(figures.median_cpu_time)},
          {"mean_cpu_time", measured(figures.mean_cpu_time)},
          {"peak_memory", figures.peak_memory},
          {"method_memory", measured(figures.method_memory)}};
}

/// Every group of counts under its name: the one list for JSON and CSV.
template <class Visit>
void visitGroups(const Evaluation& evaluation, Visit&& visit) {
  for (const auto& [label, counts] : evaluation.byClass()) {
    visit("class", fmt::format("{} {}", label, className(label)), counts);
  }
  for (std::size_t band = 0; band < evaluation.byRange().size(); ++band) {
    const double from = kRangeBand * static_cast<double>(band);
    visit("range", fmt::format("{} to {} m", numberText(from), numberText(from + kRangeBand)),
          evaluation.byRange()[band]);
  }
  for (std::size_t band = 0; band < evaluation.bySpeed().size(); ++band) {
    visit("speed", speedBandName(band), evaluation.bySpeed()[band]);
  }
}

json predictionOf(const ScoredPrediction& prediction) {
  const Evaluation& evaluation = prediction.evaluation;
  json result{{"name", prediction.name},
              {"scans", evaluation.scans()},
              {"total", countsOf(evaluation.total())},
              {"phantoms", evaluation.phantoms()},
              {"objects", objectsOf(evaluation.objects())},
              {"objects_by_class", json::array()},
              {"figures", prediction.figures ? figuresOf(*prediction.figures) : json(nullptr)},
              {"faults", prediction.faults.list()}};
  for (const char* group : {"class", "range", "speed"}) result[group] = json::array();
  visitGroups(evaluation, [&](const char* group, const std::string& name, const Counts& counts) {
    json entry = countsOf(counts);
    entry["name"] = name;
    result[group].push_back(entry);
  });
  for (const auto& [label, objects] : evaluation.objectsByClass()) {
    json entry = objectsOf(objects);
    entry["name"] = fmt::format("{} {}", label, className(label));
    result["objects_by_class"].push_back(entry);
  }
  return result;
}

json viewOf(const BirdView& view) {
  std::vector<std::uint8_t> cells;  // little-endian on every machine
  for (const std::uint16_t value : view.cells) {
    cells.push_back(static_cast<std::uint8_t>(value & 0xFFU));
    cells.push_back(static_cast<std::uint8_t>(value >> 8U));
  }
  json result{{"scan", view.scan},
              {"cell", BirdView::kCell},
              {"width", BirdView::kWidth},
              {"cells", base64(cells.data(), cells.size())},
              {"outcomes", json::array()}};
  for (const auto& outcomes : view.outcomes) result["outcomes"].push_back(base64(outcomes.data(), outcomes.size()));
  return result;
}

json table1Of(const Comparison& comparison) {
  json rows = json::array();
  for (const Table1Row& row : comparison.table_1) {
    rows.push_back({{"voxel_size", row.voxel_size},
                    {"published_2d", row.published_2d},
                    {"published_3d", row.published_3d},
                    {"measured_2d", row.measured_2d},
                    {"measured_3d", row.measured_3d},
                    {"measured_z_buffer", row.measured_z_buffer}});
  }
  return {{"setting", comparison.table_1_setting}, {"rows", rows}};
}

json documentOf(const Comparison& comparison, bool with_views) {
  json sequences = json::array();
  for (const SequenceComparison& sequence : comparison.sequences) {
    json entry{{"name", sequence.name}, {"scans", sequence.scans}, {"predictions", json::array()}};
    for (const auto& prediction : sequence.predictions) entry["predictions"].push_back(predictionOf(prediction));
    if (with_views && sequence.view) entry["view"] = viewOf(*sequence.view);
    sequences.push_back(entry);
  }
  json methods = json::array();
  for (const MethodNote& note : comparison.methods) {
    methods.push_back({{"name", note.name}, {"what", note.what}, {"source", note.source}, {"live", note.live}});
  }
  return {{"title", comparison.title},
          {"command", comparison.command},
          {"sequences", sequences},
          {"methods", methods},
          {"table_1", table1Of(comparison)}};
}

/// Names of files need not be valid UTF-8.
std::string textOf(const json& document, int indent = -1) {
  return document.dump(indent, ' ', false, json::error_handler_t::replace);
}

/// A field of a CSV: in quotes where it has to be.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string csvNumber(double value) { return std::isfinite(value) ? fmt::format("{:.6f}", value) : ""; }

std::string csvLine(const std::string& start, const std::string& group, const std::string& name, const Counts& c,
                    const std::string& rest) {
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", start, group, field(name), c.true_positives,
                     c.false_positives, c.false_negatives, c.true_negatives, csvNumber(c.iou()),
                     csvNumber(c.precision()), csvNumber(c.recall()), rest);
}

}  // namespace

std::string toJson(const Comparison& comparison) { return textOf(documentOf(comparison, false), 2) + '\n'; }

std::string toJson(const ScoredPrediction& prediction) { return textOf(predictionOf(prediction)); }

std::string toCsv(const Comparison& comparison) {
  std::string text =
      "sequence,prediction,group,member,tp,fp,fn,tn,iou,precision,recall,objects_found,objects,phantoms,median_time_s,"
      "p99_time_s,mean_cpu_time_s,peak_memory_bytes\n";
  for (const SequenceComparison& sequence : comparison.sequences) {
    for (const ScoredPrediction& prediction : sequence.predictions) {
      const std::string start = field(sequence.name) + ',' + field(prediction.name);
      const Evaluation& evaluation = prediction.evaluation;
      const auto& figures = prediction.figures;
      const std::string run = figures ? fmt::format("{:.6f},{:.6f},{:.6f},{}", figures->median_time, figures->p99_time,
                                                    figures->mean_cpu_time, figures->peak_memory)
                                      : ",,,";
      text += csvLine(
          start, "total", "", evaluation.total(),
          fmt::format("{},{},{},{}", evaluation.objects().found, evaluation.objects().all, evaluation.phantoms(), run));
      visitGroups(evaluation, [&](const char* group, const std::string& name, const Counts& counts) {
        text += csvLine(start, group, name, counts, ",,,,,,");
      });
    }
  }
  return text;
}

std::string toHtml(const Comparison& comparison) {
  const std::string place = "/*DATA*/null";
  std::string data = textOf(documentOf(comparison, true));
  // In a script element a tag would end it, or a comment hide its end.
  for (std::size_t at = 0; (at = data.find('<', at)) != std::string::npos;) data.replace(at, 1, "\\u003c");
  std::string page = kReportPage;
  page.replace(page.find(place), place.size(), data);
  return page;
}

void writeRunFigures(const fs::path& directory, const RunFigures& figures) {
  writeWhole(directory / "run.json", textOf(figuresOf(figures), 2) + '\n');
}

std::optional<RunFigures> readRunFigures(const fs::path& directory) {
  std::ifstream stream(directory / "run.json");
  if (!stream) return std::nullopt;
  try {
    const json figures = json::parse(stream);
    const auto read = [&](const char* name) { return figures.at(name).is_null() ? json(0) : figures.at(name); };
    return RunFigures{figures.at("method"),    figures.at("scans"),   figures.at("median_time"), figures.at("p99_time"),
                      read("median_cpu_time"), read("mean_cpu_time"), figures.at("peak_memory"), read("method_memory")};
  } catch (const json::exception& error) {
    throw DataError(fmt::format("{}: {}", (directory / "run.json").string(), error.what()));
  }
}

}  // namespace donex
