// dynamic_reconfigure for whatever the configuration marks as reconfigurable.
#pragma once

#include <functional>
#include <memory>

#include <ros/node_handle.h>

#include "donex/config.h"

namespace donex {

/// Offers ~set_parameters. Bad values are refused as a whole: the old ones stay, and the server shows them.
class Reconfigure {
 public:
  /// Takes over a faultless configuration; throws std::exception to refuse it.
  using Accept = std::function<void(const Config&)>;

  /// `accept` is called from the service only, on pnh's callback queue.
  Reconfigure(const ros::NodeHandle& pnh, const Config& start, Accept accept);
  ~Reconfigure();

 private:
  class Server;
  std::unique_ptr<Server> server_;
};

}  // namespace donex
