#include "ros/conversions.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

#include <boost/endian/conversion.hpp>
#include <boost/make_shared.hpp>

#include "ros/cloud_fields.h"

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

/// Numbers of rings that are negative are told apart like all others.
std::uint32_t readRing(const std::uint8_t* at, std::uint8_t datatype, bool swap) {
  switch (datatype) {
    case PointField::INT8:
    case PointField::UINT8: return *at;
    case PointField::INT16:
    case PointField::UINT16: return read<std::uint16_t, std::uint16_t>(at, swap);
    default: return read<std::uint32_t, std::uint32_t>(at, swap);
  }
}

/// Calls visit(index of the echo, its first byte) for every echo in order. Its own copy of the layout: bytes that
/// `visit` writes might be any object's, and what may have changed is read again for every echo.
template <class Visit>
void forEachPoint(const PointCloud2& cloud, const CloudLayout layout, Visit&& visit) {
  const std::uint8_t* row = cloud.data.data();
  std::size_t index = 0;
  const std::size_t rows = layout.width == 0 ? 0 : layout.height;  // billions of empty rows need no byte
  for (std::size_t i = 0; i < rows; ++i, row += layout.row_step) {
    const std::uint8_t* point = row;
    for (std::size_t column = 0; column < layout.width; ++column, point += layout.point_step) visit(index++, point);
  }
}

/// Ouster's and Livox' drivers write 0, 0, 0 for a beam without an echo.
Eigen::Vector3f echoOf(const Eigen::Vector3f& position) {
  const bool is_no_return = (position.array() == 0.0F).all();
  return is_no_return ? Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()) : position;
}

/// What nearly every driver writes: x, y, z as floats of this machine, one behind the other.
bool isPlain(const CloudLayout& layout) {
  const bool floats = layout.x.datatype == PointField::FLOAT32 && layout.y.datatype == PointField::FLOAT32 &&
                      layout.z.datatype == PointField::FLOAT32;
  const bool adjacent = layout.y.offset == layout.x.offset + 4 && layout.z.offset == layout.x.offset + 8;
  return floats && adjacent && !layout.swap_bytes;
}

/// Calls visit(index of the echo, the echo, its first byte) for every echo in order.
template <class Visit>
void forEachEcho(const PointCloud2& cloud, const CloudLayout& layout, Visit&& visit) {
  if (isPlain(layout)) {
    forEachPoint(cloud, layout, [&](std::size_t i, const std::uint8_t* point) {
      Eigen::Vector3f position;
      std::memcpy(position.data(), point + layout.x.offset, 3 * sizeof(float));
      visit(i, echoOf(position), point);
    });
    return;
  }
  const bool swap = layout.swap_bytes;
  forEachPoint(cloud, layout, [&](std::size_t i, const std::uint8_t* point) {
    const Eigen::Vector3f position(readCoordinate(point, layout.x, swap), readCoordinate(point, layout.y, swap),
                                   readCoordinate(point, layout.z, swap));
    visit(i, echoOf(position), point);
  });
}

/// Reads times of one encoding: after the stamp they are scale x what is written - origin.
class TimeReader {
 public:
  TimeReader(const TimeField& field, double stamp, bool swap)
      : offset_(field.position.offset),
        datatype_(field.position.datatype),
        swap_(swap),
        least_(field.least),
        most_(field.most),
        first_(field.first),
        last_(field.last),
        unit_by_magnitude_(field.encoding == TimeEncoding::kAuto) {
    switch (field.encoding) {
      case TimeEncoding::kRelativeSeconds: break;
      case TimeEncoding::kRelativeMicroseconds: scale_ = 1e-6; break;
      case TimeEncoding::kRelativeNanoseconds: scale_ = 1e-9; break;
      case TimeEncoding::kAbsoluteNanoseconds: scale_ = 1e-9; [[fallthrough]];
      case TimeEncoding::kAbsoluteSeconds:
      case TimeEncoding::kAuto: origin_ = stamp; break;
    }
    if (field.unit) scale_ = *field.unit;
  }

  /// After the stamp [s].
  double afterStamp(double written) const {
    const bool is_nanoseconds = unit_by_magnitude_ && std::abs(written) > kSecondsOfNoClock;
    return (is_nanoseconds ? 1e-9 : scale_) * written - origin_;
  }

  /// Of what is no time of the scan its nearest end; of NaN the first.
  double within(double written) const {
    if (written > most_) return last_;
    return written >= least_ ? written : first_;
  }

  /// In no unit yet.
  double written(const std::uint8_t* point) const { return number(point + offset_); }

 private:
  double number(const std::uint8_t* at) const {
    switch (datatype_) {
      case PointField::FLOAT32: return static_cast<double>(readFloat(at, swap_));
      case PointField::UINT32: return read<std::uint32_t, std::uint32_t>(at, swap_);
      case PointField::INT32: return read<std::int32_t, std::uint32_t>(at, swap_);
      default: return readDouble(at, swap_);
    }
  }

  std::uint32_t offset_;
  std::uint8_t datatype_;
  bool swap_;
  double least_, most_, first_, last_;  // as written
  bool unit_by_magnitude_;
  double scale_ = 1.0, origin_ = 0.0;  // [s a unit], [s]
};

std::string strangeTimes(double time) {
  std::ostringstream text;
  text << "echoes' times are no times of this scan (" << time << " s after its stamp): not de-skewed";
  return text.str();
}

/// The length of a point is known only at run time: std::memcpy would be a call for every one.
void copyPoint(std::uint8_t* to, const std::uint8_t* from, std::size_t size) {
  constexpr std::size_t kChunk = 16;
  if (size < kChunk) {
    std::memcpy(to, from, size);
    return;
  }
  for (std::size_t i = 0; i + kChunk <= size; i += kChunk) std::memcpy(to + i, from + i, kChunk);
  std::memcpy(to + size - kChunk, from + size - kChunk, kChunk);
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
  if (is_new) addField(cloud, name, offset, PointField::UINT8);
}

}  // namespace

void EchoTimes::clear() {
  after_stamp.clear();
  first = last = 0.0;
  wild = 0;
  problem.clear();
}

void parseEchoes(const PointCloud2& cloud, const CloudLayout& layout, std::vector<Eigen::Vector3f>& echoes) {
  echoes.resize(layout.echoes());
  forEachEcho(cloud, layout,
              [&](std::size_t i, const Eigen::Vector3f& echo, const std::uint8_t*) { echoes[i] = echo; });
}

void parseEchoes(const PointCloud2& cloud, const CloudLayout& layout, std::vector<Eigen::Vector3f>& echoes,
                 EchoTimes& times) {
  if (!layout.time) {
    times.clear();
    return parseEchoes(cloud, layout, echoes);
  }
  times.problem.clear();
  times.wild = 0;
  echoes.resize(layout.echoes());
  times.after_stamp.resize(layout.echoes());
  const TimeReader time_of(*layout.time, cloud.header.stamp.toSec(), layout.swap_bytes);
  double first = std::numeric_limits<double>::infinity(), last = -first, strange = 0.0;
  forEachEcho(cloud, layout, [&](std::size_t i, const Eigen::Vector3f& echo, const std::uint8_t* point) {
    const double written = time_of.written(point), within = time_of.within(written);
    const double time = time_of.afterStamp(within);
    echoes[i] = echo;
    times.after_stamp[i] = toFloat(time);
    if (!echo.allFinite()) return;
    times.wild += within == written ? 0U : 1U;
    const bool plausible = std::abs(time) <= kMaxScanDuration;
    if (!plausible) strange = time;
    first = std::min(first, time);
    last = std::max(last, time);
  });
  const bool usable = strange == 0.0 && first <= last;
  if (!usable) {
    times.clear();
    if (strange != 0.0) times.problem = strangeTimes(strange);
    return;
  }
  times.first = first;
  times.last = last;
}

std::vector<double> sampleWrittenTimes(const PointCloud2& cloud, const CloudLayout& layout, std::size_t count) {
  std::vector<double> times;
  const std::size_t echoes = layout.echoes();
  if (!layout.time || echoes == 0 || count == 0) return times;
  const bool swap = layout.swap_bytes;
  const TimeReader reader(*layout.time, 0.0, swap);
  const std::size_t stride = (echoes + count - 1) / count;
  for (std::size_t i = 0; i < echoes; i += stride) {
    const std::uint8_t* point =
        cloud.data.data() + i / layout.width * layout.row_step + i % layout.width * layout.point_step;
    const Eigen::Vector3f position(readCoordinate(point, layout.x, swap), readCoordinate(point, layout.y, swap),
                                   readCoordinate(point, layout.z, swap));
    if (echoOf(position).allFinite()) times.push_back(reader.written(point));
  }
  return times;
}

void parseRings(const PointCloud2& cloud, const CloudLayout& layout, std::vector<std::uint32_t>& rings) {
  rings.resize(layout.echoes());
  forEachPoint(cloud, layout, [&](std::size_t i, const std::uint8_t* point) {
    rings[i] = readRing(point + layout.ring->offset, layout.ring->datatype, layout.swap_bytes);
  });
}

sensor_msgs::PointCloud2Ptr labelCloud(const PointCloud2& cloud, const CloudLayout& layout, const EchoLabels& labels) {
  auto out = emptyLike(cloud, layout.width, layout.height, layout.labeled_point_step);
  addLabelField(*out, "dynamic", layout.dynamic_offset, layout.point_step);
  addLabelField(*out, "observed", layout.observed_offset, layout.point_step);
  const auto write = [to = out->data.data(), step = layout.labeled_point_step, size = layout.point_step,
                      at_dynamic = layout.dynamic_offset, at_observed = layout.observed_offset,
                      dynamic = labels.dynamic.data(),
                      observed = labels.observed.data()](std::size_t i, const std::uint8_t* point) {
    std::uint8_t* labeled = to + i * step;
    copyPoint(labeled, point, size);
    labeled[at_dynamic] = dynamic[i];
    labeled[at_observed] = observed[i];
  };
  forEachPoint(cloud, layout, write);
  return out;
}

sensor_msgs::PointCloud2Ptr selectPart(const PointCloud2& cloud, const CloudLayout& layout, const EchoLabels& labels,
                                       CloudPart part) {
  const std::uint8_t wanted = part == CloudPart::kDynamic ? 1 : 0;
  const auto count = std::count(labels.dynamic.begin(), labels.dynamic.end(), wanted);
  auto out = emptyLike(cloud, static_cast<std::size_t>(count), 1, layout.point_step);
  auto write = [to = out->data.data(), size = layout.point_step, dynamic = labels.dynamic.data(), wanted](
                   std::size_t i, const std::uint8_t* point) mutable {
    if (dynamic[i] != wanted) return;
    copyPoint(to, point, size);
    to += size;
  };
  forEachPoint(cloud, layout, write);
  return out;
}

}  // namespace donex
