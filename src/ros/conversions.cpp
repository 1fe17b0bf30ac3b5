#include "donex/ros/conversions.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

#include <boost/endian/conversion.hpp>
#include <boost/make_shared.hpp>

namespace donex {
namespace {

using sensor_msgs::PointCloud2;
using sensor_msgs::PointField;

/// The bits of a number at any address, in either byte order.
template <class Number, class Bits>
Number read(const std::uint8_t* at, bool swap) {
  static_assert(sizeof(Number) == sizeof(Bits));
  Bits bits;
  std::memcpy(&bits, at, sizeof bits);
  if (swap) boost::endian::endian_reverse_inplace(bits);
  Number number;
  std::memcpy(&number, &bits, sizeof number);
  return number;
}

float readFloat(const std::uint8_t* at, bool swap) { return read<float, std::uint32_t>(at, swap); }
double readDouble(const std::uint8_t* at, bool swap) { return read<double, std::uint64_t>(at, swap); }

/// A double beyond float's range becomes infinite: an echo that is kept and never dynamic.
float toFloat(double value) {
  using Limits = std::numeric_limits<float>;
  if (std::abs(value) <= static_cast<double>(Limits::max())) return static_cast<float>(value);
  if (std::isnan(value)) return Limits::quiet_NaN();
  return value > 0.0 ? Limits::infinity() : -Limits::infinity();
}

float readCoordinate(const std::uint8_t* point, FieldPosition field, bool swap) {
  const std::uint8_t* at = point + field.offset;
  return field.datatype == PointField::FLOAT32 ? readFloat(at, swap) : toFloat(readDouble(at, swap));
}

/// Calls visit(index of the echo, its first byte) for every echo in order.
template <class Visit>
void forEachPoint(const PointCloud2& cloud, const CloudLayout& layout, Visit&& visit) {
  std::size_t index = 0;
  for (std::size_t row = 0; row < layout.height; ++row) {
    const std::uint8_t* point = cloud.data.data() + row * layout.row_step;
    for (std::size_t column = 0; column < layout.width; ++column, point += layout.point_step) visit(index++, point);
  }
}

/// What nearly every driver writes: x, y, z as floats of this machine, one behind the other.
bool isPlain(const CloudLayout& layout) {
  const bool floats = layout.x.datatype == PointField::FLOAT32 && layout.y.datatype == PointField::FLOAT32 &&
                      layout.z.datatype == PointField::FLOAT32;
  const bool adjacent = layout.y.offset == layout.x.offset + 4 && layout.z.offset == layout.x.offset + 8;
  return floats && adjacent && !layout.swap_bytes;
}

/// Livox writes `timestamp` in nanoseconds, the others in seconds: no clock has seen 10^14 s.
double absoluteSeconds(double timestamp) { return std::abs(timestamp) > 1e14 ? timestamp * 1e-9 : timestamp; }

double readNumber(const std::uint8_t* at, std::uint8_t datatype, bool swap) {
  switch (datatype) {
    case PointField::FLOAT32: return static_cast<double>(readFloat(at, swap));
    case PointField::UINT32: return read<std::uint32_t, std::uint32_t>(at, swap);
    default: return readDouble(at, swap);
  }
}

double timeAfterStamp(const std::uint8_t* point, const TimeField& time, double stamp, bool swap) {
  const double value = readNumber(point + time.position.offset, time.position.datatype, swap);
  switch (time.encoding) {
    case TimeEncoding::kRelativeSeconds: return value;
    case TimeEncoding::kRelativeMicroseconds: return 1e-6 * value;
    case TimeEncoding::kRelativeNanoseconds: return 1e-9 * value;
    case TimeEncoding::kAbsoluteSeconds: return value - stamp;
    case TimeEncoding::kAbsoluteNanoseconds: return 1e-9 * value - stamp;
    case TimeEncoding::kAuto: break;
  }
  return absoluteSeconds(value) - stamp;
}

/// Ouster's and Livox' drivers write 0, 0, 0 where nothing came back: the sensor sees no echo in itself.
Eigen::Vector3f echoOf(const Eigen::Vector3f& position) {
  const bool is_no_return = (position.array() == 0.0F).all();
  return is_no_return ? Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()) : position;
}

bool isEcho(const std::uint8_t* point, const CloudLayout& layout) {
  const bool swap = layout.swap_bytes;
  return echoOf({readCoordinate(point, layout.x, swap), readCoordinate(point, layout.y, swap),
                 readCoordinate(point, layout.z, swap)})
      .allFinite();
}

/// The header of an output with `width` x `height` points; its data still zero.
sensor_msgs::PointCloud2Ptr emptyLike(const PointCloud2& cloud, std::size_t width, std::size_t height,
                                      std::size_t point_step) {
  auto out = boost::make_shared<PointCloud2>();
  out->header = cloud.header;
  out->fields = cloud.fields;
  out->is_bigendian = cloud.is_bigendian;
  out->is_dense = cloud.is_dense;
  out->width = static_cast<std::uint32_t>(width);
  out->height = static_cast<std::uint32_t>(height);
  out->point_step = static_cast<std::uint32_t>(point_step);
  out->row_step = static_cast<std::uint32_t>(width * point_step);
  out->data.resize(width * height * point_step);
  return out;
}

void addLabelField(PointCloud2& cloud, const char* name, std::uint32_t offset, std::size_t input_point_step) {
  const bool is_new = offset >= input_point_step;
  if (!is_new) return;
  PointField field;
  field.name = name;
  field.offset = offset;
  field.datatype = PointField::UINT8;
  field.count = 1;
  cloud.fields.push_back(field);
}

}  // namespace

void parseEchoes(const PointCloud2& cloud, const CloudLayout& layout, std::vector<Eigen::Vector3f>& echoes) {
  echoes.resize(layout.echoes());
  if (isPlain(layout)) {
    forEachPoint(cloud, layout, [&](std::size_t i, const std::uint8_t* point) {
      std::memcpy(echoes[i].data(), point + layout.x.offset, 3 * sizeof(float));
      echoes[i] = echoOf(echoes[i]);
    });
    return;
  }
  const bool swap = layout.swap_bytes;
  forEachPoint(cloud, layout, [&](std::size_t i, const std::uint8_t* point) {
    echoes[i] = echoOf({readCoordinate(point, layout.x, swap), readCoordinate(point, layout.y, swap),
                        readCoordinate(point, layout.z, swap)});
  });
}

EchoTimes parseEchoTimes(const PointCloud2& cloud, const CloudLayout& layout, std::string& problem) {
  problem.clear();
  EchoTimes times;
  if (!layout.time) return times;
  times.after_stamp.resize(layout.echoes());
  times.first = std::numeric_limits<double>::infinity();
  times.last = -times.first;
  const double stamp = cloud.header.stamp.toSec();
  double strange = 0.0;
  forEachPoint(cloud, layout, [&](std::size_t i, const std::uint8_t* point) {
    const double time = timeAfterStamp(point, *layout.time, stamp, layout.swap_bytes);
    times.after_stamp[i] = toFloat(time);
    if (!isEcho(point, layout)) return;
    const bool plausible = std::abs(time) <= kMaxScanDuration;
    if (!plausible) strange = time;
    times.first = std::min(times.first, time);
    times.last = std::max(times.last, time);
  });
  if (strange != 0.0) {
    std::ostringstream text;
    text << "echoes' times are no times of this scan (" << strange << " s after its stamp): not de-skewed";
    problem = text.str();
  }
  const bool usable = strange == 0.0 && times.first <= times.last;
  return usable ? times : EchoTimes{};
}

sensor_msgs::PointCloud2Ptr labelCloud(const PointCloud2& cloud, const CloudLayout& layout, const EchoLabels& labels) {
  auto out = emptyLike(cloud, layout.width, layout.height, layout.labeled_point_step);
  addLabelField(*out, "dynamic", layout.dynamic_offset, layout.point_step);
  addLabelField(*out, "observed", layout.observed_offset, layout.point_step);
  std::uint8_t* to = out->data.data();
  forEachPoint(cloud, layout, [&](std::size_t i, const std::uint8_t* point) {
    std::memcpy(to, point, layout.point_step);
    to[layout.dynamic_offset] = labels.dynamic[i];
    to[layout.observed_offset] = labels.observed[i];
    to += layout.labeled_point_step;
  });
  return out;
}

sensor_msgs::PointCloud2Ptr selectPart(const PointCloud2& cloud, const CloudLayout& layout, const EchoLabels& labels,
                                       CloudPart part) {
  const std::uint8_t wanted = part == CloudPart::kDynamic ? 1 : 0;
  const auto count = std::count(labels.dynamic.begin(), labels.dynamic.end(), wanted);
  auto out = emptyLike(cloud, static_cast<std::size_t>(count), 1, layout.point_step);
  std::uint8_t* to = out->data.data();
  forEachPoint(cloud, layout, [&](std::size_t i, const std::uint8_t* point) {
    if (labels.dynamic[i] != wanted) return;
    std::memcpy(to, point, layout.point_step);
    to += layout.point_step;
  });
  return out;
}

}  // namespace donex
