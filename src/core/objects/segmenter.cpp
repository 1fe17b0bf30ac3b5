#include "core/objects/segmenter.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace donex {
namespace {

constexpr std::size_t kTooSmall = std::numeric_limits<std::size_t>::max();

}  // namespace

Segmenter::Segmenter(double reach, const ObjectConfig& config, const SegmenterOptions& options)
    : config_(config), options_(options), rules_(config), clusters_(reach, clustersOf(config)) {}

void Segmenter::segment(const JudgedScan& scan, const Predictions& predictions, Segments& segments,
                        const Workers& workers) {
  segments.clear();
  append(scan, segments, workers);
  const std::size_t clusters = segments.size();
  for (std::size_t i = 0; i < clusters; ++i) {
    for (const Prediction& object : predictions) cutOut(scan, object, i, segments);
  }

  roles_.assign(scan.points.size(), ClusterRole::kNone);
  bool any_mixed = false;
  for (Segment& segment : segments) {
    segment.is_mixed = isMixed(segment, predictions);
    if (!segment.is_mixed) continue;
    any_mixed = true;
    for (const std::uint32_t echo : segment.echoes) {
      const bool may_move = scan.places[echo] != Place::kSettled && scan.roles[echo] == ClusterRole::kConnects;
      if (may_move) roles_[echo] = ClusterRole::kConnects;
    }
  }
  if (!any_mixed) return;
  segments.removeIf([&](const Segment& segment) { return segment.is_mixed && !mayBeOne(segment); });
  clusters_.connect(scan.sensor, scan.points, scan.heights, roles_, scan.beams_apart, workers);
  append(scan, segments, workers);
}

void Segmenter::append(const JudgedScan& scan, Segments& segments, const Workers& workers) {
  const std::size_t first = segments.size();
  segment_of_.assign(static_cast<std::size_t>(clusters_.count()), kTooSmall);
  const int of_this_part = clusters_.countWithin(scan.own());  // others were judged when their parts came
  for (int cluster = 0; cluster < of_this_part; ++cluster) {
    if (clusters_.echoesIn(cluster) < static_cast<std::size_t>(config_.min_echoes)) continue;
    segment_of_[static_cast<std::size_t>(cluster)] = segments.size();
    segments.add(clusters_.echoesIn(cluster));
  }
  for (const auto& [echo, cluster] : clusters_.members()) {
    const std::size_t segment = segment_of_[static_cast<std::size_t>(cluster)];
    if (segment != kTooSmall) segments[segment].echoes.push_back(echo);
  }
  const auto describe = [&](std::size_t i) { describeEchoes(scan, segments[first + i]); };
  workers.each(segments.size() - first, std::ref(describe));
}

void Segmenter::cutOut(const JudgedScan& scan, const Prediction& object, std::size_t whole, Segments& segments) const {
  const bool fits_in = ((object.extent - segments[whole].extent()).array() <= options_.cut_rim).all();
  const bool is_hidden = rules_.isLong(object.extent) && rules_.holds(segments[whole], object);
  const bool worth_it = object.moves_whole && is_hidden && fits_in;
  if (!worth_it) return;
  const auto is_part = [&](std::uint32_t echo) {
    const Eigen::Vector3d offset = scan.odom_from_points * scan.points[echo].cast<double>() - object.center;
    const bool inside = (offset.array().abs() <= (0.5 * object.extent).array() + options_.tight_cut_rim).all();
    return inside && scan.places[echo] != Place::kSettled;
  };
  const auto all = segments[whole].echoes.size();
  const auto of_part =
      static_cast<std::size_t>(std::count_if(segments[whole].echoes.begin(), segments[whole].echoes.end(), is_part));
  if (of_part < options_.least_part || all - of_part < options_.least_part) return;
  Segment& part = segments.add(of_part);
  Segment& rest = segments[whole];
  std::copy_if(rest.echoes.begin(), rest.echoes.end(), std::back_inserter(part.echoes), is_part);
  rest.echoes.erase(std::remove_if(rest.echoes.begin(), rest.echoes.end(), is_part), rest.echoes.end());
  part.cut_out = true;
  rest.cut_out = false;
  describeEchoes(scan, part);
  describeEchoes(scan, rest);
}

bool Segmenter::isMixed(const Segment& segment, const Predictions& predictions) const {
  if (rules_.isNew(segment)) return false;
  // The side of a long object settles as it slides along itself, but what was seen elsewhere is one all the same.
  const auto is_it = [&](const Prediction& object) {
    const bool is_one = object.is_displaced || (object.is_proven && !SegmentRules::isMostlySettled(segment));
    return is_one && rules_.isLong(object.extent) && rules_.looksLike(segment, object);
  };
  if (std::any_of(predictions.begin(), predictions.end(), is_it)) return false;
  const std::size_t unsettled = segment.echoes.size() - static_cast<std::size_t>(segment.settled_echoes);
  const bool has_parts = unsettled >= options_.least_part &&
                         segment.settled_echoes >= options_.least_settled * static_cast<double>(unsettled);
  const auto is_within = [&](const Prediction& object) { return object.is_proven && rules_.holds(segment, object); };
  const bool hides_an_object = has_parts && std::any_of(predictions.begin(), predictions.end(), is_within);
  return hides_an_object || segment.new_echoes >= config_.min_echoes;
}

double Segmenter::bytesFor(double reach, const ObjectConfig& config, double echoes) {
  return Clusters::bytesFor(reach, clustersOf(config), echoes, 0.5 * echoes) + echoes * sizeof(ClusterRole);
}

std::size_t Segmenter::memoryBytes() const {
  return clusters_.memoryBytes() + roles_.capacity() * sizeof(ClusterRole) +
         segment_of_.capacity() * sizeof(std::size_t);
}

}  // namespace donex
