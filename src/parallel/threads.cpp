#include "crease/threads.h"

#include "parallel/parallel.h"

namespace crease {

ParallelLoop loop_on_threads(int threads) {
  return [threads](std::size_t count, const std::function<void(std::size_t)>& body) {
    run_on(threads, [&] {
      parallel_for(count, [&](std::size_t i) { body(i); });
      return true;
    });
  };
}

}  // namespace crease
