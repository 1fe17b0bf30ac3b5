// The threads that a detector may use.
#pragma once

#include <algorithm>
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

  /// Of one thread: what it is given to runs in its caller.
  static const Workers& alone();

  int threads() const { return threads_; }

  /// work(0) to work(pieces - 1), in any order, at the same time.
  void each(std::size_t pieces, const std::function<void(std::size_t)>& work) const;

  /// Two independent steps at the same time; on one thread one after the other. The longer one comes first.
  template <class First, class Second>
  void both(First&& first, Second&& second) const {
    const auto work = [&](std::size_t i) { i == 0 ? first() : second(); };
    each(2, std::ref(work));  // by reference: a copy of it would be allocated
  }

 private:
  struct Arena;

  int threads_;
  std::unique_ptr<Arena> arena_;
};

/// Handing a stretch over takes about a microsecond, working on so many echoes tens; several blocks of echoes.
constexpr std::size_t kStretch = 8192;

/// Shows `work(first, last)` stretches that together are entries 0 to `count` - 1 (`last` is not of its stretch). They
/// are the same on any number of threads, and begin at multiples of `length`.
template <class Work>
void forEachStretch(const Workers& workers, std::size_t count, Work&& work, std::size_t length = kStretch) {
  const auto some = [&](std::size_t i) { work(i * length, std::min(count, (i + 1) * length)); };
  workers.each((count + length - 1) / length, std::ref(some));
}

}  // namespace donex
