#include "ros/cloud_fields.h"

#include <boost/endian/conversion.hpp>
#include <boost/make_shared.hpp>

namespace donex {

sensor_msgs::PointCloud2Ptr makeCloud(const std_msgs::Header& header, std::size_t points, std::size_t point_step) {
  auto cloud = boost::make_shared<sensor_msgs::PointCloud2>();
  cloud->header = header;
  cloud->height = 1;
  cloud->width = static_cast<std::uint32_t>(points);
  cloud->point_step = static_cast<std::uint32_t>(point_step);
  cloud->row_step = static_cast<std::uint32_t>(points * point_step);
  cloud->is_bigendian = boost::endian::order::native == boost::endian::order::big;
  cloud->data.resize(points * point_step);
  return cloud;
}

void addField(sensor_msgs::PointCloud2& cloud, const std::string& name, std::size_t offset, std::uint8_t datatype) {
  sensor_msgs::PointField field;
  field.name = name;
  field.offset = static_cast<std::uint32_t>(offset);
  field.datatype = datatype;
  field.count = 1;
  cloud.fields.push_back(field);
}

}  // namespace donex
