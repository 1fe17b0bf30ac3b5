#include "core/objects/parts_beside.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/grid/selection.h"
#include "core/pi.h"

namespace donex {
namespace {

constexpr int kColumns = SightPixels::kColumns;
constexpr float kColumnsPerRadian = static_cast<float>(kColumns) / (2.0F * kPiF);

int widthOf(float degrees) { return static_cast<int>(std::ceil(degrees * kColumns / 360.0F)); }

}  // namespace

PartsBeside::PartsBeside(double cell, const PartsBesideOptions& options)
    : reach_(widthOf(options.reach)),
      border_(widthOf(options.border)),
      touch_(options.touch * static_cast<float>(cell) * kColumnsPerRadian),
      beyond_touch_(options.touch_angle * kColumnsPerRadian + 1.0F),
      farthest_(static_cast<float>(reach_)),
      large_(options.large),
      objects_(1) {}

void PartsBeside::join(TurnPart part, const Scan& scan, const Turns& turns, JudgedScan& judged) {
  if (!judged.continues_turn) beginTurn(part);
  if (!is_in_parts_) return;
  sensor_ = sensorOf(scan);
  forgetWhatIsSeenAgain(turns);
  measureDistances(turns);
  findObjectsBeside();
  chooseBeside();
  addKept(judged);
}

void PartsBeside::beginTurn(TurnPart part) {
  is_in_parts_ = part != TurnPart::kWhole;
  ++turn_;
  forgetIf([&](const Cloud& cloud) { return !is_in_parts_ || cloud.turn + 1 != turn_; });
  forgetObjects();
  if (clouds_.empty()) mountings_.clear();
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

/// That no cloud has any more: their places are free for others.
void PartsBeside::forgetObjects() {
  for (const std::uint32_t object : by_id_) objects_[object].is_used = false;
  for (const Cloud& cloud : clouds_) {
    for (const std::uint32_t object : cloud.objects) objects_[object].is_used = true;
  }
  const auto is_unused = [&](std::uint32_t object) { return !objects_[object].is_used; };
  std::copy_if(by_id_.begin(), by_id_.end(), std::back_inserter(unused_), is_unused);
  by_id_.erase(std::remove_if(by_id_.begin(), by_id_.end(), is_unused), by_id_.end());
}

/// By the newest part, or of what the turn before saw by any. Parts may share a column at their border, or leave some
/// between them.
void PartsBeside::forgetWhatIsSeenAgain(const Turns& turns) {
  const ColumnSet columns = shrunk(setOf(turns.newest()), 1);
  const Turns::Bands bands = withoutEnds(turns.newestBands());
  Turns::Directions seen_by_newest;
  for (std::size_t c = 0; c < kColumns; ++c) seen_by_newest[c] = columns[c] ? bands : 0;
  const Turns::Directions seen_by_turn = closed(turns.lookedAt(), border_);
  const ColumnSet columns_of_turn = columnsIn(seen_by_turn);
  for (Cloud& cloud : clouds_) {
    const bool is_of_turn = cloud.turn == turn_;
    if (cloud.sensor != sensor_ || (cloud.columns & (is_of_turn ? columns : columns_of_turn)).none()) continue;
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

void PartsBeside::measureDistances(const Turns& turns) {
  int away = reach_ + 1;
  const auto beyond = static_cast<std::uint8_t>(away);
  for (std::size_t c = 0; c < kColumns; ++c) away_[c] = turns.newest()[c] != 0 ? std::uint8_t{0} : beyond;
  const auto pass = [&](std::uint8_t& here) {
    away = std::min(away + 1, int{here});
    here = static_cast<std::uint8_t>(away);
  };
  // Each twice: azimuth wraps.
  for (std::size_t c = 0; c < 2 * kColumns; ++c) pass(away_[c % kColumns]);
  for (std::size_t c = 2 * kColumns; c-- > 0;) pass(away_[c % kColumns]);
  for (std::size_t c = 0; c < kColumns; ++c) near_[c] = away_[c] < beyond;
}

void PartsBeside::findObjectsBeside() {
  for (const std::uint32_t object : by_id_) objects_[object].comes = {};
  for (const Cloud& cloud : clouds_) {
    if (cloud.sensor != sensor_ || cloud.objects.empty() || (cloud.columns & near_).none()) continue;
    for (const Kept& kept : cloud.echoes) {
      if (!isNear(kept)) continue;
      Coming& comes = objects_[kept.object].comes[whenOf(cloud)];
      comes = std::max(comes, kept.role == ClusterRole::kConnects ? kAsFar : kAsNear);
    }
  }
  objects_[kNone].comes = {};
  for (const std::uint32_t place : by_id_) {
    KeptObject& object = objects_[place];
    if (object.comes == std::array<Coming, 2>{}) continue;
    for (Coming& comes : object.comes) {
      const Coming as_far = object.is_thinned ? kThinned : kAsFar;
      comes = comes == kAsFar ? as_far : kAsNear;
    }
  }
}

void PartsBeside::chooseBeside() {
  for (Lot& lot : lots_) {
    lot.count = lot.end_of_last_turn = 0;
  }
  for (Cloud& cloud : clouds_) {
    cloud.in_lot = {};
    if (cloud.sensor != sensor_) continue;
    const bool may_be_near = (cloud.columns & near_).any();
    const auto whole = [&](std::uint32_t object) { return (objects_[object].comes[whenOf(cloud)] & ~kThinned) != 0; };
    const auto thinned = [&](std::uint32_t object) { return objects_[object].comes[whenOf(cloud)] == kThinned; };
    if (may_be_near || std::any_of(cloud.objects.begin(), cloud.objects.end(), whole)) {
      chooseBeside(cloud, 1);
    } else if (std::any_of(cloud.objects.begin(), cloud.objects.end(), thinned)) {
      chooseBeside(cloud, kOneIn);
    }
  }
}

/// Of one in so many of its echoes.
void PartsBeside::chooseBeside(Cloud& cloud, std::size_t one_in) {
  std::array<Kept**, 2> begin, next;
  for (std::size_t k = 0; k < lots_.size(); ++k) {
    const std::size_t most = lots_[k].count + cloud.echoes.size();
    if (most > lots_[k].echoes.size()) lots_[k].echoes.resize(most);
    begin[k] = next[k] = lots_[k].echoes.data() + lots_[k].count;
  }
  // Written in any case: which it is changes from echo to echo.
  static_assert(kAsNear == 1 && kAsFar == 2 && kThinned == 4);
  const std::uint32_t when = whenOf(cloud);
  const KeptObject* objects = objects_.data();
  for (std::size_t i = 0; i < cloud.echoes.size(); i += one_in) {
    Kept& kept = cloud.echoes[i];
    const int near = static_cast<int>(isNear(kept)), comes = objects[kept.object].comes[when];
    *next[0] = *next[1] = &kept;
    next[0] += near | (comes & kAsNear);
    next[1] += (1 - near) & (comes >> 1 | (comes >> 2 & static_cast<int>(i % kOneIn == 0)));
  }
  for (std::size_t k = 0; k < lots_.size(); ++k) {
    Lot& lot = lots_[k];
    cloud.in_lot[k] = static_cast<std::size_t>(next[k] - begin[k]);
    lot.count += cloud.in_lot[k];
    if (when == 0) lot.end_of_last_turn = lot.count;
  }
}

/// `visit(cloud, kept, count, entry)`: of a cloud in a lot, and the first one's entry.
template <class Visit>
void PartsBeside::forEachBeside(Visit&& visit) {
  for (std::size_t k = 0; k < lots_.size(); ++k) {
    std::size_t i = 0;
    for (Cloud& cloud : clouds_) {
      visit(cloud, lots_[k].echoes.data() + i, cloud.in_lot[k], lots_[k].first + i);
      i += cloud.in_lot[k];
    }
  }
}

/// The entries of what lies beside, all at once: one by one, five vectors would be asked for room for each.
void PartsBeside::addKept(JudgedScan& judged) {
  std::size_t all = judged.points.size();
  object_of_.assign(all, kNone);
  for (Lot& lot : lots_) {
    lot.first = all;
    lot.end_of_last_turn += all;
    all += lot.count;
  }
  judged.beside = all - judged.points.size();
  judged.far = lots_.back().count;
  judged.points.resize(all);
  judged.heights.resize(all);
  judged.roles.resize(all);
  judged.places.resize(all);
  judged.together.resize(judged.beside);
  object_of_.resize(all);
  forEachBeside([&](const Cloud& cloud, const Kept* const* kept, std::size_t count, std::size_t entry) {
    addSome(cloud, kept, count, entry, judged);
  });
}

void PartsBeside::addSome(const Cloud& cloud, const Kept* const* kept, std::size_t count, std::size_t to,
                          JudgedScan& judged) {
  const Eigen::Vector3f moved = (cloud.origin - judged.odom_from_points.translation()).cast<float>();
  // Bytes may be anything: as members of vectors, these would be read again after each role that is written.
  Eigen::Vector3f* points = judged.points.data() + to;
  float* heights = judged.heights.data() + to;
  ClusterRole* roles = judged.roles.data() + to;
  Place* places = judged.places.data() + to;
  std::uint32_t* objects = object_of_.data() + to;
  std::uint32_t* together = judged.together.data() + to - judged.own();
  const std::uint32_t when = whenOf(cloud);  // where turns meet, what moves shows up twice: not as one
  for (std::size_t i = 0; i < count; ++i) {
    points[i] = kept[i]->point + moved;
    heights[i] = kept[i]->height;
    roles[i] = kept[i]->role;
    places[i] = kept[i]->place;
    objects[i] = kept[i]->object;
    together[i] = kept[i]->object == kNone ? 0 : 2 * kept[i]->object + when;
  }
}

/// Entries of a segment are in the order of the scan.
bool PartsBeside::Lot::holdsLastTurn(const Segment& segment) const {
  const auto in_lot = std::lower_bound(segment.echoes.begin(), segment.echoes.end(), first);
  return in_lot != segment.echoes.end() && *in_lot < end_of_last_turn;
}

void PartsBeside::relate(const JudgedScan& judged, Segments& segments) {
  if (!is_in_parts_) return;
  for (Segment& segment : segments) {
    const auto beside = std::lower_bound(segment.echoes.begin(), segment.echoes.end(), judged.own());
    const auto holds = [&](const Lot& lot) { return lot.holdsLastTurn(segment); };
    segment.is_of_two_turns = std::any_of(lots_.begin(), lots_.end(), holds);
    if (!segment.is_mixed) segment.object = objects_[objectOf(beside, segment.echoes.end())].id;
  }
}

/// The one that most of its echoes beside belong to.
std::uint32_t PartsBeside::objectOf(EchoIterator first, EchoIterator last) {
  counted_.clear();
  for (auto echo = first; echo != last; ++echo) {
    const std::uint32_t object = object_of_[*echo];
    if (objects_[object].echoes++ == 0) counted_.push_back(object);
  }
  std::uint32_t most = kNone;
  objects_[kNone].echoes = 0;
  for (const std::uint32_t object : counted_) {
    if (objects_[object].echoes > objects_[most].echoes) most = object;
  }
  for (const std::uint32_t object : counted_) objects_[object].echoes = 0;
  return most;
}

/// In objects_.
std::uint32_t PartsBeside::placeOf(std::uint32_t id) {
  if (id == 0) return kNone;
  const auto known = std::lower_bound(by_id_.begin(), by_id_.end(), id, [&](std::uint32_t object, std::uint32_t asked) {
    return objects_[object].id < asked;
  });
  if (known != by_id_.end() && objects_[*known].id == id) return *known;
  auto place = static_cast<std::uint32_t>(objects_.size());
  if (unused_.empty()) {
    objects_.emplace_back();
  } else {
    place = unused_.back();
    unused_.pop_back();
  }
  objects_[place] = KeptObject();
  objects_[place].id = id;
  by_id_.insert(known, place);
  return place;
}

void PartsBeside::list(Cloud& cloud, std::uint32_t object) {
  const bool is_known =
      object == kNone || std::find(cloud.objects.rbegin(), cloud.objects.rend(), object) != cloud.objects.rend();
  if (!is_known) cloud.objects.push_back(object);
}

void PartsBeside::settle(const SightPixels& pixels, const Segments& segments, const Verdicts& verdicts,
                         JudgedScan& judged) {
  if (!is_in_parts_) return;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (segments[i].is_mixed) continue;
    const std::uint32_t place = placeOf(verdicts[i].object);
    for (const std::uint32_t echo : segments[i].echoes) object_of_[echo] = place;
    KeptObject& object = objects_[place];
    const std::size_t large = object.is_thinned ? large_ / kOneIn : large_;
    object.is_thinned = !verdicts[i].moves() && segments[i].echoes.size() >= large;
  }
  forEachBeside([&](Cloud& cloud, Kept** kept, std::size_t count, std::size_t entry) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t object = object_of_[entry + i];
      if (kept[i]->object == object) continue;
      kept[i]->object = object;
      list(cloud, object);
    }
  });
  const std::size_t own = judged.own();
  judged.points.resize(own);
  judged.heights.resize(own);
  judged.roles.resize(own);
  judged.places.resize(own);
  judged.together.clear();
  judged.beside = judged.far = 0;
  keep(pixels, judged);
}

PartsBeside::Cloud& PartsBeside::newCloud() {
  if (spares_.empty()) return clouds_.emplace_back();
  clouds_.push_back(std::move(spares_.back()));
  spares_.pop_back();
  return clouds_.back();
}

void PartsBeside::keep(const SightPixels& pixels, const JudgedScan& judged) {
  Cloud& cloud = newCloud();
  cloud.turn = turn_;
  cloud.sensor = sensor_;
  cloud.origin = judged.odom_from_points.translation();
  cloud.in_lot = {};
  cloud.objects.clear();
  cloud.echoes.clear();
  const auto takes_part = [&](std::size_t i) {
    const ClusterRole role = judged.roles[i];
    return (static_cast<int>(role == ClusterRole::kConnects) | static_cast<int>(role == ClusterRole::kFollows)) != 0 &&
           pixels.row(i) >= 0;
  };
  if (judged.points.size() > cloud.echoes.capacity()) cloud.echoes.reserve(judged.points.size());
  Turns::Columns with_echo{};
  const Eigen::Vector3f* points = judged.points.data();
  const float* heights = judged.heights.data();
  const ClusterRole* roles = judged.roles.data();
  const Place* places = judged.places.data();
  const std::uint32_t* objects = object_of_.data();
  std::uint32_t newest = kNone;
  forEachSelection(0, judged.points.size(), takes_part, [&](const std::uint32_t* chosen, std::size_t count) {
    cloud.echoes.resize(cloud.echoes.size() + count);
    Kept* next = cloud.echoes.data() + cloud.echoes.size() - count;
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint32_t i = chosen[k];
      Kept& kept = next[k];
      kept.point = points[i];
      kept.height = heights[i];
      kept.object = objects[i];
      kept.direction = Turns::Direction(pixels.column(i), pixels.row(i));
      kept.reach = reachOf(points[i] - judged.sensor);
      kept.role = roles[i];
      kept.place = places[i];
      with_echo[kept.direction.column()] = 1;
      if (kept.object != newest) list(cloud, newest = kept.object);
    }
  });
  cloud.columns = setOf(with_echo);
}

inline std::uint8_t PartsBeside::reachOf(const Eigen::Vector3f& from_sensor) const {
  const float columns = touch_ / std::sqrt(from_sensor.head<2>().squaredNorm()) + beyond_touch_;
  return static_cast<std::uint8_t>(std::min(columns, farthest_));
}

void PartsBeside::reset() {
  forgetIf([](const Cloud&) { return true; });
  forgetObjects();
  mountings_.clear();
  is_in_parts_ = false;
}

double PartsBeside::bytesFor(double echoes) {
  return echoes * (sizeof(Kept) + 2.0 * sizeof(Kept*) + 2.0 * sizeof(std::uint32_t));  // with JudgedScan::together
}

std::size_t PartsBeside::memoryBytes() const {
  std::size_t bytes =
      (lots_[0].echoes.capacity() + lots_[1].echoes.capacity()) * sizeof(Kept*) +
      mountings_.capacity() * sizeof(Eigen::Isometry3d) + objects_.capacity() * sizeof(KeptObject) +
      (object_of_.capacity() + by_id_.capacity() + unused_.capacity() + counted_.capacity()) * sizeof(std::uint32_t);
  for (const auto* clouds : {&clouds_, &spares_}) {
    bytes += clouds->capacity() * sizeof(Cloud);
    for (const Cloud& cloud : *clouds) {
      bytes += cloud.echoes.capacity() * sizeof(Kept) + cloud.objects.capacity() * sizeof(std::uint32_t);
    }
  }
  return bytes;
}

}  // namespace donex
