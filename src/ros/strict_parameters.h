// Private parameters read strictly: a wrong type or an unknown name is a fault, never silently the default.
#pragma once

#include <set>
#include <string>
#include <vector>

#include <XmlRpcValue.h>
#include <ros/node_handle.h>

namespace donex {

class StrictParameters {
 public:
  /// Takes everything in the private namespace of the node as it is now.
  explicit StrictParameters(const ros::NodeHandle& pnh);

  /// Each leaves `value` where there is no such parameter. An integer is a number, too.
  void read(const std::string& name, double& value);
  void read(const std::string& name, int& value);
  void read(const std::string& name, bool& value);
  void read(const std::string& name, std::string& value);

  /// Wrong types, and every name that was never read.
  std::vector<std::string> faults() const;

 private:
  XmlRpc::XmlRpcValue* find(const std::string& name);
  template <class Value>
  void readAs(const std::string& name, XmlRpc::XmlRpcValue::Type type, const char* wanted, Value& value);

  XmlRpc::XmlRpcValue values_;
  std::set<std::string> known_;
  std::vector<std::string> faults_;
};

}  // namespace donex
