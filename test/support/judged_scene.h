// Objects made of judged echoes, before a sensor that may move.
#pragma once

#include <vector>

#include "core/evidence/judged_scan.h"
#include "core/sight/sight_history.h"
#include "donex/scan.h"

namespace donex::testing {

/// Points frame is the odometry frame, z is the height above ground.
class JudgedScene {
 public:
  explicit JudgedScene(double stamp, double sensor_x = 0.0) {
    judged.stamp = stamp;
    judged.sensor = Eigen::Vector3d(sensor_x, 0.0, 1.8).cast<float>();
  }

  /// A face of a box, seen as a grid of echoes `step` [m] apart: spans `along` and `height` from `corner`.
  JudgedScene& face(const Eigen::Vector3d& corner, const Eigen::Vector3d& along, double height, Place place,
                    double step = 0.1) {
    const int columns = static_cast<int>(along.norm() / step + 0.5), rows = static_cast<int>(height / step + 0.5);
    for (int c = 0; c <= columns; ++c) {
      for (int r = 0; r <= rows; ++r) {
        echo(corner + along * (static_cast<double>(c) / columns) + Eigen::Vector3d(0.0, 0.0, step * r), place);
      }
    }
    return *this;
  }

  JudgedScene& echo(const Eigen::Vector3d& point, Place place) {
    judged.points.push_back(point.cast<float>());
    judged.is_echo.push_back(1);
    judged.heights.push_back(static_cast<float>(point.z()));
    judged.roles.push_back(ClusterRole::kConnects);
    judged.places.push_back(place);
    return *this;
  }

  /// The same echoes as the sensor measured them.
  Scan scan() const {
    Scan scan;
    scan.stamp = judged.stamp;
    scan.odom_from_base.translation() = judged.sensor.cast<double>();
    for (const Eigen::Vector3f& point : judged.points) scan.echoes.push_back(point - judged.sensor);
    return scan;
  }

  JudgedScan judged;
};

}  // namespace donex::testing
