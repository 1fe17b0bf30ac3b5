// Storage that is as long as a scan.
#pragma once

#include <cstddef>
#include <vector>

namespace donex {

/// Resizes, and where it must grow takes an eighth more: the next scans differ a little, and the usual doubling for
/// that would waste half of it.
template <class Value>
void resizeTo(std::vector<Value>& values, std::size_t count) {
  if (count > values.capacity()) values.reserve(count + count / 8);
  values.resize(count);
}

/// What so many bytes of it come to [bytes].
inline double roomFor(double bytes) { return 1.125 * bytes; }

}  // namespace donex
