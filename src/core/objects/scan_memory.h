// Memory for what is of one scan.
#pragma once

#include <cstddef>
#include <memory>
#include <memory_resource>

namespace donex {

/// Gives memory piece by piece and takes it back all at once. It keeps what the largest scan took, so that scans like
/// those before allocate nothing.
class ScanMemory {
 public:
  ScanMemory();
  ~ScanMemory();
  ScanMemory(ScanMemory&&) noexcept;
  ScanMemory& operator=(ScanMemory&&) noexcept;

  /// Valid until release(), wherever this is moved.
  std::pmr::memory_resource* resource() const;

  /// Takes everything back: nothing that lies there may be used any more, nor destroyed later.
  void release();

  std::size_t bytes() const;

 private:
  struct Pool;

  std::unique_ptr<Pool> pool_;
};

}  // namespace donex
