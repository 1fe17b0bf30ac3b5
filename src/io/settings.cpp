#include "io/settings.h"

#include <algorithm>
#include <optional>
#include <sstream>

#include <fmt/ranges.h>

#include "donex/memory_bound.h"
#include "donex/parameters.h"

namespace donex {
namespace {

std::size_t endOfSign(const std::string& text) { return !text.empty() && (text[0] == '-' || text[0] == '+') ? 1 : 0; }
std::size_t endOfDigits(const std::string& text, std::size_t from) {
  return std::min(text.find_first_not_of("0123456789", from), text.size());
}

// rosparam reads YAML 1.1: "1e-3" and "010" would reach a node as a string and as eight. The same file has to
// mean the same here, so that such spellings are refused.

/// An optional sign, digits without a leading zero.
bool isInteger(const std::string& text) {
  const std::size_t first = endOfSign(text), end = endOfDigits(text, first), digits = end - first;
  return digits > 0 && end == text.size() && (text[first] != '0' || digits == 1);
}
/// e or E, a sign, digits.
bool isExponent(const std::string& text) {
  if (text.size() < 3 || (text[0] != 'e' && text[0] != 'E')) return false;
  return (text[1] == '-' || text[1] == '+') && endOfDigits(text, 2) == text.size();
}
/// An integer; or an optional sign, digits with a point, an optional exponent.
bool isReal(const std::string& text) {
  const std::size_t first = endOfSign(text), point = endOfDigits(text, first);
  if (point == text.size() || text[point] != '.') return isInteger(text);
  const std::size_t end = endOfDigits(text, point + 1);
  const bool has_digits = end - first > 1;
  return has_digits && (end == text.size() || isExponent(text.substr(end)));
}
std::optional<bool> parseBool(const std::string& text) {
  for (const char* yes : {"yes", "Yes", "YES", "true", "True", "TRUE", "on", "On", "ON"}) {
    if (text == yes) return true;
  }
  for (const char* no : {"no", "No", "NO", "false", "False", "FALSE", "off", "Off", "OFF"}) {
    if (text == no) return false;
  }
  return std::nullopt;
}
bool isQuoted(const YAML::Node& value) { return value.Tag() == "!"; }
bool isText(const YAML::Node& value) {
  const std::string& text = value.Scalar();
  return isQuoted(value) || !(text.empty() || isReal(text) || parseBool(text));
}

std::string shown(const YAML::Node& value) {
  if (value.IsNull()) return "nothing";
  if (value.IsMap()) return "a map";
  if (value.IsSequence()) return "a list";
  constexpr std::size_t kMost = 80;  // characters of a text that is not a parameter's value
  const std::string& all = value.Scalar();
  const std::string text = all.size() > kMost ? all.substr(0, kMost) + "..." : all;
  return isQuoted(value) ? fmt::format("\"{}\"", text) : text;
}

/// Takes from the settings what a parameter asks for, strictly by its type.
class SettingsVisitor {
 public:
  SettingsVisitor(Settings& settings, Faults& faults) : settings_(settings), faults_(faults) {}

  void operator()(const ParameterInfo& info, double& value, double, double) {
    const auto text = unquotedScalar(info);
    if (!text) return;
    if (isReal(*text)) return read(info, *text, value);
    refuse(info, "must be a number (written as 0.5 or 1.0e-3)");
  }
  void operator()(const ParameterInfo& info, int& value, int, int) {
    const auto text = unquotedScalar(info);
    if (!text) return;
    if (isInteger(*text)) return read(info, *text, value);
    refuse(info, "must be a whole number");
  }
  void operator()(const ParameterInfo& info, bool& value) {
    const auto text = unquotedScalar(info);
    if (!text) return;
    const auto parsed = parseBool(*text);
    if (!parsed) return refuse(info, "must be true or false");
    value = *parsed;
  }
  void operator()(const ParameterInfo& info, std::string& value) {
    const Setting* setting = find(info);
    if (setting == nullptr) return;
    if (!setting->value.IsScalar() || !isText(setting->value)) return refuse(info, "must be text");
    value = setting->value.Scalar();
  }
  template <class Enum>
  std::enable_if_t<std::is_enum_v<Enum>> operator()(const ParameterInfo& info, Enum& value) {
    const Setting* setting = find(info);
    if (setting == nullptr) return;
    const std::vector<std::string>& names = namesOf(value);
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (setting->value.IsScalar() && setting->value.Scalar() == names[i]) {
        value = static_cast<Enum>(i);
        return;
      }
    }
    refuse(info, fmt::format("must be one of {}", fmt::join(names, ", ")));
  }

 private:
  Setting* find(const ParameterInfo& info) {
    const auto found = settings_.find(info.name);
    if (found == settings_.end()) return nullptr;
    found->second.used = true;
    return &found->second;
  }
  /// The text of a plain scalar, empty text for anything else; nothing when the parameter isn't set.
  std::optional<std::string> unquotedScalar(const ParameterInfo& info) {
    const Setting* setting = find(info);
    if (setting == nullptr) return std::nullopt;
    const bool plain = setting->value.IsScalar() && !isQuoted(setting->value);
    return plain ? setting->value.Scalar() : std::string();
  }
  template <class Number>
  void read(const ParameterInfo& info, const std::string& text, Number& value) {
    std::istringstream stream(text[0] == '+' ? text.substr(1) : text);
    stream.imbue(std::locale::classic());
    Number number{};
    if (!(stream >> number)) return refuse(info, "is too large");
    value = number;
  }
  void refuse(const ParameterInfo& info, const std::string& reason) {
    const Setting& setting = settings_.at(info.name);
    faults_.add(fmt::format("{}: {} is {}, {}", setting.where, info.name, shown(setting.value), reason));
  }

  Settings& settings_;
  Faults& faults_;
};

/// A fault of faultsOf starts with a parameter's name: tell where that was set.
std::string located(const std::string& fault, const Settings& settings, const std::string& source) {
  for (const auto& [name, setting] : settings) {
    if (fault.find(name + " is ") != std::string::npos) return setting.where + ": " + fault;
  }
  return source + ": " + fault;
}

}  // namespace

void apply(Settings& settings, Config& config, const std::string& source, Faults& faults) {
  visitParameters(config, SettingsVisitor(settings, faults));
  for (const auto& [name, setting] : settings) {
    if (!setting.used) faults.add(fmt::format("{}: there is no parameter {}", setting.where, name));
  }
  for (const std::string& fault : faultsOf(config)) faults.add(located(fault, settings, source));
}

}  // namespace donex
