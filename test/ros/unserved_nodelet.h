// A nodelet whose manager drops every callback.
#pragma once

#include <string>
#include <vector>

#include <boost/shared_ptr.hpp>
#include <nodelet/nodelet.h>
#include <pluginlib/class_loader.hpp>
#include <ros/callback_queue.h>

namespace donex::test {

/// As the manager of nodelet 1.10.0 drops them until onInit returns, but for ever.
class UnservedNodelet {
 public:
  UnservedNodelet(const std::string& name, const std::string& type, const ros::M_string& remappings = {})
      : nodelet_(classes_.createInstance(type)) {
    nodelet_->init(name, remappings, std::vector<std::string>(), &queue_, &queue_);
  }

 private:
  pluginlib::ClassLoader<nodelet::Nodelet> classes_{"nodelet", "nodelet::Nodelet"};
  ros::CallbackQueue queue_{false};
  boost::shared_ptr<nodelet::Nodelet> nodelet_;
};

}  // namespace donex::test
