#include "core/objects/parts_beside.h"

#include <algorithm>
#include <cmath>

namespace donex {
namespace {

constexpr int kColumns = SightPixels::kColumns;

using ColumnSet = std::bitset<kColumns>;

ColumnSet setOf(const Turns::Columns& columns) {
  ColumnSet set;
  for (std::size_t c = 0; c < columns.size(); ++c) set[c] = columns[c] != 0;
  return set;
}

ColumnSet columnsIn(const Turns::Directions& directions) {
  ColumnSet set;
  for (std::size_t c = 0; c < directions.size(); ++c) set[c] = directions[c] != 0;
  return set;
}

/// With those next to them, to both sides, so many times.
ColumnSet grown(ColumnSet columns, int times) {
  for (int i = 0; i < times; ++i) {
    columns |= columns << 1 | columns >> (kColumns - 1) | columns >> 1 | columns << (kColumns - 1);
  }
  return columns;
}

ColumnSet shrunk(const ColumnSet& columns, int times) { return ~grown(~columns, times); }

/// With gaps of twice as many columns filled, and less the column at each end.
Turns::Directions closed(const Turns::Directions& directions, int border) {
  Turns::Directions result = directions;
  const auto step = [&](auto&& join) {
    const Turns::Directions before = result;
    for (std::size_t c = 0; c < before.size(); ++c) {
      const Turns::Bands left = before[(c + before.size() - 1) % before.size()],
                         right = before[(c + 1) % before.size()];
      result[c] = join(join(before[c], left), right);
    }
  };
  for (int i = 0; i < border; ++i) step([](Turns::Bands a, Turns::Bands b) { return a | b; });
  for (int i = 0; i <= border; ++i) step([](Turns::Bands a, Turns::Bands b) { return a & b; });
  return result;
}

/// Of a part that was cut by elevation: the outermost ones are shared with the parts above and below.
Turns::Bands withoutEnds(Turns::Bands bands) {
  return bands == Turns::kAllBands ? bands : bands & (bands << 1) & (bands >> 1);
}

int widthOf(float degrees) { return static_cast<int>(std::ceil(degrees * kColumns / 360.0F)); }

void sortUnique(std::vector<std::uint32_t>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

}  // namespace

PartsBeside::PartsBeside(const PartsBesideOptions& options)
    : reach_(widthOf(options.reach)), border_(widthOf(options.border)) {}

void PartsBeside::join(TurnPart part, const Scan& scan, const SightPixels& pixels, const Turns& turns,
                       JudgedScan& judged) {
  if (!judged.continues_turn) beginTurn(part, judged);
  if (!is_in_parts_) return;
  const std::uint8_t sensor = sensorOf(scan);
  near_ = grown(setOf(turns.newest()), reach_);
  forgetWhatIsSeenAgain(sensor, turns);
  findObjectsBeside(sensor);
  keep(pixels, sensor, judged);
  addBeside(sensor, judged);
}

void PartsBeside::beginTurn(TurnPart part, const JudgedScan& judged) {
  is_in_parts_ = part != TurnPart::kWhole;
  ++turn_;
  forgetIf([&](const Cloud& cloud) { return !is_in_parts_ || cloud.turn + 1 != turn_; });
  if (clouds_.empty()) mountings_.clear();
  const Eigen::Isometry3f moved = (judged.odom_from_points.inverse() * odom_from_kept_).cast<float>();
  for (Cloud& cloud : clouds_) {
    for (Kept& kept : cloud.echoes) kept.point = moved * kept.point;
  }
  odom_from_kept_ = judged.odom_from_points;
}

template <class Condition>
void PartsBeside::forgetIf(Condition&& condition) {
  std::size_t stay = 0;
  for (std::size_t i = 0; i < clouds_.size(); ++i) {
    if (condition(clouds_[i])) {
      spares_.push_back(std::move(clouds_[i]));
    } else if (stay++ != i) {
      clouds_[stay - 1] = std::move(clouds_[i]);
    }
  }
  clouds_.resize(stay);
}

/// By the newest part, or of what the turn before saw by any. Parts may share a column at their border, or leave some
/// between them.
void PartsBeside::forgetWhatIsSeenAgain(std::uint8_t sensor, const Turns& turns) {
  const ColumnSet columns = shrunk(setOf(turns.newest()), 1);
  const Turns::Bands bands = withoutEnds(turns.newestBands());
  Turns::Directions seen_by_newest;
  for (std::size_t c = 0; c < kColumns; ++c) seen_by_newest[c] = columns[c] ? bands : 0;
  const Turns::Directions seen_by_turn = closed(turns.lookedAt(), border_);
  const ColumnSet columns_of_turn = columnsIn(seen_by_turn);
  for (Cloud& cloud : clouds_) {
    const bool is_of_turn = cloud.turn == turn_;
    if (cloud.sensor != sensor || (cloud.columns & (is_of_turn ? columns : columns_of_turn)).none()) continue;
    const Turns::Directions& seen = is_of_turn ? seen_by_newest : seen_by_turn;
    const auto is_seen_again = [&](const Kept& kept) { return kept.direction.isIn(seen); };
    cloud.echoes.erase(std::remove_if(cloud.echoes.begin(), cloud.echoes.end(), is_seen_again), cloud.echoes.end());
    cloud.columns.reset();
    for (const Kept& kept : cloud.echoes) cloud.columns.set(kept.direction.column());
  }
  forgetIf([](const Cloud& cloud) { return cloud.echoes.empty(); });
}

std::uint8_t PartsBeside::sensorOf(const Scan& scan) {
  const auto known = std::find_if(mountings_.begin(), mountings_.end(), [&](const Eigen::Isometry3d& mounting) {
    return Turns::areOne(mounting, scan.base_from_sensor);
  });
  const auto sensor = static_cast<std::uint8_t>(known - mountings_.begin());
  if (known == mountings_.end()) mountings_.push_back(scan.base_from_sensor);
  return sensor;
}

void PartsBeside::findObjectsBeside(std::uint8_t sensor) {
  objects_beside_.clear();
  const ColumnSet& near = near_;
  for (const Cloud& cloud : clouds_) {
    if (cloud.sensor != sensor || cloud.objects.empty() || (cloud.columns & near).none()) continue;
    std::uint32_t known = 0;
    for (const Kept& kept : cloud.echoes) {
      if (kept.object == known || kept.object == 0 || !near[kept.direction.column()]) continue;
      known = kept.object;
      objects_beside_.push_back(known);
    }
  }
  sortUnique(objects_beside_);
}

void PartsBeside::keep(const SightPixels& pixels, std::uint8_t sensor, const JudgedScan& judged) {
  Cloud cloud;
  if (!spares_.empty()) {
    cloud = std::move(spares_.back());
    spares_.pop_back();
  }
  cloud.turn = turn_;
  cloud.sensor = sensor;
  cloud.is_judged = true;
  cloud.columns.reset();
  cloud.objects.clear();
  cloud.echoes.clear();
  if (judged.points.size() > cloud.echoes.capacity()) cloud.echoes.reserve(judged.points.size());
  const Eigen::Isometry3f kept_from_points = (odom_from_kept_.inverse() * judged.odom_from_points).cast<float>();
  kept_of_.assign(judged.points.size(), nullptr);
  for (std::size_t i = 0; i < judged.points.size(); ++i) {
    const ClusterRole role = judged.roles[i];
    const bool takes_part = role == ClusterRole::kConnects || role == ClusterRole::kFollows;
    if (!takes_part || pixels.row(i) < 0) continue;
    const Turns::Direction direction(pixels.column(i), pixels.row(i));
    cloud.columns[direction.column()] = true;
    cloud.echoes.push_back(
        {kept_from_points * judged.points[i], judged.heights[i], 0, direction, role, Place::kUnobserved});
    kept_of_[i] = &cloud.echoes.back();  // stays there: there is room for all of them
  }
  clouds_.push_back(std::move(cloud));
}

void PartsBeside::addBeside(std::uint8_t sensor, JudgedScan& judged) {
  // Echoes of an object follow one another.
  std::uint32_t asked = 0;
  bool is_beside = false;
  const auto is_of_one_beside = [&](std::uint32_t object) {
    if (object == asked) return is_beside;
    asked = object;
    return is_beside = object != 0 && std::binary_search(objects_beside_.begin(), objects_beside_.end(), object);
  };
  const ColumnSet& near = near_;
  end_of_last_turn_ = judged.own();
  for (std::size_t i = 0; i + 1 < clouds_.size(); ++i) {
    Cloud& cloud = clouds_[i];
    const bool is_same = cloud.sensor == sensor, may_be_near = is_same && (cloud.columns & near_).any();
    const bool holds_object = is_same && std::any_of(cloud.objects.begin(), cloud.objects.end(), is_of_one_beside);
    cloud.is_judged = may_be_near || holds_object;
    if (!cloud.is_judged) continue;
    for (Kept& kept : cloud.echoes) {
      const bool is_near = near[kept.direction.column()];
      if (is_near || (holds_object && is_of_one_beside(kept.object))) kept_of_.push_back(&kept);
    }
    if (cloud.turn != turn_) end_of_last_turn_ = kept_of_.size();
  }
  addKept(judged);
}

/// The entries of what lies beside, all at once: one by one, five vectors would be asked for room for each.
void PartsBeside::addKept(JudgedScan& judged) {
  const Eigen::Isometry3f points_from_kept = (judged.odom_from_points.inverse() * odom_from_kept_).cast<float>();
  const std::size_t own = judged.own(), all = kept_of_.size();
  judged.points.resize(all);
  judged.heights.resize(all);
  judged.roles.resize(all);
  judged.places.resize(all);
  judged.beside = all - own;
  for (std::size_t i = own; i < all; ++i) {
    const Kept& kept = *kept_of_[i];
    judged.points[i] = points_from_kept * kept.point;
    judged.heights[i] = kept.height;
    judged.roles[i] = kept.role;
    judged.places[i] = kept.place;
  }
}

void PartsBeside::relate(const JudgedScan& judged, Segments& segments) {
  if (!is_in_parts_) return;
  for (Segment& segment : segments) {
    segment.object = objectOf(segment, judged.own());
    segment.is_of_two_turns = std::any_of(segment.echoes.begin(), segment.echoes.end(), [&](std::uint32_t echo) {
      return echo >= judged.own() && echo < end_of_last_turn_;
    });
  }
}

/// The one that most of its echoes beside belong to.
std::uint32_t PartsBeside::objectOf(const Segment& segment, std::size_t own) {
  counts_.clear();
  std::size_t newest = 0;  // of counts_; echoes of an object follow one another
  for (const std::uint32_t echo : segment.echoes) {
    const std::uint32_t object = echo < own ? 0 : kept_of_[echo]->object;
    if (object == 0) continue;
    const bool is_same = newest < counts_.size() && counts_[newest].object == object;
    if (!is_same) newest = countOf(object);
    ++counts_[newest].echoes;
  }
  const auto most = std::max_element(counts_.begin(), counts_.end(),
                                     [](const Count& a, const Count& b) { return a.echoes < b.echoes; });
  return most == counts_.end() ? 0 : most->object;
}

/// Its place in counts_.
std::size_t PartsBeside::countOf(std::uint32_t object) {
  const auto known =
      std::find_if(counts_.begin(), counts_.end(), [&](const Count& count) { return count.object == object; });
  const auto place = static_cast<std::size_t>(known - counts_.begin());
  if (known == counts_.end()) counts_.push_back({object, 0});
  return place;
}

void PartsBeside::listObjects(Cloud& cloud) {
  cloud.objects.clear();
  std::uint32_t known = 0;
  for (const Kept& kept : cloud.echoes) {
    if (kept.object == known || kept.object == 0) continue;
    known = kept.object;
    cloud.objects.push_back(known);
  }
  sortUnique(cloud.objects);
}

void PartsBeside::settle(const Segments& segments, const Verdicts& verdicts, JudgedScan& judged) {
  if (!is_in_parts_) return;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    for (const std::uint32_t echo : segments[i].echoes) {
      if (kept_of_[echo] != nullptr) kept_of_[echo]->object = verdicts[i].object;
    }
  }
  for (std::size_t i = 0; i < judged.own(); ++i) {
    if (kept_of_[i] != nullptr) kept_of_[i]->place = judged.places[i];
  }
  for (Cloud& cloud : clouds_) {
    if (cloud.is_judged) listObjects(cloud);
  }
  judged.points.resize(judged.own());
  judged.heights.resize(judged.points.size());
  judged.roles.resize(judged.points.size());
  judged.places.resize(judged.points.size());
  judged.beside = 0;
}

void PartsBeside::reset() {
  forgetIf([](const Cloud&) { return true; });
  mountings_.clear();
  is_in_parts_ = false;
}

double PartsBeside::bytesFor(double echoes) { return echoes * sizeof(Kept) + 2.0 * echoes * sizeof(Kept*); }

std::size_t PartsBeside::memoryBytes() const {
  std::size_t bytes = kept_of_.capacity() * sizeof(Kept*) + mountings_.capacity() * sizeof(Eigen::Isometry3d) +
                      objects_beside_.capacity() * sizeof(std::uint32_t) + counts_.capacity() * sizeof(Count);
  for (const auto* clouds : {&clouds_, &spares_}) {
    bytes += clouds->capacity() * sizeof(Cloud);
    for (const Cloud& cloud : *clouds) {
      bytes += cloud.echoes.capacity() * sizeof(Kept) + cloud.objects.capacity() * sizeof(std::uint32_t);
    }
  }
  return bytes;
}

}  // namespace donex
