// What all peers' programs have in common:
//
//   peer_vtk IN OUT TRIANGLES
//
// reads IN, simplifies to TRIANGLES, writes OUT and prints the seconds of the library's call alone,
// by the wall clock and of the processor.
#pragma once

#include "peers/exchange.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>

// `simplify` gets the mesh and the target, and calls `timed` with what is to be timed.
using Timed = std::function<void(const std::function<void()>&)>;

template <typename Simplify>
int peer_main(int argc, char** argv, const Simplify& simplify) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: %s IN OUT TRIANGLES\n", argv[0]);
    return 1;
  }
  exchange::Mesh in;
  if (!exchange::read_mesh(argv[1], in)) {
    std::fprintf(stderr, "%s: cannot be read\n", argv[1]);
    return 2;
  }
  double seconds = 0, processor_seconds = 0;
  const Timed timed = [&](const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t processor_start = std::clock();
    work();
    processor_seconds = double(std::clock() - processor_start) / CLOCKS_PER_SEC;
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const exchange::Mesh out = simplify(in, std::strtoull(argv[3], nullptr, 10), timed);
  if (!exchange::write_mesh(argv[2], out)) {
    std::fprintf(stderr, "%s: cannot be written\n", argv[2]);
    return 4;
  }
  std::printf("%.6f %.6f\n", seconds, processor_seconds);
  return 0;
}
