// Named YAML values -> Config, strictly by type.
#pragma once

#include <map>
#include <string>

#include <yaml-cpp/yaml.h>

#include "donex/config.h"
#include "io/data_error.h"

namespace donex {

/// A value and where it was given ("file:line", or the setting itself).
struct Setting {
  YAML::Node value;
  std::string where;
  bool used = false;
};
using Settings = std::map<std::string, Setting>;  ///< by the parameter's name

/// Overrides `config`. Adds a fault for every unknown name, wrong type and value out of range, at the place where it
/// was given, and for what faultsOf says of the whole, at `source` where no place is to blame.
void apply(Settings& settings, Config& config, const std::string& source, Faults& faults);

}  // namespace donex
