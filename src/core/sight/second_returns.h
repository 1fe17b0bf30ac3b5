// Which echoes lie behind another one of the same beam (algorithm: "Second returns").
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace donex {

/// A beam that meets the edge of something, leaves or glass comes back twice. Both echoes have one direction from the
/// sensor, as long as nobody has moved them: ask before de-skewing. Most sensors give one echo per beam; whether this
/// one gives more is asked of some echoes in the first scans and now and then. Keeps its memory; not thread-safe.
class SecondReturns {
 public:
  struct Options {
    float same_direction = 1e-4F;   ///< coordinates rounded to a millimetre turn a direction so much at 5 m [rad]
    float least_behind = 0.2F;      ///< nearer echoes of one direction are the same surface, twice [m]
    int places = 4;                 ///< of a scan that is asked: directions
    float asked_around = 0.1F;      ///< around them echoes are asked for others of theirs [rad]
    std::size_t least_asked = 500;  ///< so many tell
    double least_share = 0.02;      ///< of these that have one, where a sensor gives second returns
    int first_scans = 3;            ///< all of them are asked,
    int rest = 20;  ///< then every so many; and after as many scans with hardly a pair no scan is searched
  };

  SecondReturns() = default;
  explicit SecondReturns(const Options& options) : options_(options) {}

  /// 1 for each echo with a nearer one in its direction from `sensor`; empty while the sensor gives none. `echoes` in
  /// the cloud's frame as they were measured [m]; non-finite ones are left out.
  const std::vector<std::uint8_t>& find(const std::vector<Eigen::Vector3f>& echoes,
                                        const Eigen::Vector3f& sensor = Eigen::Vector3f::Zero());

  void reset();
  std::size_t memoryBytes() const;

 private:
  struct Entry {
    Eigen::Vector3f direction;
    float range;
    std::uint32_t echo;  // its index
    std::uint32_t link;  // its slot; later the next in the chain of that slot, one more than its index, 0: the last
  };

  bool tellsPairs(const std::vector<Eigen::Vector3f>& echoes);
  void askAround(const std::vector<Eigen::Vector3f>& echoes);
  void search(const std::vector<Eigen::Vector3f>& echoes);
  void enter(const std::vector<Eigen::Vector3f>& echoes);
  template <class Visit>
  void visitSameDirection(const Eigen::Vector3f& direction, const Visit& visit) const;
  std::uint32_t slotOf(const Eigen::Array3i& cell) const;

  Options options_;
  bool has_pairs_ = false;
  int asked_scans_ = 0;
  int resting_ = 0;                     // scans since the one that was asked last
  int scans_without_ = 0;               // with hardly a pair, in a row
  std::size_t asked_ = 0, paired_ = 0;  // echoes, until they are enough
  std::size_t place_ = 0;               // in the scan: where the next ones are asked
  Eigen::Vector3f sensor_ = Eigen::Vector3f::Zero();
  std::vector<Eigen::Vector3f> around_;
  std::vector<std::uint32_t> heads_;  // by slot: one more than the entry's index
  std::vector<Entry> entries_;
  std::vector<std::uint8_t> found_;
};

}  // namespace donex
