// Counts allocations of one size: linking this replaces operator new.
#pragma once

#include <cstddef>

namespace donex::test {

/// From now on allocations of exactly `first` and of exactly `second` bytes are counted, from zero.
void countAllocationsOf(std::size_t first, std::size_t second);
int firstAllocations();
int secondAllocations();

}  // namespace donex::test
