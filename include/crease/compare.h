// How far two meshes are apart: surface distance both ways and normal deviation.
//
//   Result<Comparison> c = compare_meshes(original, simplified, {});
//   c->distance.a_to_b.mean / c->diagonal    relative to the bounding box of a
//   *meshes_within(original, simplified, 0.1, {})    no point of either is further off than that
//
// Samples are drawn uniformly by area on each surface; each looks for the closest point on the
// other through a bounding volume hierarchy (Embree), evaluated in doubles. Normals are
// interpolated from corner normals. Where several triangles lie within a hair of the closest
// distance (on a hard edge), the one whose normal agrees best counts, so that a sample on an edge
// is not punished. So it is with whatever else both meshes carry: colours, texture coordinates,
// numbers, materials, parts.
//
// The largest distance is not that of samples, which miss a window that one triangle covers: it is
// found by branch and bound over the triangles (measure/furthest.h), and holds for all points of
// triangles that have an area: one that is lower than a billionth of the meshes' extent shows
// nothing, and counts only where there is no other.
#pragma once

#include "crease/mesh.h"
#include "crease/progress.h"
#include "crease/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace crease {

struct Spread {
  double mean = 0, rms = 0;  // of the samples
  double max = 0;            // of the whole surface: some point is so far
  double bound = 0;          // and none is further than this
};
// `bound` is `max` and kMaxTolerance of it, and a billionth of the meshes' extent: somewhere within
// lies the distance of the furthest point. It is more only where the search was given up, after 16
// closest points for each triangle of both meshes and a million: where distances are nearly the
// same all over a rough surface.
inline constexpr double kMaxTolerance = 0.01;

enum class DeviationUnit : std::uint8_t {
  Values,   // the length of the difference, in the layer's own units (colours: 0..1)
  Degrees,  // of directions
  Share,    // of what does not blend: the share of both surfaces where it differs, 0..1
};

// Of the samples, both ways together.
struct DeviationSpread {
  double mean = 0, p95 = 0, max = 0;
};

struct AttributeDeviation {
  std::string name;  // a's word for the layer; "material", "part"
  DeviationUnit unit = DeviationUnit::Values;
  DeviationSpread spread;
};

struct Comparison {
  struct {
    Spread a_to_b, b_to_a;
  } distance;                        // model units
  DeviationSpread normal_deviation;  // degrees
  // Layers of a that b has too: by role, the others by name. Materials and parts are told by name.
  std::vector<AttributeDeviation> attributes;
  double diagonal = 0;      // of a's bounding box, model units
  std::size_t samples = 0;  // on each surface
};

struct CompareOptions {
  std::size_t samples = 200'000;  // on each surface, at most a billion
  std::uint32_t seed = 1;
  int threads = 0;                 // 0: all
  ProgressCallback progress = {};  // stage "compare"
};

// Both meshes need triangles and normals. The result does not depend on the number of threads.
// Fails where `progress` asks it to stop, and with BadValue for more samples than that and where
// the two are further apart than 1000 times the larger one's diagonal: one is in other units then,
// or somewhere else. Time O(samples log triangles) and what the largest distance takes, at most 9
// closest points a triangle for the meshes and levels that were measured. A sample from which all
// triangles are about as near, a thousand times the other's size away, looks at all of them. Memory
// about 150 bytes a triangle.
Result<Comparison> compare_meshes(const Mesh& a, const Mesh& b, const CompareOptions& options);

// Whether no point of either mesh is further from the other than `distance` and a billionth of
// their extent. Takes no samples and ends at the first point that is. False, too, where the search
// was given up. A distance that is no number is a BadValue. Else as compare_meshes.
Result<bool> meshes_within(const Mesh& a, const Mesh& b, double distance,
                           const CompareOptions& options);

// How far each point is from the surface, model units. `surface` needs triangles and normals.
// threads: 0 is all.
std::vector<float> distances_to(const Mesh& surface, std::span<const Vec3d> points,
                                int threads = 0);

}  // namespace crease
