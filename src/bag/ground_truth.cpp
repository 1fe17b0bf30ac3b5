#include "bag/ground_truth.h"

#include <algorithm>
#include <cstring>

#include <sensor_msgs/PointField.h>

namespace donex {

std::vector<std::uint32_t> truthOf(const sensor_msgs::PointCloud2& cloud, const CloudLayout& layout) {
  using sensor_msgs::PointField;
  const auto field = std::find_if(cloud.fields.begin(), cloud.fields.end(),
                                  [](const PointField& candidate) { return candidate.name == "label"; });
  const bool has_truth = field != cloud.fields.end() && field->datatype == PointField::UINT32 &&
                         field->offset + sizeof(std::uint32_t) <= layout.point_step;
  std::vector<std::uint32_t> truth(has_truth ? layout.echoes() : 0);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const std::size_t row = i / layout.width, column = i % layout.width;
    std::memcpy(&truth[i], &cloud.data[row * layout.row_step + column * layout.point_step + field->offset],
                sizeof(std::uint32_t));
    if (layout.swap_bytes) truth[i] = __builtin_bswap32(truth[i]);
  }
  return truth;
}

}  // namespace donex
