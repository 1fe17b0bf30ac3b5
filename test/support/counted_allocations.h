// Counts what is allocated: linking the source beside this replaces operator new.
#pragma once

#include <cstddef>

namespace donex::testing {

std::size_t allocations();  ///< so far
std::size_t liveBytes();    ///< allocated and not given back, as the allocator rounds them
std::size_t takeLargest();  ///< the most bytes asked for at once since the last call

}  // namespace donex::testing
