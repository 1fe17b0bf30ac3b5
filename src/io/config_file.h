// A YAML file as rosparam loads it -> Config.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "donex/config.h"
#include "io/data_error.h"

namespace donex {

/// A setting of the command line that cannot be used.
class SettingError : public DataError {
 public:
  using DataError::DataError;
};

/// `base`, by default the defaults, overridden by the file: a flat map of parameter names to values. Strict: throws
/// DataError with every fault and its line (not a map, unknown or duplicate names, wrong type, out of range, what
/// faultsOf says). An empty file sets nothing. Numbers are what YAML 1.1, thus rosparam, takes for numbers.
Config readConfigFile(const std::filesystem::path& file, const Config& base = Config());

/// Overrides `config` by settings "name=value", later ones over earlier ones; as strict. Throws SettingError.
void applySettings(Config& config, const std::vector<std::string>& settings);

}  // namespace donex
