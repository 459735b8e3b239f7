// What drawing takes, of the processor and of the GPU. For programs that are linked with `render`.
#pragma once

#include <functional>
#include <vector>

namespace crease::bench {

// Milliseconds of one drawing. A GPU draws while the processor goes on, so each has its own time; a
// software renderer's is all on the processor.
struct DrawTime {
  double processor_ms = 0;  // all threads together, until the pixels are there
  double gpu_ms = 0;        // by the driver's timer
};

// Draws `times` over and divides. A context must be current; `draw` is what is timed.
DrawTime time_drawing(int times, const std::function<void()>& draw);

// By each kind on its own.
DrawTime median(const std::vector<DrawTime>& rounds);

}  // namespace crease::bench
