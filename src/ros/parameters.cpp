#include "ros/parameters.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <type_traits>

#include <dynamic_reconfigure/config_tools.h>
#include <fmt/ranges.h>

#include "donex/memory_bound.h"
#include "donex/parameters.h"

namespace donex {
namespace {

using dynamic_reconfigure::ConfigTools;
using XmlRpc::XmlRpcValue;
using Faults = std::vector<std::string>;

const char* typeName(const XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean: return "a boolean";
    case XmlRpcValue::TypeInt: return "an integer";
    case XmlRpcValue::TypeDouble: return "a number";
    case XmlRpcValue::TypeString: return "a string";
    case XmlRpcValue::TypeArray: return "a list";
    case XmlRpcValue::TypeStruct: return "a map";
    default: return "of an unknown type";
  }
}

template <class Enum>
std::string choices(Enum value) {
  return fmt::format("{}", fmt::join(namesOf(value), ", "));
}

template <class Enum>
void setByName(const ParameterInfo& info, const std::string& name, Enum& value, Faults& faults) {
  const auto& names = namesOf(value);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) {
    value = static_cast<Enum>(found - names.begin());
    return;
  }
  faults.push_back(std::string(info.name) + " is '" + name + "', must be one of " + choices(value));
}

template <class Enum>
using IfEnum = std::enable_if_t<std::is_enum_v<Enum>>;

/// Sets parameters from a map of the parameter server; leaves what the map does not hold.
struct XmlRpcReader {
  XmlRpcValue& values;
  Faults& faults;
  std::set<std::string>& known;

  void operator()(const ParameterInfo& info, double& out, double, double) {
    XmlRpcValue* value = find(info);
    if (value == nullptr) return;
    // 50 is a number, too, although YAML reads it as an integer.
    if (value->getType() == XmlRpcValue::TypeInt) {
      out = static_cast<int&>(*value);
    } else if (expect(info, *value, XmlRpcValue::TypeDouble, "a number")) {
      out = static_cast<double&>(*value);
    }
  }
  void operator()(const ParameterInfo& info, int& out, int, int) {
    XmlRpcValue* value = find(info);
    if (value != nullptr && expect(info, *value, XmlRpcValue::TypeInt, "an integer")) out = static_cast<int&>(*value);
  }
  void operator()(const ParameterInfo& info, bool& out) {
    XmlRpcValue* value = find(info);
    if (value != nullptr && expect(info, *value, XmlRpcValue::TypeBoolean, "a boolean")) {
      out = static_cast<bool&>(*value);
    }
  }
  void operator()(const ParameterInfo& info, std::string& out) {
    XmlRpcValue* value = find(info);
    if (value != nullptr && expect(info, *value, XmlRpcValue::TypeString, "a string")) {
      out = static_cast<std::string&>(*value);
    }
  }
  template <class Enum, class = IfEnum<Enum>>
  void operator()(const ParameterInfo& info, Enum& out) {
    XmlRpcValue* value = find(info);
    if (value != nullptr && expect(info, *value, XmlRpcValue::TypeString, ("one of " + choices(out)).c_str())) {
      setByName(info, static_cast<std::string&>(*value), out, faults);
    }
  }

  XmlRpcValue* find(const ParameterInfo& info) {
    known.insert(info.name);
    return values.hasMember(info.name) ? &values[info.name] : nullptr;
  }
  bool expect(const ParameterInfo& info, const XmlRpcValue& value, XmlRpcValue::Type type, const char* wanted) {
    if (value.getType() == type) return true;
    faults.push_back(std::string(info.name) + " is " + typeName(value) + ", must be " + wanted);
    return false;
  }
};

struct MessageWriter {
  dynamic_reconfigure::Config& message;

  template <class Number>
  void operator()(const ParameterInfo& info, const Number& value, Number, Number) {
    append(info, value);
  }
  void operator()(const ParameterInfo& info, const bool& value) { append(info, value); }
  void operator()(const ParameterInfo& info, const std::string& value) { append(info, value); }
  template <class Enum, class = IfEnum<Enum>>
  void operator()(const ParameterInfo& info, const Enum& value) {
    append(info, nameOf(value));
  }
  template <class Value>
  void append(const ParameterInfo& info, const Value& value) {
    if (info.reconfigurable) ConfigTools::appendParameter(message, std::string(info.name), value);
  }
};

struct MessageReader {
  const dynamic_reconfigure::Config& message;
  Faults& faults;

  template <class Number>
  void operator()(const ParameterInfo& info, Number& value, Number, Number) {
    read(info, value);
  }
  void operator()(const ParameterInfo& info, bool& value) { read(info, value); }
  void operator()(const ParameterInfo& info, std::string& value) { read(info, value); }
  template <class Enum, class = IfEnum<Enum>>
  void operator()(const ParameterInfo& info, Enum& value) {
    std::string name;
    if (read(info, name)) setByName(info, name, value, faults);
  }
  template <class Value>
  bool read(const ParameterInfo& info, Value& value) {
    return info.reconfigurable && ConfigTools::getParameter(message, std::string(info.name), value);
  }
};

void addTo(Faults& faults, const Faults& more) { faults.insert(faults.end(), more.begin(), more.end()); }

}  // namespace

Faults applyParameters(const XmlRpcValue& values, Config& config) {
  if (!values.valid()) return faultsOf(config);
  if (values.getType() != XmlRpcValue::TypeStruct) {
    return {std::string("the parameters are ") + typeName(values) + ", must be a map"};
  }
  XmlRpcValue copy = values;
  Faults faults;
  std::set<std::string> known{"diagnostic_period"};  // diagnostic_updater's own
  visitParameters(config, XmlRpcReader{copy, faults, known});
  for (const auto& [name, value] : copy) {
    if (known.count(name) == 0) faults.push_back("unknown parameter '" + name + "'");
  }
  addTo(faults, faultsOf(config));
  return faults;
}

Config readParameters(const ros::NodeHandle& pnh) {
  XmlRpcValue values;
  pnh.getParam(pnh.getNamespace(), values);
  Config config;
  const Faults faults = applyParameters(values, config);
  if (faults.empty()) return config;
  throw std::invalid_argument("bad parameters in " + pnh.getNamespace() + ": " + joined(faults));
}

dynamic_reconfigure::Config toMessage(const Config& config) {
  dynamic_reconfigure::Config message;
  Config copy = config;
  visitParameters(copy, MessageWriter{message});
  return message;
}

Faults applyMessage(const dynamic_reconfigure::Config& message, Config& config) {
  Faults faults;
  visitParameters(config, MessageReader{message, faults});
  addTo(faults, faultsOf(config));
  return faults;
}

bool sameDetection(const Config& a, const Config& b) {
  Config with_switches_of_b = a;
  with_switches_of_b.node = b.node;
  return with_switches_of_b == b;
}

std::string joined(const Faults& faults) { return fmt::format("{}", fmt::join(faults, "; ")); }

}  // namespace donex
