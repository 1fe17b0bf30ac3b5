// Where the numbers sit in a PointCloud2, judged once: everything that reads a cloud relies on this verdict.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>

#include <sensor_msgs/PointCloud2.h>

#include "donex/config.h"

namespace donex {

/// Why a cloud cannot be read.
enum class LayoutFault {
  kMissingField,      ///< x, y or z is missing
  kWrongDatatype,     ///< x, y or z is neither FLOAT32 nor FLOAT64, or `dynamic`/`observed` is present and not UINT8
  kZeroPointStep,     ///< echoes without bytes
  kFieldBeyondPoint,  ///< a field that is read or written ends behind its point
  kRowTooShort,       ///< row_step cannot hold width points
  kTruncatedData,     ///< fewer bytes than height x row_step
  kTooLarge,          ///< the labelled cloud would not fit PointCloud2's 32 bit steps
};

struct LayoutError {
  LayoutFault fault;
  std::string text;  ///< what is wrong, with the numbers
};

/// A number within a point.
struct FieldPosition {
  std::uint32_t offset = 0;   ///< [bytes] from the point's start
  std::uint8_t datatype = 0;  ///< sensor_msgs::PointField
};

/// Where an echo's own time is. Without a configured field: FLOAT32 `time` (Velodyne: relative_s), UINT32 `t`
/// (Ouster) and `offset_time` (Livox: relative_ns), FLOAT64 `timestamp` (Hesai, RoboSense: absolute, in seconds;
/// Livox: absolute, in nanoseconds); else the first field whose name looks like a time.
struct TimeField {
  FieldPosition position;
  TimeEncoding encoding = TimeEncoding::kAuto;  ///< kAuto: absolute, the unit told by its magnitude
  bool is_told = false;                         ///< the configuration names the encoding
  std::optional<double> unit;  ///< what one written unit is [s], where it is not the encoding's (TimeUnit)
  std::string name;
  bool is_guess = false;  ///< the name only looks like a time: of use where a unit makes it one (TimeUnit)
  /// As written: what lies beyond is no time of the scan (TimeUnit).
  double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
  /// ... and is taken for the nearer end of what nearly all echoes span: nothing waits for a motion after the scan.
  double first = least, last = most;
};

/// A readable cloud: every offset below lies within the data, for every echo.
struct CloudLayout {
  std::size_t width = 0;       ///< echoes per row
  std::size_t height = 0;      ///< rows; 1 when not organised
  std::size_t point_step = 0;  ///< [bytes]
  std::size_t row_step = 0;    ///< [bytes], at least width * point_step
  bool swap_bytes = false;     ///< the cloud's byte order is not this machine's
  FieldPosition x, y, z;
  std::optional<TimeField> time;
  std::optional<FieldPosition> ring;  ///< `ring` of spinning sensors' drivers, where it is a whole number

  /// Where the output puts its labels: a field of the input that has the name already (its bytes are
  /// overwritten: labels of an earlier classifier), else behind the input's point.
  std::uint32_t dynamic_offset = 0, observed_offset = 0;  ///< [bytes]
  std::size_t labeled_point_step = 0;                     ///< [bytes]

  std::size_t echoes() const { return width * height; }
};

using LayoutVerdict = std::variant<CloudLayout, LayoutError>;

/// Judges the whole layout; allocates no memory in proportion to what the cloud claims. A cloud without
/// echoes is readable when its fields are (point_step and data do not matter then).
LayoutVerdict judgeLayout(const sensor_msgs::PointCloud2& cloud, const CloudConfig& config = {});

/// The names of all fields, for messages: "x y z intensity".
std::string fieldNames(const sensor_msgs::PointCloud2& cloud);

}  // namespace donex
