#include "ros/strict_parameters.h"

namespace donex {

using XmlRpc::XmlRpcValue;

StrictParameters::StrictParameters(const ros::NodeHandle& pnh) { pnh.getParam(pnh.getNamespace(), values_); }

XmlRpcValue* StrictParameters::find(const std::string& name) {
  known_.insert(name);
  const bool there = values_.getType() == XmlRpcValue::TypeStruct && values_.hasMember(name);
  return there ? &values_[name] : nullptr;
}

template <class Value>
void StrictParameters::readAs(const std::string& name, XmlRpcValue::Type type, const char* wanted, Value& value) {
  XmlRpcValue* found = find(name);
  if (found == nullptr) return;
  if (found->getType() == type) {
    value = static_cast<Value&>(*found);
  } else {
    faults_.push_back(name + " must be " + wanted);
  }
}

void StrictParameters::read(const std::string& name, double& value) {
  XmlRpcValue* found = find(name);
  const bool whole = found != nullptr && found->getType() == XmlRpcValue::TypeInt;
  if (whole) {
    value = static_cast<int&>(*found);
  } else {
    readAs(name, XmlRpcValue::TypeDouble, "a number", value);
  }
}

void StrictParameters::read(const std::string& name, int& value) {
  readAs(name, XmlRpcValue::TypeInt, "an integer", value);
}

void StrictParameters::read(const std::string& name, bool& value) {
  readAs(name, XmlRpcValue::TypeBoolean, "a boolean", value);
}

void StrictParameters::read(const std::string& name, std::string& value) {
  readAs(name, XmlRpcValue::TypeString, "a string", value);
}

std::vector<std::string> StrictParameters::faults() const {
  std::vector<std::string> faults = faults_;
  if (values_.getType() != XmlRpcValue::TypeStruct) return faults;
  XmlRpcValue copy = values_;  // iterating is not const
  for (const auto& entry : copy) {
    if (known_.count(entry.first) == 0) faults.push_back("unknown parameter '" + entry.first + "'");
  }
  return faults;
}

}  // namespace donex
