// Any bytes as a CustomMsg of Livox' drivers: refused, or a cloud whose layout is sound.
#include <cstdlib>
#include <exception>
#include <variant>

#include "ros/cloud_layout.h"
#include "ros/livox_cloud.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  sensor_msgs::PointCloud2ConstPtr cloud;
  try {
    cloud = donex::livoxCloud(data, size);
  } catch (const std::exception&) {
    return 0;
  }
  const auto verdict = donex::judgeLayout(*cloud);
  const auto* layout = std::get_if<donex::CloudLayout>(&verdict);
  if (layout == nullptr || layout->echoes() != cloud->width) std::abort();
  return 0;
}
