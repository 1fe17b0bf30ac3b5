#include "ros/parameter_files.h"

#include <algorithm>
#include <list>
#include <sstream>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include <fmt/ranges.h>

#include "donex/parameters.h"

namespace donex {
namespace {

/// Shortest decimal form that reads back as the same number, always with a point: YAML and Python see a float.
std::string textOf(double value) {
  std::string text;
  for (int precision = 6; precision <= 17; ++precision) {
    std::ostringstream out;
    out.precision(precision);
    out << value;
    text = out.str();
    if (std::stod(text) == value) break;
  }
  const bool has_point = text.find('.') != std::string::npos;
  return has_point ? text : text.insert(std::min(text.find('e'), text.size()), ".0");
}
std::string textOf(int value) { return std::to_string(value); }

std::string quoted(const std::string& text) { return '"' + text + '"'; }

/// Text by group, the groups in the order in which they first appear.
class GroupedText {
 public:
  std::ostream& in(ParameterGroup group) {
    for (auto& [name, text] : groups_) {
      if (name == group) return text;
    }
    return groups_.emplace_back(group, std::ostringstream()).second;
  }
  std::string text(const std::string& before_title, const std::string& after_title) const {
    std::ostringstream all;
    for (const auto& [group, text] : groups_) {
      all << '\n' << before_title << nameOf(group) << after_title << '\n' << text.str();
    }
    return all.str();
  }

 private:
  std::list<std::pair<ParameterGroup, std::ostringstream>> groups_;
};

struct YamlWriter {
  GroupedText& out;

  template <class Number>
  void operator()(const ParameterInfo& info, const Number& value, Number min, Number max) {
    const std::string unit = *info.unit == '\0' ? "" : std::string(" ") + info.unit;
    write(info, textOf(value), textOf(min) + " to " + textOf(max) + unit);
  }
  void operator()(const ParameterInfo& info, const bool& value) {
    write(info, value ? "true" : "false", "true, false");
  }
  void operator()(const ParameterInfo& info, const std::string& value) { write(info, quoted(value), "a name"); }
  template <class Enum, class = std::enable_if_t<std::is_enum_v<Enum>>>
  void operator()(const ParameterInfo& info, const Enum& value) {
    write(info, nameOf(value), fmt::format("{}", fmt::join(namesOf(value), ", ")));
  }

  void write(const ParameterInfo& info, const std::string& value, const std::string& range) {
    out.in(info.group) << "# " << info.meaning << '\n'
                       << "# (" << range << (info.reconfigurable ? "; while running, too)\n" : ")\n") << info.name
                       << ": " << value << '\n';
  }
};

/// The generator refuses descriptions with quotes in them.
std::string description(const std::string& text) {
  if (text.find('\'') != std::string::npos) throw std::logic_error("an apostrophe in a description: " + text);
  return quoted(text);
}

struct CfgWriter {
  GroupedText& out;

  template <class Number>
  void operator()(const ParameterInfo& info, const Number& value, Number min, Number max) {
    const char* type = std::is_same_v<Number, double> ? "double_t" : "int_t";
    write(info, type, textOf(value), ", " + textOf(min) + ", " + textOf(max));
  }
  void operator()(const ParameterInfo& info, const bool& value) { write(info, "bool_t", value ? "True" : "False", ""); }
  void operator()(const ParameterInfo& info, const std::string& value) { write(info, "str_t", quoted(value), ""); }
  template <class Enum, class = std::enable_if_t<std::is_enum_v<Enum>>>
  void operator()(const ParameterInfo& info, const Enum& value) {
    if (!info.reconfigurable) return;
    std::ostream& text = out.in(info.group);
    text << info.name << "_enum = gen.enum([\n";
    for (const std::string& name : namesOf(value)) {
      text << "    gen.const(" << quoted(info.name + ("_" + name)) << ", str_t, " << quoted(name) << ", "
           << quoted(name) << "),\n";
    }
    text << "], " << description(info.meaning) << ")\n";
    write(info, "str_t", quoted(nameOf(value)), ", edit_method=" + std::string(info.name) + "_enum");
  }

  void write(const ParameterInfo& info, const std::string& type, const std::string& value, const std::string& more) {
    if (!info.reconfigurable) return;
    const std::string unit = *info.unit == '\0' ? "" : std::string(" [") + info.unit + "]";
    out.in(info.group) << "group.add(" << quoted(info.name) << ", " << type << ", " << levelOf(info) << ",\n          "
                       << description(info.meaning + unit) << ",\n          " << value << more << ")\n";
  }
};

}  // namespace

ReconfigureLevel levelOf(const ParameterInfo& info) {
  return info.group == ParameterGroup::kNode ? kSwitch : kRebuildsGrid;
}

std::string defaultYaml() {
  Config config;
  GroupedText groups;
  visitParameters(config, YamlWriter{groups});
  return "# Every parameter with its default. Written from the code by donex_write_parameters: change it there.\n" +
         groups.text("# --- ", " ---");
}

std::string paperYaml(Method method) {
  const Config paper = paperConfig(method, Compensation::kResample);
  const std::vector<Parameter> defaults = parametersOf(Config()), ours = parametersOf(paper);
  std::ostringstream out;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const bool is_step_off = isBeyondPaper(ours[i].info) && ours[i].value != defaults[i].value;
    if (is_step_off) out << ours[i].info.name << ": false\n";
  }
  return "# The paper's method exactly; what is not named here is as in default.yaml. Written from the code by\n"
         "# donex_write_parameters: change it there.\n"
         "method: " +
         nameOf(paper.method) + "\ncompensation: " + nameOf(paper.compensation) +
         "\n\n# --- Steps beyond the paper ---\n" + out.str();
}

std::string reconfigureCfg() {
  Config config;
  GroupedText groups;
  visitParameters(config, CfgWriter{groups});
  return "#!/usr/bin/env python3\n"
         "# The parameters that can be changed while running. Written from the code by donex_write_parameters:\n"
         "# change it there.\n"
         "from dynamic_reconfigure.parameter_generator_catkin import ParameterGenerator, bool_t, double_t, int_t, "
         "str_t\n"
         "\n"
         "gen = ParameterGenerator()\n" +
         groups.text("group = gen.add_group(\"", "\")") + "\nexit(gen.generate(\"donex\", \"donex\", \"Donex\"))\n";
}

}  // namespace donex
