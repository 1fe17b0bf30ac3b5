#include "core/grid/workers.h"

#include <algorithm>
#include <thread>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace donex {

struct Workers::Arena {
  /// More threads than cores do not help.
  explicit Arena(int threads)
      : arena(std::min(threads, static_cast<int>(std::max(std::thread::hardware_concurrency(), 1U)))) {}
  tbb::task_arena arena;
};

Workers::Workers(int threads) : threads_(threads), arena_(threads > 1 ? std::make_unique<Arena>(threads) : nullptr) {}

Workers::~Workers() = default;

const Workers& Workers::alone() {
  static const Workers workers(1);
  return workers;
}

void Workers::each(std::size_t pieces, const std::function<void(std::size_t)>& work) const {
  if (arena_ == nullptr) {
    for (std::size_t i = 0; i < pieces; ++i) work(i);
    return;
  }
  arena_->arena.execute([&] { tbb::parallel_for(std::size_t{0}, pieces, work); });
}

}  // namespace donex
