// Numbers chosen by a condition, without a branch that depends on it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace donex {

constexpr std::size_t kSelectionBlock = 256;  ///< numbers that are chosen from together

/// Chooses the numbers from `first` to `last` (not included) for which `holds(number)`, and shows them to
/// `visit(chosen, count)` block by block, in order. Where the condition changes from echo to echo, to guess it wrongly
/// costs more than what is done with the echo.
template <class Condition, class Visit>
void forEachSelection(std::size_t first, std::size_t last, Condition&& holds, Visit&& visit) {
  std::array<std::uint32_t, kSelectionBlock> chosen;
  for (std::size_t begin = first; begin < last; begin += kSelectionBlock) {
    const std::size_t end = std::min(begin + kSelectionBlock, last);
    std::size_t count = 0;
    for (std::size_t i = begin; i < end; ++i) {
      chosen[count] = static_cast<std::uint32_t>(i);  // written in any case
      count += holds(i) ? 1U : 0U;
    }
    visit(chosen.data(), count);
  }
}

}  // namespace donex
