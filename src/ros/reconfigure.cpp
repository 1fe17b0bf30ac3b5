#include "ros/reconfigure.h"

#include <utility>

#include <boost/thread/recursive_mutex.hpp>
#include <donex/DonexConfig.h>
#include <dynamic_reconfigure/server.h>

#include "ros/parameters.h"

namespace donex {
namespace {

/// The generated class without its clamping: a value out of range is refused, not clamped silently.
struct UnclampedConfig : DonexConfig {
  UnclampedConfig() = default;
  UnclampedConfig(const DonexConfig& config) : DonexConfig(config) {}
  void __clamp__() {}  // NOLINT(bugprone-reserved-identifier): the generator names it so
};

UnclampedConfig generatedFrom(const Config& config) {
  UnclampedConfig generated = DonexConfig::__getDefault__();
  dynamic_reconfigure::Config message;
  generated.__toMessage__(message);  // the groups' states, without which no message is accepted
  const dynamic_reconfigure::Config values = toMessage(config);
  message.bools = values.bools;
  message.ints = values.ints;
  message.doubles = values.doubles;
  message.strs = values.strs;
  generated.__fromMessage__(message);
  return generated;
}

}  // namespace

class Reconfigure::Server {
 public:
  Server(const ros::NodeHandle& pnh, Config start, Accept accept)
      : current_(std::move(start)), accept_(std::move(accept)), server_(mutex_, pnh) {
    server_.updateConfig(generatedFrom(current_));
    server_.setCallback([this](UnclampedConfig& wanted, std::uint32_t) { change(wanted); });
  }

 private:
  void change(UnclampedConfig& wanted) {
    dynamic_reconfigure::Config message;
    wanted.__toMessage__(message);
    Config config = current_;
    const auto faults = applyMessage(message, config);
    if (faults.empty()) {
      take(config);
    } else {
      ROS_ERROR_STREAM("change of parameters refused, the old values stay: " << joined(faults));
    }
    wanted = generatedFrom(current_);
  }

  void take(const Config& config) {
    try {
      accept_(config);
      current_ = config;
    } catch (const std::exception& error) {
      ROS_ERROR_STREAM("change of parameters refused, the old values stay: " << error.what());
    }
  }

  Config current_;
  Accept accept_;
  boost::recursive_mutex mutex_;
  dynamic_reconfigure::Server<UnclampedConfig> server_;
};

Reconfigure::Reconfigure(const ros::NodeHandle& pnh, const Config& start, Accept accept)
    : server_(std::make_unique<Server>(pnh, start, std::move(accept))) {}

Reconfigure::~Reconfigure() = default;

}  // namespace donex
