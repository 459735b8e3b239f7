// Procedural models for demos, tests and benchmarks: seeded, the same bytes everywhere.
//
//   Mesh city = generate_city({.triangles = 1'000'000});
#pragma once

#include "crease/mesh.h"

#include <cstdint>

namespace crease {

// A city in the spirit of DB03 section 4: detached buildings with flat walls, gable and hip roofs,
// cylindrical towers and arches with smooth shading, domes, balconies; more than four thousand of
// them in a million triangles, on blocks between streets, squares and a river. Metres, z up.
// Materials: walls, roofs, stone, metal, glass and more by name. Every building is a part of its
// own, as are the trees of a garden, a block's pavement and the ground. All bodies are closed.
struct CityOptions {
  std::uint32_t seed = 1;
  // About: buildings are added until it is reached. More than kMost are taken for so many.
  static constexpr std::size_t kMost = 150'000'000;
  std::size_t triangles = 1'000'000;
};
Mesh generate_city(const CityOptions& options);

}  // namespace crease
