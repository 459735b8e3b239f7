// One timed run of crease's whole sequence, in a process of its own so that the peak of its memory
// is its own. Prints seconds by the wall clock and of the processor, and the peak bytes beside the
// input.
//
//   bench_simplify_once INPUT.bin THREADS
//
// Errors are left as estimates, since no peer measures any.
#include "crease/simplify.h"
#include "models.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>

namespace {

// The most and the present resident memory, bytes.
std::size_t from_status(const char* key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word != key) continue;
    std::size_t kilobytes = 0;
    status >> kilobytes;
    return kilobytes * 1024;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace crease;
  exchange::Mesh input;
  if (argc != 3 || !exchange::read_mesh(argv[1], input)) return 2;
  Mesh mesh = bench::from_exchange(input, "scan");
  input = {};
  const Grid grid = make_grid(mesh, {});
  snap(mesh, grid);

  // Peak from here on: writing 5 resets the high-water mark.
  std::ofstream("/proc/self/clear_refs") << "5" << std::flush;
  const std::size_t before = from_status("VmRSS:");
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t processor_start = std::clock();
  const auto sequence = simplify(
      mesh, grid, {.threads = std::atoi(argv[2]), .measures_errors = false, .progress = {}});
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double processor_seconds = double(std::clock() - processor_start) / CLOCKS_PER_SEC;
  if (!sequence.ok()) return 3;
  const std::size_t peak = from_status("VmHWM:");
  std::printf("%.6f %.6f %zu\n", seconds, processor_seconds, peak > before ? peak - before : 0);
  return 0;
}
