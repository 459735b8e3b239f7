// Loops on threads, for run-time code that takes its threads from outside.
//
//   decode_model(file, {.for_each = loop_on_threads(0)});
#pragma once

#include <cstddef>
#include <functional>

namespace crease {

using ParallelLoop =
    std::function<void(std::size_t count, const std::function<void(std::size_t)>& body)>;

// Calls body(i) for every i < count, on `threads` threads; 0: as many as the machine has;
// at most 1024, as everywhere in the library.
ParallelLoop loop_on_threads(int threads);

}  // namespace crease
