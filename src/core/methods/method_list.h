// The table of methods, each with what builds it.
#pragma once

#include <memory>

#include "donex/whole_drive.h"

namespace donex {

/// A row of the table. Of the two factories one is null.
struct MethodEntry {
  using Bytes = double (*)(const Config& config, double echoes);

  MethodInfo info;
  std::unique_ptr<Detector> (*make_live)(const Config& config);
  std::unique_ptr<WholeDriveDetector> (*make_whole_drive)(const Config& config);
  Bytes bytes;  ///< memoryBound of a configuration with this method
};

const MethodEntry& entryOf(Method method);

}  // namespace donex
