// A loop over points that each look for what is near them, over threads.
//
//   look_for_each(samples, progress, [&] { return progress.stopped(); },
//                 [&](std::size_t i, Surface::Scratch& scratch) { ... nearest(..., scratch) });
#pragma once

#include "measure/surface.h"
#include "parallel/parallel.h"
#include "parallel/shared_progress.h"

#include <algorithm>
#include <cstddef>

namespace crease {

inline constexpr std::size_t kLooksATask = 512;

// So many are looked for at a time; in between a thread asks whether to go on.
inline constexpr std::size_t kLooksAtATime = 64;

// Calls look(i, scratch) for i from 0 to `count`, until the work is over.
template <typename IsOver, typename Look>
void look_for_each(std::size_t count, SharedProgress& progress, IsOver is_over, Look look) {
  parallel_ranges(count, kLooksATask, [&](std::size_t begin, std::size_t end) {
    Surface::Scratch scratch;
    while (begin < end && !is_over()) {
      const std::size_t next = std::min(end, begin + kLooksAtATime);
      for (std::size_t i = begin; i < next; ++i) look(i, scratch);
      progress.advance(next - begin);
      begin = next;
    }
  });
}

}  // namespace crease
