// Procedural models for demos, tests and benchmarks: seeded, the same bytes everywhere.
//
//   Mesh city = generate_city({.triangles = 1'000'000});
#pragma once

#include "crease/mesh.h"

#include <cstdint>

namespace crease {

// A city in the spirit of DB03 section 4: detached buildings with flat walls, gable and hip roofs,
// cylindrical towers and arches with smooth shading, domes, balconies. Metres, z up. Materials:
// wall, roof, stone, metal, glass. Every building is a part.
struct CityOptions {
  std::uint32_t seed = 1;
  std::size_t triangles = 1'000'000;  // about: buildings are added until it is reached
};
Mesh generate_city(const CityOptions& options);

}  // namespace crease
