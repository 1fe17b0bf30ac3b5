// Shares of counts.
#pragma once

#include <cstdint>
#include <limits>

namespace donex {

/// NaN where the whole is empty.
inline double ratio(std::uint64_t part, std::uint64_t whole) {
  if (whole == 0) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace donex
