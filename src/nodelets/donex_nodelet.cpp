// donex/DonexNodelet.
#include <memory>

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include "ros/donex_node.h"

namespace donex {

class DonexNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      node_ = std::make_unique<DonexNode>(getNodeHandle(), getPrivateNodeHandle());
    } catch (const std::exception& error) {
      // The manager swallows exceptions and only says that loading failed.
      NODELET_FATAL("%s", error.what());
      throw;
    }
  }

  std::unique_ptr<DonexNode> node_;
};

}  // namespace donex

PLUGINLIB_EXPORT_CLASS(donex::DonexNodelet, nodelet::Nodelet)
