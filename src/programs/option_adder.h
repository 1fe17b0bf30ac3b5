// Options of the simulator as options of a program.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "io/number_text.h"
#include "simulation/simulator_options.h"

namespace donex {

/// Adds every option of the simulator that is visited by its name.
struct OptionAdder {
  CLI::App& app;

  template <class Number>
  void operator()(const simulation::OptionInfo& info, Number& value, Number, Number) {
    const std::string unit = *info.unit == '\0' ? "" : fmt::format(" [{}]", info.unit);
    app.add_option(flagOf(info), value, fmt::format("{}{}; by default {}", info.meaning, unit, numberText(value)));
  }
  void operator()(const simulation::OptionInfo& info, std::string& value, const std::vector<std::string>& names) {
    app.add_option(flagOf(info), value,
                   fmt::format("{}: {}; by default {}", info.meaning, fmt::join(names, ", "), value))
        ->check(CLI::IsMember(names));
  }
  void operator()(const simulation::OptionInfo& info, bool& value) { app.add_flag(flagOf(info), value, info.meaning); }

  static std::string flagOf(const simulation::OptionInfo& info) {
    std::string flag = std::string("--") + info.name;
    std::replace(flag.begin(), flag.end(), '_', '-');
    return flag;
  }
};

}  // namespace donex
