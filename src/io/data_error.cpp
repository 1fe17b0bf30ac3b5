#include "io/data_error.h"

#include <algorithm>

namespace donex {

std::string Faults::text() const {
  constexpr std::size_t kMostTold = 20;
  const std::size_t told = std::min(faults_.size(), kMostTold);
  std::string text;
  for (std::size_t i = 0; i < told; ++i) text += (i == 0 ? "" : "\n") + faults_[i];
  if (told < faults_.size()) text += "\n... and " + std::to_string(faults_.size() - told) + " more";
  return text;
}

void Faults::throwIfAny() const {
  if (!empty()) throw DataError(text());
}

}  // namespace donex
