// The classes that triangles have for life, on cases drawn by hand.
#include "assemble/arrange.h"
#include "crease/shading.h"
#include "support/mesh_builder.h"
#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <algorithm>

namespace crease {
namespace {

// Two smooth fans of four triangles around vertices 0 and 5, apart from each other.
struct TwoFans {
  Mesh mesh;
  AttributeId up, side;
};

TwoFans two_fans() {
  MeshBuilder b;
  TwoFans f;
  f.up = b.normal({0, 0, 1});
  f.side = b.normal({1, 0, 0});
  const auto fan = [&b](Vec3d middle, Vec3d u, Vec3d v, AttributeId n) {
    const VertexId m = b.vertex(middle);
    const VertexId ring[] = {b.vertex(middle + u), b.vertex(middle + v), b.vertex(middle - u),
                             b.vertex(middle - v)};
    for (std::size_t i = 0; i < 4; ++i) b.triangle({m, ring[i], ring[(i + 1) % 4]}, n);
  };
  fan({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, f.up);
  fan({4, 0, 0}, {0, 1, 0}, {0, 0, 1}, f.side);
  f.mesh = b.take();
  return f;
}

ContractionSequence join_middles(const Mesh& mesh, Placement placement) {
  ContractionSequence sequence;
  sequence.grid = make_grid(mesh, {.bits = 8});
  sequence.placement = placement;
  Contraction c;
  c.removed = VertexId{0};
  c.kept = VertexId{5};
  c.position = sequence.grid.nearest(mesh.positions[0]);
  sequence.contractions.push_back(c);
  return sequence;
}

ProgressiveArrays arranged(const Mesh& mesh, const ContractionSequence& sequence) {
  return arrange(mesh, sequence, restructure(mesh, sequence), nullptr);
}

TEST_CASE("two smooth vertices that meet with different normals: one fan stores its normals") {
  TwoFans fans = two_fans();
  ContractionSequence sequence = join_middles(fans.mesh, Placement::Endpoint);
  snap(fans.mesh, sequence.grid);
  const ProgressiveArrays a = arranged(fans.mesh, sequence);
  CHECK(a.full.sn_triangles == 4);
  CHECK(a.full.fn_triangles == 4);  // one normal each, on all corners
  CHECK(a.full.sn_vertices == 5);   // vertices that no SN triangle uses own nothing
  CHECK(a.full.nsn_vertices == 5);
  CHECK(check_progressive_arrays(a).ok());
}

TEST_CASE("two smooth vertices whose normals become one stay smooth") {
  TwoFans fans = two_fans();
  ContractionSequence sequence = join_middles(fans.mesh, Placement::Endpoint);
  snap(fans.mesh, sequence.grid);
  sequence.changes = {{0, fans.side, fans.up}};
  sequence.contractions[0].change_count = 1;
  const ProgressiveArrays a = arranged(fans.mesh, sequence);
  CHECK(a.full.sn_triangles == 8);
  CHECK(a.normals.size() == 10);  // replicated: one for every SN slot
  // p keeps its slot since its normal is the one that stays: no own change is stored.
  CHECK(a.contractions.own.empty());
}

// A smooth fan around p; q is a corner of two flat triangles with different normals.
TEST_CASE("an SN vertex contracted into an NSN vertex takes its place, positions swapped") {
  MeshBuilder b;
  const AttributeId up = b.normal({0, 0, 1});
  const VertexId p = b.vertex({0, 0, 0});
  const VertexId ring[] = {b.vertex({1, 0, 0}), b.vertex({0, 1, 0}), b.vertex({-1, 0, 0}),
                           b.vertex({0, -1, 0})};
  for (std::size_t i = 0; i < 4; ++i) b.triangle({p, ring[i], ring[(i + 1) % 4]}, up);
  const VertexId q = b.vertex({0, 0, 4});
  b.flat_triangle({q, b.vertex({1, 0, 4}), b.vertex({1, 1, 5})});
  b.flat_triangle({q, b.vertex({0, 1, 4}), b.vertex({0, 1, 5})});
  Mesh mesh = b.take();
  for (Placement placement : {Placement::Endpoint, Placement::Optimal}) {
    ContractionSequence sequence;
    sequence.grid = make_grid(mesh, {.bits = 8});
    sequence.placement = placement;
    snap(mesh, sequence.grid);
    Contraction c;
    c.removed = p;
    c.kept = q;
    c.position = sequence.grid.nearest(mesh.positions[index_of(q)]);
    sequence.contractions.push_back(c);
    const ProgressiveArrays a = arranged(mesh, sequence);
    CHECK(a.full.sn_triangles == 4);
    CHECK(a.full.fn_triangles == 2);
    REQUIRE(a.contractions.count() == 1);
    CHECK(a.contractions.kept[0] < a.full.sn_vertices);  // p's slot stays
    CHECK((a.contractions.headers[0] & 1) == 1);         // q's, an NSN one, goes
    CHECK(a.contractions.corners.size() == 2);           // and with it the two flat triangles
    CHECK(((a.contractions.headers[0] & 2) != 0) == (placement == Placement::Endpoint));
    CHECK(a.contractions.deltas.size() == (placement == Placement::Optimal ? 1 : 0));
  }
}

//   0---1     The two triangles 0-3-1 and 3-4-1 vanish with the edge 1-3, and 0 and 4, which are in
//   | / |     no other, are lost besides p.
//   3---4
TEST_CASE("vertices that only vanishing triangles have are lost with them") {
  MeshBuilder b;
  const VertexId v0 = b.vertex({0, 1, 0}), v1 = b.vertex({1, 1, 0}), v3 = b.vertex({0, 0, 0}),
                 v4 = b.vertex({1, 0, 0});
  const AttributeId up = b.normal({0, 0, 1});
  b.triangle({v0, v3, v1}, up);
  b.triangle({v3, v4, v1}, up);
  Mesh mesh = b.take();
  ContractionSequence sequence;
  sequence.grid = make_grid(mesh, {.bits = 8});
  snap(mesh, sequence.grid);
  Contraction c;
  c.removed = v1;
  c.kept = v3;
  c.position = sequence.grid.nearest(mesh.positions[index_of(v3)]);
  sequence.contractions.push_back(c);
  const auto lost = [&] { return arranged(mesh, sequence).contractions.headers[0] >> 6 & 3; };
  CHECK(lost() == 3);
  // A later contraction names 4: it must be there until then.
  c.removed = v4;
  sequence.contractions.push_back(c);
  CHECK(lost() == 2);
}

TEST_CASE(
    "without contractions the classes are those of the input, save vertices that own nothing") {
  for (const ZooMesh& z : mesh_zoo()) {
    CAPTURE(z.name);
    Mesh mesh = z.mesh;
    ContractionSequence none;
    none.grid = make_grid(mesh, {});
    snap(mesh, none.grid);
    const ProgressiveArrays a = arranged(mesh, none);
    const ShadingKinds kinds = classify_shading(mesh);
    const auto count = [&kinds](TriangleKind kind) {
      return static_cast<std::uint32_t>(std::ranges::count(kinds.of_triangle, kind));
    };
    CHECK(a.full.sn_triangles == count(TriangleKind::SN));
    CHECK(a.full.fn_triangles == count(TriangleKind::FN));
    CHECK(a.full.nsn_triangles == count(TriangleKind::NSN));
    std::vector<bool> used(mesh.vertex_count(), false);
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      if (kinds.of_triangle[t] != TriangleKind::SN) continue;
      for (VertexId v : mesh.triangles[t]) used[index_of(v)] = true;
    }
    CHECK(a.full.sn_vertices == static_cast<std::uint32_t>(std::ranges::count(used, true)));
  }
}

}  // namespace
}  // namespace crease
