#include "support/counted_allocations.h"

#include <atomic>
#include <cstdlib>
#include <new>

#include <malloc.h>

namespace {

std::atomic<std::size_t> count{0}, bytes{0}, largest{0};

}  // namespace

namespace donex::testing {

std::size_t allocations() { return count; }
std::size_t liveBytes() { return bytes; }
std::size_t takeLargest() { return largest.exchange(0); }

}  // namespace donex::testing

void* operator new(std::size_t size) {
  std::size_t before = largest;
  while (before < size && !largest.compare_exchange_weak(before, size)) {
  }
  void* memory = std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  ++count;
  bytes += malloc_usable_size(memory);
  return memory;
}
// As std::stable_sort asks for its buffer; a sanitizer has one of its own, which does not call the above.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  try {
    return operator new(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

void operator delete(void* memory) noexcept {
  bytes -= malloc_usable_size(memory);
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }
