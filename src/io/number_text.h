// Numbers in messages and tables.
#pragma once

#include <string>

#include <fmt/format.h>

namespace donex {

/// As few digits as tell the number from its neighbours, a whole one without a point: "0.2", "1". Left to fmt it is
/// "1.0" with its release 6 and "1" with 9.
inline std::string numberText(double number) {
  std::string text = fmt::format("{}", number);
  constexpr std::size_t kPoint = 2;  // ".0"
  const bool ends_in_point = text.size() > kPoint && text.compare(text.size() - kPoint, kPoint, ".0") == 0;
  if (ends_in_point) text.resize(text.size() - kPoint);
  return text;
}

}  // namespace donex
