// donex/SimulatedLidarNodelet.
#include <memory>

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include "simulated_lidar/simulated_lidar.h"

namespace donex {

class SimulatedLidarNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      lidar_ = std::make_unique<SimulatedLidar>(getNodeHandle(), getPrivateNodeHandle());
    } catch (const std::exception& error) {
      // The manager swallows exceptions and only says that loading failed.
      NODELET_FATAL("%s", error.what());
      throw;
    }
  }

  std::unique_ptr<SimulatedLidar> lidar_;
};

}  // namespace donex

PLUGINLIB_EXPORT_CLASS(donex::SimulatedLidarNodelet, nodelet::Nodelet)
