#include "support/counted_allocations.h"

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::size_t> count{0}, bytes{0};

}  // namespace

namespace donex::testing {

std::size_t allocations() { return count; }
std::size_t liveBytes() { return bytes; }

}  // namespace donex::testing

void* operator new(std::size_t size) {
  void* memory = std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  ++count;
  bytes += malloc_usable_size(memory);
  return memory;
}

void operator delete(void* memory) noexcept {
  bytes -= malloc_usable_size(memory);
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }
