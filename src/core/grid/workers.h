// The threads that a detector may use.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace donex {

/// Runs independent pieces of work on up to `threads` threads (TBB); on one, everything runs in the caller, in order,
/// and nothing is allocated.
class Workers {
 public:
  explicit Workers(int threads);
  ~Workers();

  int threads() const { return threads_; }

  /// work(0) to work(pieces - 1), in any order, at the same time.
  void each(std::size_t pieces, const std::function<void(std::size_t)>& work) const;

 private:
  struct Arena;

  int threads_;
  std::unique_ptr<Arena> arena_;
};

}  // namespace donex
