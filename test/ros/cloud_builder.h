// PointCloud2 of any layout, made field by field: drivers' own, and broken ones.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <boost/make_shared.hpp>
#include <sensor_msgs/PointCloud2.h>

namespace donex::test {

using sensor_msgs::PointCloud2;
using sensor_msgs::PointField;

class CloudBuilder {
 public:
  CloudBuilder() : cloud_(boost::make_shared<PointCloud2>()) {
    cloud_->header.frame_id = "lidar";
    cloud_->header.stamp.fromSec(100.0);
    cloud_->is_dense = 1;
  }

  CloudBuilder& frame(const std::string& frame) {
    cloud_->header.frame_id = frame;
    return *this;
  }
  CloudBuilder& stamp(double seconds) {
    cloud_->header.stamp.fromSec(seconds);
    return *this;
  }
  CloudBuilder& bigEndian() {
    cloud_->is_bigendian = 1;
    return *this;
  }
  /// A field at the next free byte.
  CloudBuilder& field(const std::string& name, std::uint8_t datatype) { return fieldAt(name, datatype, step_); }
  CloudBuilder& fieldAt(const std::string& name, std::uint8_t datatype, std::uint32_t offset) {
    PointField field;
    field.name = name;
    field.datatype = datatype;
    field.offset = offset;
    field.count = 1;
    cloud_->fields.push_back(field);
    step_ = std::max(step_, offset + sizeOf(datatype));
    return *this;
  }
  CloudBuilder& xyz(std::uint8_t datatype = PointField::FLOAT32) {
    return field("x", datatype).field("y", datatype).field("z", datatype);
  }
  /// Bytes without a field, at the end of each point and of each row.
  CloudBuilder& padding(std::uint32_t bytes) {
    step_ += bytes;
    return *this;
  }
  CloudBuilder& pointStep(std::uint32_t bytes) {
    step_ = bytes;
    return *this;
  }
  CloudBuilder& rowPadding(std::uint32_t bytes) {
    row_padding_ = bytes;
    return *this;
  }
  /// Fills every byte with a pattern, so that lost and shifted bytes show.
  CloudBuilder& size(std::uint32_t width, std::uint32_t height = 1) {
    cloud_->width = width;
    cloud_->height = height;
    cloud_->point_step = step_;
    cloud_->row_step = width * step_ + row_padding_;
    cloud_->data.resize(std::size_t{cloud_->row_step} * height);
    for (std::size_t i = 0; i < cloud_->data.size(); ++i) cloud_->data[i] = static_cast<std::uint8_t>(i * 131 + 17);
    return *this;
  }
  CloudBuilder& set(std::size_t echo, const std::string& name, double value) {
    for (const PointField& field : cloud_->fields) {
      if (field.name == name) write(pointOf(echo) + field.offset, field.datatype, value);
    }
    return *this;
  }
  CloudBuilder& at(std::size_t echo, double x, double y, double z) {
    return set(echo, "x", x).set(echo, "y", y).set(echo, "z", z);
  }

  boost::shared_ptr<PointCloud2> build() const { return cloud_; }

 private:
  static std::uint32_t sizeOf(std::uint8_t datatype) {
    constexpr std::uint32_t kSizes[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[datatype];
  }
  std::uint8_t* pointOf(std::size_t echo) {
    const std::size_t row = echo / cloud_->width, column = echo % cloud_->width;
    return cloud_->data.data() + row * cloud_->row_step + column * cloud_->point_step;
  }
  template <class Number>
  void put(std::uint8_t* to, Number number) const {
    std::uint8_t bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    if (cloud_->is_bigendian != 0) std::reverse(bytes, bytes + sizeof number);
    std::memcpy(to, bytes, sizeof number);
  }
  void write(std::uint8_t* to, std::uint8_t datatype, double value) const {
    switch (datatype) {
      case PointField::FLOAT32: return put(to, static_cast<float>(value));
      case PointField::FLOAT64: return put(to, value);
      case PointField::UINT32: return put(to, static_cast<std::uint32_t>(value));
      case PointField::INT32: return put(to, static_cast<std::int32_t>(value));
      case PointField::INT16:
      case PointField::UINT16: return put(to, static_cast<std::uint16_t>(value));
      default: return put(to, static_cast<std::uint8_t>(value));
    }
  }

  boost::shared_ptr<PointCloud2> cloud_;
  std::uint32_t step_ = 0, row_padding_ = 0;
};

/// An unorganised cloud with x, y, z, intensity.
inline boost::shared_ptr<PointCloud2> plainCloud(const std::vector<Eigen::Vector3f>& echoes, double stamp,
                                                 const std::string& frame = "lidar") {
  CloudBuilder builder;
  builder.frame(frame).stamp(stamp).xyz().field("intensity", PointField::FLOAT32);
  builder.size(static_cast<std::uint32_t>(echoes.size()));
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    builder.at(i, static_cast<double>(echoes[i].x()), static_cast<double>(echoes[i].y()),
               static_cast<double>(echoes[i].z()));
  }
  return builder.build();
}

}  // namespace donex::test
