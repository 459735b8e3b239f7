// How far two meshes are apart: surface distance both ways and normal deviation.
//
//   Result<Comparison> c = compare_meshes(original, simplified, {});
//   c->distance.a_to_b.mean / c->diagonal    relative to the bounding box of a
//
// Samples are drawn uniformly by area on each surface; each looks for the closest point on the
// other through a bounding volume hierarchy (Embree), evaluated in doubles. Normals are
// interpolated from corner normals. Where several triangles lie within a hair of the closest
// distance (on a hard edge), the one whose normal agrees best counts, so that a sample on an edge
// is not punished.
#pragma once

#include "crease/mesh.h"
#include "crease/progress.h"
#include "crease/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace crease {

struct Spread {
  double mean = 0, rms = 0, max = 0;
};

struct Comparison {
  struct {
    Spread a_to_b, b_to_a;
  } distance;  // model units
  struct {
    double mean = 0, p95 = 0, max = 0;  // both ways together
  } normal_deviation;                   // degrees
  double diagonal = 0;                  // of a's bounding box, model units
  std::size_t samples = 0;              // on each surface
};

struct CompareOptions {
  std::size_t samples = 200'000;  // on each surface; all vertices count for distance max besides
  std::uint32_t seed = 1;
  int threads = 0;                 // 0: all
  ProgressCallback progress = {};  // stage "compare"
};

// Both meshes need triangles and normals. The result does not depend on the number of threads.
// Fails only where `progress` asks it to stop. Time O(samples log triangles), memory about 150
// bytes a triangle.
Result<Comparison> compare_meshes(const Mesh& a, const Mesh& b, const CompareOptions& options);

// How far each point is from the surface, model units. `surface` needs triangles and normals.
// threads: 0 is all.
std::vector<float> distances_to(const Mesh& surface, std::span<const Vec3d> points,
                                int threads = 0);

}  // namespace crease
