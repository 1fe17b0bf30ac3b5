#include "core/grid/workers.h"

#include <algorithm>
#include <atomic>
#include <thread>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace donex {
namespace {

#ifdef __SANITIZE_THREAD__
/// What TBB orders, told to the thread sanitizer, which does not see into it: pieces run after what was before all of
/// them and before what comes after, in no order of their own.
class Order {
 public:
  void begin() { begun_.store(true, std::memory_order_release); }
  template <class Work>
  void piece(const Work& work, std::size_t i) {
    (void)begun_.load(std::memory_order_acquire);
    work(i);
    ended_.fetch_add(1, std::memory_order_release);
  }
  void end() { (void)ended_.load(std::memory_order_acquire); }

 private:
  std::atomic<bool> begun_{false};
  std::atomic<std::size_t> ended_{0};
};
#else
struct Order {
  void begin() {}
  template <class Work>
  void piece(const Work& work, std::size_t i) {
    work(i);
  }
  void end() {}
};
#endif

}  // namespace

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
  Order order;
  order.begin();
  arena_->arena.execute(
      [&] { tbb::parallel_for(std::size_t{0}, pieces, [&](std::size_t i) { order.piece(work, i); }); });
  order.end();
}

}  // namespace donex
