#include "crease/progressive_mesh.h"
#include "support/level_equality.h"

#include <doctest/doctest.h>

#include <algorithm>

namespace crease {
namespace {

// What a plain progressive mesh of one normal a vertex stores, counted from the sequence alone. It
// keeps q and one word of counts, a vector or a bit, the corners in which p becomes q, and the bits
// of the normal at q where it changes; or p instead of q where that is less. It has the same
// records of error.
struct PlainLedger {
  std::size_t arrays = 0, records = 0;
};

// The normal and the number of corners at `v`, of triangles that do not have `other`.
struct VertexUse {
  AttributeId normal = kNoAttribute;
  std::size_t corners = 0;
};
VertexUse use_of(const Level& level, VertexId v, VertexId other) {
  VertexUse use;
  for (std::size_t t = 0; t < level.triangles.size(); ++t) {
    const Triangle& triangle = level.triangles[t];
    if (!level.alive[t] || std::ranges::count(triangle, other) > 0) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      if (triangle[k] != v) continue;
      use.normal = level.of_corner[0][3 * t + k];
      ++use.corners;
    }
  }
  return use;
}

PlainLedger plain_progressive_mesh(const Case& c) {
  PlainLedger ledger;
  ledger.arrays = 24 * c.mesh.vertex_count() + 12 * c.mesh.triangle_count();
  const auto differ = [&c](AttributeId a, AttributeId b) {
    const auto x = attribute_value(c.mesh.layers[0], c.sequence, 0, a);
    const auto y = attribute_value(c.mesh.layers[0], c.sequence, 0, b);
    return std::memcmp(x.data(), y.data(), 12) != 0;
  };
  LevelError worst;
  Level level = apply_contractions(c.mesh, c.sequence, 0);
  for (std::size_t i = 0; i < c.sequence.contractions.size(); ++i) {
    const Contraction& contraction = c.sequence.contractions[i];
    const VertexUse p = use_of(level, contraction.removed, contraction.kept);
    const VertexUse q = use_of(level, contraction.kept, contraction.removed);
    level = apply_contractions(c.mesh, c.sequence, i + 1);
    const AttributeId after = use_of(level, contraction.kept, contraction.removed).normal;
    const auto cost = [&](const VertexUse& kept, const VertexUse& removed) {
      if (after == kNoAttribute) return 4 * removed.corners;  // nothing is left to have a normal
      const bool changes = kept.corners == 0 || differ(kept.normal, after);
      return 4 * removed.corners + (changes ? 12 : 0);
    };
    ledger.records += 8 + (c.sequence.placement == Placement::Optimal ? 12 : 0);
    ledger.records += std::min(cost(q, p), cost(p, q));
    const LevelError& e = contraction.error;
    if (e.surface > worst.surface || e.line > worst.line || e.degrees > worst.degrees ||
        e.texture > worst.texture) {
      ledger.records += 20;
      worst = {std::max(worst.surface, e.surface), std::max(worst.line, e.line),
               std::max(worst.degrees, e.degrees), std::max(worst.texture, e.texture)};
    }
  }
  return ledger;
}

TEST_CASE("a completely smooth mesh stores no more than a plain progressive mesh") {
  for (const Mesh& mesh : {smooth_sphere(10, 12), torus(12, 8)}) {
    for (Placement placement : {Placement::Endpoint, Placement::Optimal}) {
      const Case c = make_case(mesh, {.seed = 3,
                                      .placement = placement,
                                      .virtual_share = 0.05,
                                      .derive_share = 0,
                                      .smooth_only = true});
      REQUIRE(c.arrays->full.triangles() == c.arrays->full.sn_triangles);
      const PlainLedger plain = plain_progressive_mesh(c);
      const LinearBytes bytes = linear_bytes(*c.arrays);
      // Contractions that lose more than 15 triangles at once; a plain one has to say it as well.
      const std::size_t wide = sizeof(WideCounts) * c.arrays->contractions.wide.size();
      CHECK(bytes.crease == plain.arrays);
      CHECK(bytes.records - wide == plain.records);
      CHECK(c.arrays->contractions.wide.size() < 8);
      CHECK(c.arrays->contractions.blocks.empty());
      // A smooth mesh is the same either way, save for the wedges' indirection.
      CHECK(bytes.replicated == bytes.crease);
      CHECK(bytes.wedge == bytes.crease + 4 * c.mesh.vertex_count());
    }
  }
}

TEST_CASE("flat meshes store one normal index a triangle, wedges three normals") {
  const Case c = make_case(faceted_sphere(10, 12), {.seed = 3, .change_share = 0});
  const std::size_t v = c.mesh.vertex_count(), t = c.mesh.triangle_count();
  const LinearBytes bytes = linear_bytes(*c.arrays);
  CHECK(c.arrays->full.sn_triangles == 0);
  CHECK(bytes.wedge == 12 * v + 12 * t + 16 * 3 * t);
  CHECK(bytes.replicated == 12 * t + 24 * 3 * t);
  // Random contractions join normals, so some triangles are NSN for life.
  CHECK(bytes.crease < bytes.wedge);
  CHECK(bytes.crease < bytes.replicated);

  ContractionSequence none;
  none.grid = c.sequence.grid;
  const ProgressiveArrays still = arrange(c.mesh, none, restructure(c.mesh, none), nullptr);
  CHECK(still.full.fn_triangles == t);
  CHECK(linear_bytes(still).crease == 12 * v + 12 * t + 12 * t + 4 * t);
}

TEST_CASE("a vertex attribute costs one value a vertex") {
  const Case c = make_case(height_field(8), {.seed = 3, .derive_share = 0, .smooth_only = true});
  REQUIRE(c.arrays->layers.size() == 1);
  const ProgressiveLayer& uv = c.arrays->layers[0];
  CHECK(uv.storage == ProgressiveLayer::Storage::Vertex);
  CHECK(uv.value_count() == c.mesh.vertex_count());
  CHECK(uv.row_of_triangle.empty());
  CHECK(uv.indices.empty());
}

}  // namespace
}  // namespace crease
