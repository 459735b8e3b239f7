// A level of the progressive mesh beside the same level by the plain definition.
#pragma once

#include "assemble/arrange.h"
#include "crease/mesh.h"
#include "crease/progressive_mesh.h"
#include "hierarchy/attribute_values.h"
#include "support/mesh_zoo.h"
#include "support/random_contractions.h"

#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace crease {

struct Case {
  Mesh mesh;  // snapped
  ContractionSequence sequence;
  Arrangement arrangement;
  ProgressiveArraysPtr arrays;
};

inline Case make_case(Mesh mesh, RandomContractionOptions options) {
  Case c;
  c.mesh = std::move(mesh);
  const Grid grid = make_grid(c.mesh, {.bits = 12});
  snap(c.mesh, grid);
  c.sequence = random_contractions(c.mesh, grid, options);
  c.arrays = std::make_shared<const ProgressiveArrays>(
      arrange(c.mesh, c.sequence, restructure(c.mesh, c.sequence), &c.arrangement));
  return c;
}

// Where triangle `t` of the input stands among the triangles of an extracted level; or kNone.
inline std::uint32_t extracted_triangle(const Case& c, const DrawList& list, std::size_t t) {
  const SectionCounts& full = c.arrays->full;
  const auto sn = static_cast<std::uint32_t>(list.sn.triangle_count());
  const auto fn = static_cast<std::uint32_t>(list.fn.triangle_count());
  const auto nsn = static_cast<std::uint32_t>(list.nsn.triangle_count());
  std::uint32_t i = c.arrangement.new_of_triangle[t];
  if (i < full.sn_triangles) return i < sn ? i : kNone;
  i -= full.sn_triangles;
  if (i < full.fn_triangles) return i < fn ? sn + i : kNone;
  i -= full.fn_triangles;
  return i < nsn ? sn + fn + i : kNone;
}

// One to one, as far as it was asked.
class Bijection {
 public:
  bool match(std::uint64_t a, std::uint64_t b) {
    return there_.try_emplace(a, b).first->second == b &&
           back_.try_emplace(b, a).first->second == a;
  }

 private:
  std::map<std::uint64_t, std::uint64_t> there_, back_;
};

// Empty if `pm` shows exactly `level`; else the first difference. Corners of a vertex must share
// the same attributes in both; ids of different vertices may coincide in one and not in the other.
inline std::string difference(const Case& c, const ProgressiveMesh& pm, const Level& level) {
  const Mesh expected = mesh_of_level(c.mesh, c.sequence, level);
  const Mesh got = pm.extract();
  if (Status status = check_mesh(got); !status.ok()) return status.failure().message;
  if (got.triangle_count() != expected.triangle_count()) return "triangle count";
  if (got.triangle_count() != pm.triangle_count()) return "triangle count of the level";
  if (got.vertex_count() != expected.vertex_count()) return "vertex count";
  if (got.layers.size() != expected.layers.size()) return "layer count";
  if (got.materials != expected.materials || got.parts != expected.parts) return "names";

  const DrawList list = pm.draw_list();
  Bijection vertices;
  std::vector<Bijection> wedges(expected.layers.size());
  std::size_t e = 0;
  for (std::size_t t = 0; t < c.mesh.triangle_count(); ++t) {
    const std::uint32_t g = extracted_triangle(c, list, t);
    if (level.alive[t] != (g != kNone)) return "triangle " + std::to_string(t) + " alive or not";
    if (!level.alive[t]) continue;
    const std::string at = " of triangle " + std::to_string(t);
    if (!expected.material_of_triangle.empty() &&
        got.material_of_triangle.at(g) != expected.material_of_triangle[e]) {
      return "material" + at;
    }
    if (!expected.part_of_triangle.empty() &&
        got.part_of_triangle.at(g) != expected.part_of_triangle[e]) {
      return "part" + at;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t ev = index_of(expected.triangles[e][k]);
      const std::size_t gv = index_of(got.triangles[g][k]);
      if (!vertices.match(ev, gv)) return "vertex" + at;
      if (!(expected.positions[ev] == got.positions[gv])) return "position" + at;
      for (std::size_t l = 0; l < expected.layers.size(); ++l) {
        const AttributeLayer& el = expected.layers[l];
        const AttributeLayer& gl = got.layers[l];
        if (el.name != gl.name || el.role != gl.role || el.dimension != gl.dimension ||
            el.interpolation != gl.interpolation) {
          return "schema of layer " + el.name;
        }
        const AttributeId ei = el.of_corner[3 * e + k], gi = gl.of_corner[3 * g + k];
        const auto ex = el.value(ei), gx = gl.value(gi);
        if (std::memcmp(ex.data(), gx.data(), ex.size_bytes()) != 0) return el.name + at;
        if (!wedges[l].match(std::uint64_t(ev) << 32 | index_of(ei),
                             std::uint64_t(ev) << 32 | index_of(gi))) {
          return "sharing of " + el.name + at;
        }
      }
    }
    ++e;
  }
  return {};
}

}  // namespace crease
