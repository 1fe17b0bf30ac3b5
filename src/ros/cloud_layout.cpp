#include "ros/cloud_layout.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <sstream>

#include <boost/endian/conversion.hpp>

namespace donex {
namespace {

using sensor_msgs::PointCloud2;
using sensor_msgs::PointField;

const PointField* findField(const PointCloud2& cloud, const std::string& name) {
  const auto field = std::find_if(cloud.fields.begin(), cloud.fields.end(),
                                  [&](const PointField& candidate) { return candidate.name == name; });
  return field == cloud.fields.end() ? nullptr : &*field;
}

std::size_t sizeOf(std::uint8_t datatype) {
  switch (datatype) {
    case PointField::INT8:
    case PointField::UINT8: return 1;
    case PointField::INT16:
    case PointField::UINT16: return 2;
    case PointField::FLOAT64: return 8;
    default: return 4;
  }
}

template <class... Parts>
LayoutError fault(LayoutFault kind, const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return {kind, text.str()};
}

using MaybeError = std::optional<LayoutError>;

bool fits(const PointField& field, std::size_t point_step) {
  return std::uint64_t{field.offset} + sizeOf(field.datatype) <= point_step;
}

MaybeError beyondPoint(const PointField& field, std::size_t point_step) {
  if (fits(field, point_step)) return std::nullopt;
  return fault(LayoutFault::kFieldBeyondPoint, "field '", field.name, "' of ", sizeOf(field.datatype),
               " bytes at offset ", field.offset, " ends behind the point of ", point_step, " bytes");
}

MaybeError judgeCoordinate(const PointCloud2& cloud, const char* name, FieldPosition& position) {
  const PointField* field = findField(cloud, name);
  if (field == nullptr) return fault(LayoutFault::kMissingField, "the cloud has no field '", name, "'");
  const bool is_float = field->datatype == PointField::FLOAT32 || field->datatype == PointField::FLOAT64;
  if (!is_float) {
    return fault(LayoutFault::kWrongDatatype, "field '", name, "' has datatype ", int{field->datatype},
                 ", must be FLOAT32 (7) or FLOAT64 (8)");
  }
  position = {field->offset, field->datatype};
  const bool has_echoes = cloud.width != 0 && cloud.height != 0;
  return has_echoes ? beyondPoint(*field, cloud.point_step) : std::nullopt;
}

MaybeError judgeExtent(const PointCloud2& cloud) {
  const bool has_echoes = cloud.width != 0 && cloud.height != 0;
  if (!has_echoes) return std::nullopt;
  if (cloud.point_step == 0) {
    return fault(LayoutFault::kZeroPointStep, "point_step is 0 in a cloud of ", cloud.width, " x ", cloud.height);
  }
  // 32 bit times 32 bit fits 64 bit: no overflow here.
  const std::uint64_t row = std::uint64_t{cloud.width} * cloud.point_step;
  if (cloud.row_step < row) {
    return fault(LayoutFault::kRowTooShort, "row_step is ", cloud.row_step, ", but a row of ", cloud.width,
                 " points of ", cloud.point_step, " bytes takes ", row);
  }
  const std::uint64_t needed = std::uint64_t{cloud.row_step} * cloud.height;
  if (cloud.data.size() < needed) {
    return fault(LayoutFault::kTruncatedData, "the cloud holds ", cloud.data.size(), " bytes, but ", cloud.height,
                 " rows of ", cloud.row_step, " bytes take ", needed);
  }
  return std::nullopt;
}

struct KnownTime {
  const char* name;
  std::uint8_t datatype;
  TimeEncoding encoding;
};

constexpr std::array<KnownTime, 4> kKnownTimes{{
    {"time", PointField::FLOAT32, TimeEncoding::kRelativeSeconds},
    {"t", PointField::UINT32, TimeEncoding::kRelativeNanoseconds},
    {"offset_time", PointField::UINT32, TimeEncoding::kRelativeNanoseconds},
    {"timestamp", PointField::FLOAT64, TimeEncoding::kAuto},
}};

/// The encoding that the known drivers use with a datatype.
std::optional<TimeEncoding> usualEncoding(std::uint8_t datatype) {
  switch (datatype) {
    case PointField::FLOAT32: return TimeEncoding::kRelativeSeconds;
    case PointField::INT32:
    case PointField::UINT32: return TimeEncoding::kRelativeNanoseconds;
    case PointField::FLOAT64: return TimeEncoding::kAuto;
    default: return std::nullopt;
  }
}

std::optional<TimeField> configuredTime(const PointCloud2& cloud, const CloudConfig& config) {
  const PointField* field = findField(cloud, config.time_field);
  if (field == nullptr || !fits(*field, cloud.point_step)) return std::nullopt;
  const auto usual = usualEncoding(field->datatype);
  if (!usual) return std::nullopt;
  const bool is_told = config.time_encoding != TimeEncoding::kAuto;
  return TimeField{{field->offset, field->datatype}, is_told ? config.time_encoding : *usual, is_told, {}, field->name};
}

bool looksLikeTime(std::string name) {
  for (char& letter : name) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  const auto holds = [&](const char* word) { return name.find(word) != std::string::npos; };
  return name == "t" || name == "ts" || name == "dt" || holds("time") || holds("stamp") || holds("offset_ns");
}

/// Of a driver that nobody knows.
std::optional<TimeField> guessedTime(const PointCloud2& cloud) {
  for (const PointField& field : cloud.fields) {
    const auto usual = usualEncoding(field.datatype);
    const bool usable = usual && looksLikeTime(field.name) && fits(field, cloud.point_step);
    if (usable) return TimeField{{field.offset, field.datatype}, *usual, false, {}, field.name, true};
  }
  return std::nullopt;
}

std::optional<TimeField> findTime(const PointCloud2& cloud, const CloudConfig& config) {
  if (!config.time_field.empty()) return configuredTime(cloud, config);
  for (const KnownTime& known : kKnownTimes) {
    const PointField* field = findField(cloud, known.name);
    const bool usable = field != nullptr && field->datatype == known.datatype && fits(*field, cloud.point_step);
    if (usable) return TimeField{{field->offset, field->datatype}, known.encoding, false, {}, field->name};
  }
  return guessedTime(cloud);
}

std::optional<FieldPosition> findRing(const PointCloud2& cloud) {
  const PointField* field = findField(cloud, "ring");
  const bool usable = field != nullptr && field->datatype <= PointField::UINT32 && fits(*field, cloud.point_step);
  return usable ? std::optional(FieldPosition{field->offset, field->datatype}) : std::nullopt;
}

/// Multiple of `alignment` from `size` upwards.
std::size_t roundUp(std::size_t size, std::size_t alignment) { return (size + alignment - 1) / alignment * alignment; }

MaybeError placeLabel(const PointCloud2& cloud, const char* name, std::uint32_t& offset, std::size_t& end) {
  const PointField* field = findField(cloud, name);
  if (field == nullptr) {
    offset = static_cast<std::uint32_t>(end++);
    return std::nullopt;
  }
  if (field->datatype != PointField::UINT8 || field->count > 1) {
    return fault(LayoutFault::kWrongDatatype, "the cloud has a field '", name, "' already, of datatype ",
                 int{field->datatype}, " and count ", field->count, ": a label must be one UINT8 (2)");
  }
  offset = field->offset;
  return beyondPoint(*field, cloud.point_step);
}

MaybeError placeLabels(const PointCloud2& cloud, CloudLayout& layout) {
  std::size_t end = layout.point_step;
  if (auto error = placeLabel(cloud, "dynamic", layout.dynamic_offset, end)) return error;
  if (auto error = placeLabel(cloud, "observed", layout.observed_offset, end)) return error;
  // A reader may take floats in place: points that were aligned stay aligned.
  const bool has_doubles = std::any_of(cloud.fields.begin(), cloud.fields.end(),
                                       [](const PointField& field) { return sizeOf(field.datatype) == 8; });
  const std::size_t alignment = has_doubles ? 8 : 4;
  layout.labeled_point_step = layout.point_step % alignment == 0 ? roundUp(end, alignment) : end;
  const std::uint64_t row = std::uint64_t{layout.labeled_point_step} * std::max<std::size_t>(layout.width, 1);
  if (row <= std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  return fault(LayoutFault::kTooLarge, "a labelled row of ", layout.width, " points of ", layout.labeled_point_step,
               " bytes does not fit row_step");
}

}  // namespace

std::string fieldNames(const PointCloud2& cloud) {
  std::string names;
  for (const PointField& field : cloud.fields) names += (names.empty() ? "" : " ") + field.name;
  return names;
}

LayoutVerdict judgeLayout(const PointCloud2& cloud, const CloudConfig& config) {
  CloudLayout layout;
  layout.width = cloud.width;
  layout.height = cloud.height;
  layout.point_step = cloud.point_step;
  layout.row_step = cloud.row_step;
  const bool machine_is_big = boost::endian::order::native == boost::endian::order::big;
  layout.swap_bytes = (cloud.is_bigendian != 0) != machine_is_big;

  if (auto error = judgeExtent(cloud)) return *error;
  if (auto error = judgeCoordinate(cloud, "x", layout.x)) return *error;
  if (auto error = judgeCoordinate(cloud, "y", layout.y)) return *error;
  if (auto error = judgeCoordinate(cloud, "z", layout.z)) return *error;
  layout.time = findTime(cloud, config);
  layout.ring = findRing(cloud);
  if (auto error = placeLabels(cloud, layout)) return *error;
  return layout;
}

}  // namespace donex
