#include "ros/sized_allocations.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::size_t> first_size{0}, second_size{0};
std::atomic<int> first_count{0}, second_count{0};

}  // namespace

namespace donex::test {

void countAllocationsOf(std::size_t first, std::size_t second) {
  first_size = first;
  second_size = second;
  first_count = second_count = 0;
}

int firstAllocations() { return first_count; }
int secondAllocations() { return second_count; }

}  // namespace donex::test

void* operator new(std::size_t size) {
  if (size == first_size) ++first_count;
  if (size == second_size) ++second_count;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}

void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
