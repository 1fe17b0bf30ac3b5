#include "simulation/sensor_model.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "core/pi.h"

namespace donex::simulation {
namespace {

/// `count` beams from `lowest` upwards, evenly [deg].
void append(SensorModel& model, double lowest, double spacing, int count) {
  for (int i = 0; i < count; ++i) {
    model.slopes.push_back(static_cast<float>(std::tan((lowest + spacing * i) * kPi / 180.0)));
  }
}

void setColumns(SensorModel& model, int columns) {
  for (int column = 0; column < columns; ++column) {
    const double azimuth = kPi - 2.0 * kPi * (column + 0.5) / columns;
    model.headings.emplace_back(std::cos(azimuth), std::sin(azimuth));
  }
}

}  // namespace

SensorModel makeSensorModel(int beams) {
  SensorModel model;
  switch (beams) {
    case 16:
      append(model, -15.0, 2.0, 16);
      setColumns(model, 1800);
      model.min_range = 0.4f;
      return model;
    case 32:
      append(model, -30.67, 4.0 / 3.0, 32);
      setColumns(model, 2160);
      return model;
    case 64:
      append(model, -24.33, 0.5, 32);
      append(model, -8.33, 1.0 / 3.0, 32);
      setColumns(model, 2400);
      return model;
    case 128:
      append(model, -25.0, 1.0, 19);
      append(model, -6.0, 0.125, 64);
      append(model, 2.0, 0.25, 24);
      append(model, 8.0, 0.4, 21);
      setColumns(model, 1800);
      return model;
    default: throw std::invalid_argument("beams: 16, 32, 64 or 128, not " + std::to_string(beams));
  }
}

}  // namespace donex::simulation
