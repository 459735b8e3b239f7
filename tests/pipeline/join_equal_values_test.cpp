// What stands apart at a vertex stays apart when its values are written as codes, and becomes equal
// to others by that.
#include "pipeline/join_equal_values.h"

#include "crease/contraction.h"
#include "hierarchy/attribute_values.h"
#include "pipeline/snap_attributes.h"
#include "support/mesh_builder.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace crease {
namespace {

//   r---u---s    p-q is a crease between the upper triangles and the lower ones; p and q become
//   one.
//    \ / \ /     Two more triangles on the outside of each, all of them hard, stand on p and on q.
//     p---q
//    / \ / \   .
//   r---d---s
struct Crease {
  std::array<AttributeId, 4> at_p, at_q;  // above, below, and two outside
  Mesh mesh;
  ContractionSequence sequence;
  std::vector<LayerCoding> codings;
};

constexpr std::size_t kAbove = 0, kBelow = 1, kOutside = 2, kOther = 3;

Crease crease_of(const std::array<Vec3d, 4>& at_p, const std::array<Vec3d, 4>& at_q,
                 const AttributePrecision& precision) {
  MeshBuilder b;
  Crease c;
  const VertexId p = b.vertex({-1, 0, 0}), q = b.vertex({1, 0, 0}), u = b.vertex({0, 2, 0}),
                 d = b.vertex({0, -2, 0});
  const AttributeId others[] = {b.normal({0.5, 0, 1}), b.normal({0, 0.5, 1})};
  for (std::size_t i = 0; i < 4; ++i) {
    c.at_p[i] = b.normal(at_p[i]);
    c.at_q[i] = b.normal(at_q[i]);
  }
  b.triangle({p, q, u}, {c.at_p[kAbove], c.at_q[kAbove], others[0]});
  b.triangle({q, p, d}, {c.at_q[kBelow], c.at_p[kBelow], others[0]});
  for (const bool right : {false, true}) {
    const double x = right ? 1 : -1;
    const VertexId end = right ? q : p;
    const std::array<AttributeId, 4>& at = right ? c.at_q : c.at_p;
    const VertexId up = b.vertex({2 * x, 2, 0}), down = b.vertex({2 * x, -2, 0}),
                   out = b.vertex({4 * x, 1, 1}), far = b.vertex({4 * x, -1, 1});
    b.triangle({end, u, up}, {at[kAbove], others[0], others[1]});
    b.triangle({end, d, down}, {at[kBelow], others[0], others[1]});
    b.triangle({end, out, far}, {at[kOutside], others[0], others[1]});
    b.triangle({end, far, out}, {at[kOther], others[0], others[1]});
  }
  c.mesh = b.take();
  c.sequence.grid = make_grid(c.mesh, {.bits = 8});
  snap(c.mesh, c.sequence.grid);
  c.codings = codings_of(c.mesh, precision);
  snap_to_codings(c.mesh, c.codings);
  c.sequence.new_values.resize(1);
  Contraction contraction;
  contraction.kept = p;
  contraction.removed = q;
  contraction.position = c.sequence.grid.nearest({0, 0, 0});
  c.sequence.contractions.push_back(contraction);
  return c;
}

// Above and below become these.
void record(Crease& c, const Vec3d& above, const Vec3d& below) {
  const std::size_t known = c.mesh.layers[0].value_count();
  for (const Vec3d& n : {normalized(above), normalized(below)}) {
    for (const double x : {n.x, n.y, n.z}) c.sequence.new_values[0].push_back(float(x));
  }
  for (const std::size_t side : {kAbove, kBelow}) {
    const AttributeId to{std::uint32_t(known + side)};
    c.sequence.changes.push_back({0, c.at_p[side], to});
    c.sequence.changes.push_back({0, c.at_q[side], to});
  }
  c.sequence.contractions[0].change_count = 4;
  snap_new_values(c.sequence, c.mesh, c.codings);
  join_equal_values(c.sequence, c.mesh, c.codings);
}

AttributeId after(const Crease& c, AttributeId id) {
  for (const AttributeChange& change : c.sequence.changes) {
    if (change.from == id) return change.to;
  }
  return id;
}

bool are_equal(const Crease& c, AttributeId a, AttributeId b) {
  return std::ranges::equal(attribute_value(c.mesh.layers[0], c.sequence, 0, a),
                            attribute_value(c.mesh.layers[0], c.sequence, 0, b));
}

// Both sides of the crease are one each, and nothing else is.
void check_apart(const Crease& c) {
  for (const std::size_t side : {kAbove, kBelow}) {
    CHECK(after(c, c.at_p[side]) == after(c, c.at_q[side]));
  }
  const std::array<AttributeId, 6> all{after(c, c.at_p[kAbove]),   after(c, c.at_p[kBelow]),
                                       after(c, c.at_p[kOutside]), after(c, c.at_q[kOutside]),
                                       after(c, c.at_p[kOther]),   after(c, c.at_q[kOther])};
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) CHECK_FALSE(are_equal(c, all[i], all[k]));
  }
}

constexpr AttributePrecision kFewBits{.normal_bits = 8};
constexpr Vec3d kOutsideP{-0.3, 0, 1}, kOutsideQ{0.3, 0, 1}, kOtherP{-0.6, 0, 1},
    kOtherQ{0.6, 0, 1};

TEST_CASE("a normal at one end that is another's at the other end does not join them") {
  Crease c = crease_of({Vec3d{0, 0.2, 1}, Vec3d{0, -0.2, 1}, kOutsideP, kOtherP},
                       {Vec3d{0, 0.4, 1}, Vec3d{0, 0.2, 1}, kOutsideQ, kOtherQ}, kFewBits);
  REQUIRE(are_equal(c, c.at_p[kAbove], c.at_q[kBelow]));
  record(c, {0, 0.3, 1}, {0, -0.1, 1});
  check_apart(c);
}

TEST_CASE("normals on both sides of a crease that get one code stay two, on each side one") {
  Crease c = crease_of({Vec3d{0, 0.2, 1}, Vec3d{0, -0.2, 1}, kOutsideP, kOtherP},
                       {Vec3d{0, 0.4, 1}, Vec3d{0, -0.4, 1}, kOutsideQ, kOtherQ}, kFewBits);
  record(c, {0, 1e-5, 1}, {0, -1e-5, 1});
  check_apart(c);
}

TEST_CASE("where others have all that a side had, it gets a code beside") {
  const Vec3d above_p{0, 0.2, 1}, above_q{0, 0.4, 1}, below_p{0, -0.2, 1}, below_q{0, -0.4, 1};
  for (const NormalCoding coding : {NormalCoding::Octahedral, NormalCoding::Deering}) {
    const AttributePrecision precision{.normal_coding = coding,
                                       .normal_bits = coding == NormalCoding::Deering ? 6 : 8};
    Crease c = crease_of({above_p, below_p, above_q, below_q}, {above_q, below_q, above_p, below_p},
                         precision);
    record(c, {0, 1e-5, 1}, {0, -1e-5, 1});
    check_apart(c);
    const LayerQuantizer quantizer(c.codings[0]);
    std::vector<float> codes = c.sequence.new_values[0];
    CHECK(codes.size() == 9);
    for (std::size_t i = 0; i < codes.size(); i += 3)
      quantizer.snap(std::span(codes).subspan(i, 3));
    CHECK(codes == c.sequence.new_values[0]);
  }
}

}  // namespace
}  // namespace crease
