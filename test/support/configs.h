// Configurations that several tests need.
#pragma once

#include "donex/core/config.h"

namespace donex::testing {

/// The paper's rule alone: every step of evidence off.
inline Config paperConfig(Method method) {
  Config config;
  config.method = method;
  EvidenceConfig& e = config.evidence;
  e.free_evidence = e.careful_sight = e.birth_age = e.neighbourhood = e.ground = false;
  config.objects.enabled = false;
  return config;
}

}  // namespace donex::testing
