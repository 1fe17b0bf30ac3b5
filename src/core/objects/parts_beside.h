// What a border between parts cuts is one object (algorithm: "Objects across parts").
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/objects/segment.h"
#include "core/sight/turns.h"
#include "donex/scan.h"

namespace donex {

struct PartsBesideOptions {
  float border = 0.7F;  ///< gaps of twice as much between parts count as looked at: no beams lie farther apart [deg]
  float reach = 15.0F;  ///< cells of clusters that touch lie within it from 2.3 m on [deg]
};

/// The echoes of a turn's earlier parts that lie beside its newest part. The object step sees both: then a segment is
/// as large as in a whole scan, and only labels of the part's own echoes are given. Whole scans have nothing beside.
class PartsBeside {
 public:
  explicit PartsBeside(const PartsBesideOptions& options = {});

  /// Adds to the entries of a cloud those of the same sensor's earlier clouds of the turn that lie beside it: with an
  /// object that reaches there, all of its echoes. `pixels`: the cloud's directions; `turns` has taken it. The cloud's
  /// own places need not be judged before settle().
  void join(TurnPart part, const Scan& scan, const SightPixels& pixels, const Turns& turns, JudgedScan& judged);

  /// Says which object each segment goes on with, and whether more of it may come.
  void relate(const JudgedScan& judged, Segments& segments);

  /// Takes the others' entries off again, and remembers the echoes' places and what objects they belong to.
  void settle(const Segments& segments, const Verdicts& verdicts, JudgedScan& judged);

  void reset();
  std::size_t memoryBytes() const;
  /// What memoryBytes will be for turns of so many echoes, in parts [bytes].
  static double bytesFor(double echoes);

 private:
  using ColumnSet = std::bitset<SightPixels::kColumns>;

  /// An echo that takes part in clusters.
  struct Kept {
    Eigen::Vector3f point;  ///< in the points frame of the turn's first part [m]
    float height;           ///< above the local ground [m]
    std::uint32_t object;   ///< that it belongs to; 0: none
    Turns::Direction direction;
    ClusterRole role;
    Place place;
  };
  /// Those of one cloud.
  struct Cloud {
    std::uint32_t turn = 0;
    std::uint8_t sensor = 0;
    bool is_judged = false;              ///< with the newest part: it is that, or some of it lies beside
    ColumnSet columns;                   ///< with an echo
    std::vector<std::uint32_t> objects;  ///< that any echo belongs to; ascending, each once
    std::vector<Kept> echoes;
  };
  struct Count {
    std::uint32_t object;
    std::size_t echoes;
  };

  void beginTurn(TurnPart part, const JudgedScan& judged);
  template <class Condition>
  void forgetIf(Condition&& condition);
  void forgetWhatIsSeenAgain(std::uint8_t sensor, const Turns& turns);
  std::uint8_t sensorOf(const Scan& scan);
  void findObjectsBeside(std::uint8_t sensor);
  void addBeside(std::uint8_t sensor, JudgedScan& judged);
  void addKept(JudgedScan& judged);
  void keep(const SightPixels& pixels, std::uint8_t sensor, const JudgedScan& judged);
  static void listObjects(Cloud& cloud);
  std::uint32_t objectOf(const Segment& segment, std::size_t own);
  std::size_t countOf(std::uint32_t object);

  int reach_, border_;  ///< columns
  std::uint32_t turn_ = 0;
  bool is_in_parts_ = false;  ///< the turn
  Eigen::Isometry3d odom_from_kept_ = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Isometry3d> mountings_;   ///< by sensor
  std::vector<Cloud> clouds_;                  ///< of this turn and, where they were not seen again, of the one before
  std::vector<Cloud> spares_;                  ///< storage for the next ones
  std::size_t end_of_last_turn_ = 0;           ///< entries of the judged scan from its own to there
  std::vector<Kept*> kept_of_;                 ///< by entry of the judged scan; nullptr where it takes part in nothing
  ColumnSet near_;                             ///< close to what the part looks at
  std::vector<std::uint32_t> objects_beside_;  ///< ascending, each once
  std::vector<Count> counts_;                  ///< of one segment
};

}  // namespace donex
