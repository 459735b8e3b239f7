// The contraction sequence: what simplification makes and everything else is made from.
//
// A contraction (p, q) -> v_s replaces p by q everywhere; q's slot stands for v_s afterwards and
// moves to a new position. Applied in order to the snapped mesh (apply_contractions() is the plain
// definition, and the oracle in every test):
//
//   for each triangle with p: if it also has q it vanishes (F^c of G03), else p becomes q;
//   q's position becomes `position`;
//   every triangle in `derived` shows its geometric normal from now on, whatever its stored one,
//   which changes no more (it comes back when the contraction is undone, and is shown while the
//   triangle has no area);
//   in every corner at q, in layer `layer`, attribute `from` becomes `to` (each AttributeChange).
//   No `to` of a contraction is a `from` of the same layer in it, so their order does not matter.
//
// So any prefix of the sequence is one level of detail. Its error is the largest along the prefix.
#pragma once

#include "crease/ids.h"
#include "crease/mesh.h"
#include "crease/vec.h"

#include <cstdint>
#include <span>
#include <vector>

namespace crease {

// Errors keep their units and are never mixed into one number. The surface's is nearly a bound: no
// input vertex was found farther than that from the level, but for a tenth, nor for those of a part
// that has vanished, of which the size counts; a level's surface can be farther from the input
// between them. The others are means over what a vertex stands for.
struct LevelError {
  float surface = 0;  // distance between the surfaces, model units
  float line = 0;     // displacement of creases and open borders, and of what textures, colours and
                      // shading show on the surface, model units
  float degrees = 0;  // shading: between the normals shown and the input's
  float texture = 0;  // texture coordinates' displacement, texture units
};

// The larger of each.
constexpr LevelError larger(const LevelError& a, const LevelError& b) {
  const auto more = [](float x, float y) { return x > y ? x : y; };
  return {more(a.surface, b.surface), more(a.line, b.line), more(a.degrees, b.degrees),
          more(a.texture, b.texture)};
}

// Where v_s may stand.
enum class Placement : std::uint8_t {
  Endpoint,  // at p or at q; the PM stores one bit (DB03 swapVectors), attributes are inherited
  Optimal,   // near where the error is least: between p and q in one of the ways that a file keeps
            // for few bits (docs/format-block.md), or anywhere if that is far better; the PM stores
            // a vector (DB03 delta) and new attribute values
};

// At the corners of v_s, in one layer, attribute `from` becomes `to`. `to` may be a value that the
// input does not have; such values follow the input's in ContractionSequence::new_values.
struct AttributeChange {
  std::uint32_t layer = 0;
  AttributeId from{};
  AttributeId to{};
  bool operator==(const AttributeChange&) const = default;
};

struct Contraction {
  VertexId removed{};               // p
  VertexId kept{};                  // q, whose slot is v_s afterwards
  Vec3i position{};                 // of v_s, grid units
  LevelError error;                 // at v_s; not less than those of p and q (monotone up the tree)
  std::uint32_t first_change = 0;   // its attribute changes: changes[first_change ..
  std::uint32_t change_count = 0;   //                               + change_count)
  std::uint32_t first_derived = 0;  // likewise in derived
  std::uint32_t derived_count = 0;
};

// A band of the simplification: its contractions follow those of the band before. Each
// contraction touches triangles of one patch only, and only vertices that no other patch has.
struct Band {
  std::uint32_t contraction_count = 0;
  std::vector<TriangleId> triangles;          // live at its start, patch after patch
  std::vector<std::uint32_t> first_triangle;  // patch_count + 1 offsets into `triangles`

  std::size_t patch_count() const { return first_triangle.size() - 1; }
  std::span<const TriangleId> triangles_of(std::size_t patch) const {
    return std::span(triangles).subspan(first_triangle[patch],
                                        first_triangle[patch + 1] - first_triangle[patch]);
  }
};

struct ContractionSequence {
  Grid grid;
  Placement placement = Placement::Optimal;
  std::vector<Contraction> contractions;  // finest first
  std::vector<AttributeChange> changes;
  std::vector<TriangleId> derived;             // input triangles; each appears at most once
  std::vector<std::vector<float>> new_values;  // per layer: values that follow the input's
  // If they were recorded, else empty.
  std::vector<Band> bands;                          // finest first
  std::vector<std::uint32_t> patch_of_contraction;  // in its band

  std::span<const AttributeChange> changes_of(const Contraction& c) const {
    return std::span<const AttributeChange>(changes).subspan(c.first_change, c.change_count);
  }
  std::span<const TriangleId> derived_of(const Contraction& c) const {
    return std::span<const TriangleId>(derived).subspan(c.first_derived, c.derived_count);
  }
};

// One level of detail as plain arrays, triangle t of the input at its old index while it is alive.
struct Level {
  std::vector<Vec3i> positions;     // per input vertex, grid units
  std::vector<Triangle> triangles;  // per input triangle
  std::vector<bool> alive;          // per input triangle
  std::vector<bool> derived;        // per input triangle: shows its geometric normal
  std::vector<std::vector<AttributeId>> of_corner;  // per layer, 3 per input triangle
};

// The first `count` contractions applied one by one to the snapped mesh, by the definition above.
// Time O(count * triangles around a vertex). The oracle; the fast way is ProgressiveMesh.
Level apply_contractions(const Mesh& snapped, const ContractionSequence& sequence,
                         std::size_t count);

// That level as a mesh of its own: live triangles in input order, used vertices and attribute
// values only, derived normals computed. Attribute values come from the input, then new_values.
Mesh mesh_of_level(const Mesh& snapped, const ContractionSequence& sequence, const Level& level);

// The first invariant that does not hold, in words: ids in range and alive when used, errors
// monotone up the tree, derived at most once, attribute changes only of attributes that stand at
// v_s, endpoints where the placement says so. Time O(contractions * triangles around a vertex).
Status check_contractions(const Mesh& snapped, const ContractionSequence& sequence);

}  // namespace crease
