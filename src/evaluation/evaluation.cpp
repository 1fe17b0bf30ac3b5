#include "evaluation/evaluation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "evaluation/object_speeds.h"
#include "evaluation/phantoms.h"
#include "evaluation/ratio.h"
#include "io/sequence.h"

namespace donex {

void Counts::add(bool truly_moving, bool said_moving) {
  std::uint64_t& count = truly_moving ? (said_moving ? true_positives : false_negatives)
                                      : (said_moving ? false_positives : true_negatives);
  ++count;
}

std::uint64_t Counts::total() const { return true_positives + false_positives + false_negatives + true_negatives; }
double Counts::iou() const { return ratio(true_positives, true_positives + false_positives + false_negatives); }
double Counts::precision() const { return ratio(true_positives, true_positives + false_positives); }
double Counts::recall() const { return ratio(true_positives, true_positives + false_negatives); }
double Counts::falsePositiveRate() const { return ratio(false_positives, false_positives + true_negatives); }

double ObjectCounts::recall() const { return ratio(found, all); }

std::size_t speedBand(double speed) {
  return static_cast<std::size_t>(std::upper_bound(kSpeedBandEnds.begin(), kSpeedBandEnds.end(), speed) -
                                  kSpeedBandEnds.begin());
}

void Evaluation::add(std::size_t scan_index, const std::vector<Eigen::Vector3f>& echoes,
                     const std::vector<std::uint32_t>& truth, const std::vector<std::uint32_t>& prediction) {
  add(scan_index, echoes, truth, prediction, [](std::uint32_t) { return std::nullopt; });
}

void Evaluation::add(std::size_t scan_index, const std::vector<Eigen::Vector3f>& echoes,
                     const std::vector<std::uint32_t>& truth, const std::vector<std::uint32_t>& prediction,
                     const SpeedOf& speed_of) {
  const bool fit = truth.size() == echoes.size() && prediction.size() == echoes.size();
  if (!fit) {
    throw std::invalid_argument(std::to_string(echoes.size()) + " echoes, " + std::to_string(truth.size()) +
                                " labels of truth, " + std::to_string(prediction.size()) + " predicted labels");
  }
  if (!scores(scan_index)) return;
  ++scans_;
  std::map<std::uint32_t, Counts> instances;  // by label
  std::vector<Eigen::Vector3f> false_echoes, truly_moving;
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    if (isMoving(truth[i]) && echoes[i].allFinite()) truly_moving.push_back(echoes[i]);
    const double range = echoes[i].head<2>().cast<double>().norm();
    const bool in_range = range <= rules_.max_range;  // not so for NaN
    if (!in_range || !isScored(truth[i])) continue;
    addEcho(range, truth[i], isMoving(prediction[i]));
    const bool is_false = !isMoving(truth[i]) && isMoving(prediction[i]) && echoes[i].allFinite();
    if (is_false) false_echoes.push_back(echoes[i]);
    const bool is_object = isMoving(truth[i]) && instanceOfLabel(truth[i]) != 0;
    if (is_object) instances[truth[i]].add(true, isMoving(prediction[i]));
  }
  phantoms_ += countPhantoms(false_echoes, truly_moving);
  for (const auto& [label, counts] : instances) addObject(label, counts, speed_of(label));
}

double Evaluation::phantomsPerScan() const { return ratio(phantoms_, scans_); }

void Evaluation::addObject(std::uint32_t truth, const Counts& counts, const std::optional<double>& speed) {
  if (speed) {
    Counts& band = by_speed_[speedBand(*speed)];
    band.true_positives += counts.true_positives;
    band.false_negatives += counts.false_negatives;
  }
  if (counts.moving() < ObjectCounts::kLeastEchoes) return;
  const bool is_found = 2 * counts.true_positives >= counts.moving();
  for (ObjectCounts* objects : {&objects_, &objects_by_class_[classOfLabel(truth)]}) {
    ++objects->all;
    objects->found += is_found ? 1 : 0;
  }
}

void Evaluation::addEcho(double range, std::uint32_t truth, bool said_moving) {
  const bool truly_moving = isMoving(truth);
  total_.add(truly_moving, said_moving);
  by_class_[classOfLabel(truth)].add(truly_moving, said_moving);
  const auto last_band = static_cast<std::size_t>(std::ceil(rules_.max_range / kRangeBand)) - 1;
  const std::size_t band = std::min(static_cast<std::size_t>(range / kRangeBand), last_band);
  if (by_range_.size() <= band) by_range_.resize(band + 1);
  by_range_[band].add(truly_moving, said_moving);
}

}  // namespace donex
