// The clouds of the common LiDARs' ROS 1 drivers, field by field as the drivers lay them out.
#pragma once

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "ros/cloud_builder.h"

namespace donex::test {

// The scan that a driver publishes, and the vehicle meanwhile.
constexpr double kStart = 1700000000.25;  ///< [s]
constexpr double kTurn = 0.1;             ///< [s]
constexpr double kSpeed = 15.0;           ///< [m/s]

struct DriverField {
  const char* name;
  std::uint8_t datatype;
  std::uint32_t offset;
};

/// When the driver stamps its cloud.
enum class StampedAt { kFirstEcho, kLastEcho };

struct DriverCloud {
  const char* driver;
  std::vector<DriverField> fields;
  std::uint32_t point_step;
  std::uint32_t rows;  ///< 1: not organised
  StampedAt stamped_at;
  const char* time_field;
  double units_per_second;  ///< of the time field
  bool absolute;            ///< the time field counts from 1970
  double no_return;         ///< x, y and z where nothing came back
};

inline const double kNotANumber = std::numeric_limits<double>::quiet_NaN();

/// All drivers begin with x, y, z as FLOAT32.
inline std::vector<DriverField> positionAnd(const std::vector<DriverField>& others) {
  std::vector<DriverField> fields{
      {"x", PointField::FLOAT32, 0}, {"y", PointField::FLOAT32, 4}, {"z", PointField::FLOAT32, 8}};
  fields.insert(fields.end(), others.begin(), others.end());
  return fields;
}

inline std::vector<DriverField> velodyneFields() {
  using P = PointField;
  return positionAnd({{"intensity", P::FLOAT32, 12}, {"ring", P::UINT16, 16}, {"time", P::FLOAT32, 18}});
}

/// PCL's alignment.
inline std::vector<DriverField> ousterFields(std::uint8_t ring) {
  using P = PointField;
  return positionAnd({{"intensity", P::FLOAT32, 16},
                      {"t", P::UINT32, 20},
                      {"reflectivity", P::UINT16, 24},
                      {"ring", ring, 26},
                      {"ambient", P::UINT16, 28},
                      {"range", P::UINT32, 32}});
}

/// PCL's alignment.
inline std::vector<DriverField> hesaiGeneralFields() {
  using P = PointField;
  return positionAnd({{"intensity", P::FLOAT32, 16}, {"timestamp", P::FLOAT64, 24}, {"ring", P::UINT16, 32}});
}

/// XYZIRT without a gap, as Hesai's newer driver and RoboSense's have it.
inline std::vector<DriverField> packedFields() {
  using P = PointField;
  return positionAnd({{"intensity", P::FLOAT32, 12}, {"ring", P::UINT16, 16}, {"timestamp", P::FLOAT64, 18}});
}

inline std::vector<DriverField> livoxFields() {
  using P = PointField;
  return positionAnd(
      {{"intensity", P::FLOAT32, 12}, {"tag", P::UINT8, 16}, {"line", P::UINT8, 17}, {"timestamp", P::FLOAT64, 18}});
}

inline std::vector<DriverField> livoxCustomFields() {
  using P = PointField;
  return positionAnd(
      {{"intensity", P::FLOAT32, 12}, {"tag", P::UINT8, 16}, {"line", P::UINT8, 17}, {"offset_time", P::UINT32, 20}});
}

inline const std::vector<DriverCloud>& driverClouds() {
  constexpr StampedAt kFirst = StampedAt::kFirstEcho, kLast = StampedAt::kLastEcho;
  static const std::vector<DriverCloud> clouds{
      // velodyne_pointcloud 1.6 and later, organize_cloud false and true; stamped with the last packet.
      {"velodyne", velodyneFields(), 22, 1, kLast, "time", 1.0, false, kNotANumber},
      {"velodyne organised", velodyneFields(), 22, 16, kLast, "time", 1.0, false, kNotANumber},
      // ouster_ros: ring as UINT8 (until 2022) and as UINT16.
      {"ouster ring 8", ousterFields(PointField::UINT8), 48, 16, kFirst, "t", 1e9, false, 0.0},
      {"ouster", ousterFields(PointField::UINT16), 48, 16, kFirst, "t", 1e9, false, 0.0},
      // HesaiLidar_General_ROS and HesaiLidar_ROS_2.0.
      {"hesai general", hesaiGeneralFields(), 48, 1, kFirst, "timestamp", 1.0, true, kNotANumber},
      {"hesai 2.0", packedFields(), 26, 1, kFirst, "timestamp", 1.0, true, kNotANumber},
      // rslidar_sdk, POINT_TYPE XYZIRT: columns and rows exchanged, NaN kept unless dense_points.
      {"robosense", packedFields(), 26, 40, kLast, "timestamp", 1.0, true, kNotANumber},
      // livox_ros_driver2, xfer_format 0: times in nanoseconds as a double.
      {"livox", livoxFields(), 26, 1, kFirst, "timestamp", 1e9, true, 0.0},
      // livox_ros_driver and livox_ros_driver2, CustomMsg, as livoxCloud makes a cloud of it.
      {"livox custom", livoxCustomFields(), 24, 1, kFirst, "offset_time", 1e9, false, 0.0}};
  return clouds;
}

inline const DriverCloud& driverNamed(const std::string& name) {
  for (const DriverCloud& cloud : driverClouds()) {
    if (cloud.driver == name) return cloud;
  }
  throw std::invalid_argument(name);
}

/// The driver's layout with `echoes` points (a multiple of its rows), every byte a pattern.
inline CloudBuilder builderOf(const DriverCloud& driver, std::uint32_t echoes, double stamp) {
  CloudBuilder builder;
  builder.stamp(stamp);
  for (const DriverField& field : driver.fields) builder.fieldAt(field.name, field.datatype, field.offset);
  builder.pointStep(driver.point_step).size(echoes / driver.rows, driver.rows);
  return builder;
}

}  // namespace donex::test
