// What a border between parts cuts is one object (algorithm: "Objects across parts").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/objects/segment.h"
#include "core/sight/direction_sets.h"
#include "core/sight/turns.h"
#include "donex/scan.h"

namespace donex {

struct PartsBesideOptions {
  float border = 0.7F;  ///< gaps of twice as much between parts count as looked at: no beams lie farther apart [deg]
  float touch = 2.83F;  ///< echoes in cells of clusters that touch lie no more of their edges apart
  float touch_angle = 0.015F;  ///< and so much more: cells touch from farther away with the distance [rad]
  float reach = 15.0F;         ///< never more, which is enough from 3.5 m on; up to 85 [deg]
  std::size_t large = 500;     ///< objects of so many echoes that do not move are thinned where they touch nothing new
};

/// The echoes of a turn's earlier parts that lie beside its newest part. The object step sees both: then a segment is
/// as large as in a whole scan, and only labels of the part's own echoes are given. Whole scans have nothing beside.
class PartsBeside {
 public:
  /// `cell`: edge of the cells of clusters [m].
  explicit PartsBeside(double cell, const PartsBesideOptions& options = {});

  /// Adds to the entries of a cloud those of the same sensor's earlier clouds of the turn that lie beside it: with an
  /// object that reaches there all of its echoes, or if it is large and stands still, one in so many. `turns` has taken
  /// the cloud, whose own places need not be judged yet.
  void join(TurnPart part, const Scan& scan, const Turns& turns, JudgedScan& judged);

  /// Says which object each segment goes on with, and whether more of it may come.
  void relate(const JudgedScan& judged, Segments& segments);

  /// Takes the others' entries off again, and remembers the echoes and what objects they belong to. `pixels`: the
  /// cloud's directions.
  void settle(const SightPixels& pixels, const Segments& segments, const Verdicts& verdicts, JudgedScan& judged);

  void reset();
  std::size_t memoryBytes() const;
  /// What memoryBytes will be for turns of so many echoes, in parts [bytes].
  static double bytesFor(double echoes);

 private:
  using EchoIterator = decltype(Segment::echoes)::const_iterator;

  /// An echo that takes part in clusters.
  struct Kept {
    Eigen::Vector3f point;  ///< in its cloud's points frame [m]
    float height;           ///< above the local ground [m]
    std::uint32_t object;   ///< that it belongs to, of objects_
    Turns::Direction direction{0, 0};
    std::uint8_t reach;  ///< what touches it lies no more columns away
    ClusterRole role;
    Place place;
  };
  /// Entries of the judged scan, cloud by cloud.
  struct Lot {
    std::vector<Kept*> echoes;  ///< the first ones of these:
    std::size_t count = 0;
    std::size_t first = 0;             ///< entry
    std::size_t end_of_last_turn = 0;  ///< entry behind the last one of the turn before
    bool holdsLastTurn(const Segment& segment) const;
  };
  /// Those of one cloud.
  struct Cloud {
    std::uint32_t turn = 0;
    std::uint8_t sensor = 0;
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of its points frame, in odometry [m]
    std::array<std::size_t, 2> in_lot{};               ///< how many of its echoes are in each
    ColumnSet columns;                                 ///< with an echo
    std::vector<std::uint32_t> objects;                ///< that any echo belongs to; some may have lost their last one
    std::vector<Kept> echoes;
  };
  /// How an object's echoes come that are not near themselves.
  enum Coming : std::uint8_t {
    kNot = 0,
    kAsNear = 1,   ///< what of it is near is of the other turn, or connects nothing
    kAsFar = 2,    ///< they go with what is near, and need not be connected again
    kThinned = 4,  ///< the same for one in so many
  };
  /// What echoes belong to.
  struct KeptObject {
    std::uint32_t id = 0;           ///< of the track
    std::array<Coming, 2> comes{};  ///< how its echoes do: those of the turn before, those of this one
    bool is_thinned = false;        ///< large, and not moving
    bool is_used = false;           ///< a cloud has it
    std::uint32_t echoes = 0;       ///< of one segment
  };

  void beginTurn(TurnPart part);
  template <class Condition>
  void forgetIf(Condition&& condition);
  void forgetObjects();
  void forgetWhatIsSeenAgain(const Turns& turns);
  std::uint8_t sensorOf(const Scan& scan);
  void measureDistances(const Turns& turns);
  bool isNear(const Kept& kept) const { return away_[kept.direction.column()] <= kept.reach; }
  void findObjectsBeside();
  void chooseBeside();
  void chooseBeside(Cloud& cloud, std::size_t one_in);
  void addKept(JudgedScan& judged);
  void addSome(const Cloud& cloud, const Kept* const* kept, std::size_t count, std::size_t to, JudgedScan& judged);
  template <class Visit>
  void forEachBeside(Visit&& visit);
  std::uint32_t whenOf(const Cloud& cloud) const { return cloud.turn == turn_ ? 1 : 0; }
  Cloud& newCloud();
  void keep(const SightPixels& pixels, const JudgedScan& judged);
  std::uint8_t reachOf(const Eigen::Vector3f& from_sensor) const;
  static void list(Cloud& cloud, std::uint32_t object);
  std::uint32_t objectOf(EchoIterator first, EchoIterator last);
  std::uint32_t placeOf(std::uint32_t id);

  static constexpr std::uint32_t kNone = 0;  ///< of objects_
  static constexpr std::size_t kOneIn = 4;   ///< of so many echoes one is left where objects are thinned

  int reach_, border_;  ///< columns
  float touch_;         ///< columns that echoes which touch lie apart, 1 m away from the sensor,
  float beyond_touch_;  ///< and as many more anywhere
  float farthest_;      ///< the same as reach_
  std::size_t large_;   ///< echoes
  std::uint32_t turn_ = 0;
  std::uint8_t sensor_ = 0;                   ///< of the newest part
  bool is_in_parts_ = false;                  ///< the turn
  std::vector<Eigen::Isometry3d> mountings_;  ///< by sensor
  std::vector<Cloud> clouds_;                 ///< of this turn and, where they were not seen again, of the one before
  std::vector<Cloud> spares_;                 ///< storage for the next ones
  std::vector<KeptObject> objects_;           ///< their places stay; the first one stands for none
  std::vector<std::uint32_t> by_id_;          ///< of objects_, with ascending ids
  std::vector<std::uint32_t> unused_;         ///< of objects_
  std::array<std::uint8_t, SightPixels::kColumns> away_{};  ///< columns from what the part looks at
  ColumnSet near_;                                          ///< within reach of it
  std::array<Lot, 2> lots_;               ///< beside: what may touch the part, and what is far but goes with that
  std::vector<std::uint32_t> object_of_;  ///< by entry of the judged scan: of objects_
  std::vector<std::uint32_t> counted_;    ///< of objects_: those in one segment
};

}  // namespace donex
