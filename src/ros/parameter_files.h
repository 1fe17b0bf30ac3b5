// config/{default,paper_2d,paper_3d}.yaml and cfg/Donex.cfg are written from the code: the one place of names, defaults
// and ranges.
#pragma once

#include <cstdint>
#include <string>

#include "donex/parameters.h"

namespace donex {

/// Level bits of dynamic_reconfigure: what a change of a parameter means.
enum ReconfigureLevel : std::uint32_t {
  kRebuildsGrid = 1,  ///< the grid starts anew, empty
  kSwitch = 2,        ///< outputs only
};

/// What a change of the parameter means.
ReconfigureLevel levelOf(const ParameterInfo& info);

/// Every parameter with its default, unit, range and meaning, as rosparam reads it.
std::string defaultYaml();

/// The paper's method exactly: every step beyond the paper switched off; the rest is as by default.
std::string paperYaml(Method method);

/// The reconfigurable parameters as dynamic_reconfigure's generator reads them.
std::string reconfigureCfg();

}  // namespace donex
