// A node as a nodelet.
#pragma once

#include <exception>
#include <memory>

#include <nodelet/nodelet.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

namespace donex {

/// A class that is built from (nh, pnh) as a nodelet. Its callbacks run on one thread of its own, not on the manager's
/// queues: the manager of nodelet 1.10.0 (Debian 11; Noetic until January 2021) drops what these are given until onInit
/// returns. From then on a timer, or a subscription with a queue of one, is dead; other subscriptions stay a message
/// behind.
template <class Node>
class NodeletOf : public nodelet::Nodelet {
 private:
  void onInit() override {
    ros::NodeHandle nh = getNodeHandle(), pnh = getPrivateNodeHandle();
    nh.setCallbackQueue(&queue_);
    pnh.setCallbackQueue(&queue_);
    try {
      node_ = std::make_unique<Node>(nh, pnh);
    } catch (const std::exception& error) {
      // The manager swallows exceptions and only says that loading failed.
      NODELET_FATAL("%s", error.what());
      throw;
    }
    spinner_.start();
  }

  ros::CallbackQueue queue_;
  std::unique_ptr<Node> node_;
  ros::AsyncSpinner spinner_{1, &queue_};  // the last member: it has stopped before the node goes
};

}  // namespace donex
