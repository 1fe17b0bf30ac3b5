// The one interface of every method: scans in, labels out.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "donex/config.h"
#include "donex/explanation.h"
#include "donex/grid_outline.h"
#include "donex/measured_sensor.h"
#include "donex/object.h"
#include "donex/proof.h"
#include "donex/scan.h"

namespace donex {

/// Labels the echoes of a stream of scans. Not thread-safe: one stream, one detector.
class Detector {
 public:
  virtual ~Detector() = default;

  /// Judges one scan. Stamps must not run backwards: the caller resets first (throws
  /// std::invalid_argument otherwise, the memory is left untouched). Poses must be finite.
  /// `labels` is overwritten and has one entry per echo.
  virtual void process(const Scan& scan, EchoLabels& labels) = 0;

  /// Forgets everything; the next scan is a first scan.
  virtual void reset() = 0;

  /// Objects of the last scan; empty where the method has none.
  virtual const std::vector<Object>& objects() const = 0;

  /// Centres of the cells that hold a dynamic echo of the last scan, odometry frame [m].
  /// Computed on demand.
  virtual std::vector<Eigen::Vector3f> dynamicCells() const = 0;

  /// One per echo of the last scan; empty where the method cannot tell. Computed on demand.
  virtual std::vector<EchoReason> reasons() const { return {}; }

  /// How the motion of each echo of the last scan was proven, kNone where it is static; empty where the method has no
  /// proofs. Computed on demand.
  virtual std::vector<Proof> proofs() const { return {}; }

  /// Cells of the 3D methods; empty for the others. Computed on demand, once watched, for scans since then.
  virtual MemoryCells memoryCells() const { return {}; }
  /// Somebody wants memoryCells() of the coming scans: only then is kept what it needs.
  virtual void watch(bool) {}

  /// Of this turn so far or of the one before, whichever has more; 1 where clouds are whole scans, or the method takes
  /// them for such.
  virtual std::size_t cloudsPerTurn() const { return 1; }

  /// The sensor of the last scan, as its scans so far show it; none where the method does not look, or not yet.
  virtual std::optional<MeasuredSensor> measuredSensor() const { return std::nullopt; }

  /// Whether the last scan holds hardly any ground although the method looks for it.
  virtual bool lacksGround() const { return false; }

  virtual GridOutline outline() const = 0;

  /// Bytes held by the method's own memory.
  virtual std::size_t memoryBytes() const = 0;
};

/// Throws std::invalid_argument that lists every fault of the configuration at once (faultsOf, memory_bound.h).
void requireSound(const Config& config);

/// Builds the method that `config.method` names. Throws as requireSound does, and for a method that cannot run live
/// (whole_drive.h).
std::unique_ptr<Detector> makeDetector(const Config& config);

}  // namespace donex
