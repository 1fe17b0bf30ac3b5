#include "donex/measured_sensor.h"

#include <iomanip>
#include <sstream>

namespace donex {

std::string describe(const MeasuredSensor& sensor) {
  std::ostringstream text;
  text << std::fixed << "beams " << std::setprecision(2) << sensor.beams_apart << " deg apart, from "
       << std::setprecision(1) << sensor.lowest << " to " << sensor.highest << " deg, over " << std::setprecision(0)
       << sensor.around << " deg of azimuth, " << std::setprecision(1) << sensor.turns_per_second << " turns a second";
  if (sensor.second_returns > 0.0)
    text << std::setprecision(0) << ", " << 100.0 * sensor.second_returns << " % second returns";
  return text.str();
}

}  // namespace donex
