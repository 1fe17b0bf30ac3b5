// Methods that judge a drive only when all of it has been seen.
#pragma once

#include <memory>

#include "donex/detector.h"

namespace donex {

/// True for methods that cannot run live: makeDetector refuses them, makeWholeDriveDetector builds them.
inline bool needsWholeDrive(Method method) { return infoOf(method).needs_whole_drive; }

/// Takes all scans of a drive several times over, in the same order each time. Labels are right in the last pass; in
/// those before all of them are 0. reset() throws std::logic_error once a scan has been taken: the passes would no
/// longer be the same drive. Its memory grows with the drive.
class WholeDriveDetector : public Detector {
 public:
  /// The pass is over: call after the last scan. False when it was the last one.
  virtual bool nextPass() = 0;

  /// How often the drive must be shown in all.
  virtual int passes() const = 0;

  /// Whether this pass's labels count.
  virtual bool isLastPass() const = 0;
};

/// Throws std::invalid_argument as makeDetector does, and for a method that runs live.
std::unique_ptr<WholeDriveDetector> makeWholeDriveDetector(const Config& config);

}  // namespace donex
