#include "core/objects/scan_memory.h"

#include <vector>

namespace donex {
namespace {

/// Where the pool gets more from, counted.
class Overflow : public std::pmr::memory_resource {
 public:
  std::size_t bytes = 0;

 private:
  void* do_allocate(std::size_t size, std::size_t alignment) override {
    bytes += size;
    return std::pmr::new_delete_resource()->allocate(size, alignment);
  }
  void do_deallocate(void* memory, std::size_t size, std::size_t alignment) override {
    std::pmr::new_delete_resource()->deallocate(memory, size, alignment);
  }
  bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override { return this == &other; }
};

constexpr std::size_t kFirst = std::size_t{1} << 16;  // [bytes]

}  // namespace

struct ScanMemory::Pool {
  explicit Pool(std::size_t size) : kept(size) {}

  Overflow overflow;
  std::vector<std::byte> kept;
  std::pmr::monotonic_buffer_resource resource{kept.data(), kept.size(), &overflow};
};

ScanMemory::ScanMemory() : pool_(std::make_unique<Pool>(kFirst)) {}
ScanMemory::~ScanMemory() = default;
ScanMemory::ScanMemory(ScanMemory&&) noexcept = default;
ScanMemory& ScanMemory::operator=(ScanMemory&&) noexcept = default;

std::pmr::memory_resource* ScanMemory::resource() const { return &pool_->resource; }

void ScanMemory::release() {
  const std::size_t taken = bytes();
  if (pool_->overflow.bytes == 0) {
    pool_->resource.release();
  } else {
    pool_ = std::make_unique<Pool>(taken);
  }
}

std::size_t ScanMemory::bytes() const { return pool_->kept.size() + pool_->overflow.bytes; }

}  // namespace donex
