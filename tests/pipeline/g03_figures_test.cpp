// The figures of G03, case by case. Meshes are drawn and written corner by corner:
//
//   {"tuw", "abW"}    a triangle at vertices t, u, w, with attributes a, b, W of one linear layer
//
// Contractions are recorded as the simplifier does it, by the linked attributes of collapsed
// triangles; attributes that become one become a new one half way between them.
#include "pipeline/hierarchy_case.h"

#include "hierarchy/corner_subgraph.h"
#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <set>

namespace crease {
namespace {

struct Drawn {
  const char *vertices, *attributes;
};

// Vertices and attributes are the characters themselves; a value is its character's code.
struct Figure {
  Mesh mesh;
  ContractionSequence sequence;
  std::vector<Triangle> now;           // with kNone where collapsed
  std::vector<AttributeId> of_corner;  // now

  explicit Figure(std::initializer_list<Drawn> triangles) {
    mesh.positions.resize(128);
    for (std::size_t v = 0; v < 128; ++v) mesh.positions[v] = {double(v), double(v * v % 17), 0};
    AttributeLayer layer{"tone", AttributeRole::Other, Interpolation::Linear, 1, {}, {}};
    for (int value = 0; value < 128; ++value) layer.values.push_back(float(value));
    for (const Drawn& t : triangles) {
      Triangle corners{};
      for (std::size_t c = 0; c < 3; ++c) {
        corners[c] = VertexId(t.vertices[c]);
        layer.of_corner.push_back(AttributeId(t.attributes[c]));
      }
      mesh.triangles.push_back(corners);
    }
    now = mesh.triangles;
    of_corner = layer.of_corner;
    mesh.layers.push_back(std::move(layer));
    sequence.new_values.resize(1);
  }

  // v_t and v_u become v_s, which takes v_t's name.
  void contract(char t, char u) {
    const auto vt = VertexId(t), vu = VertexId(u);
    std::map<AttributeId, std::set<AttributeId>> linked;  // with what, at first hand
    for (std::size_t i = 0; i < now.size(); ++i) {
      const auto at_t = std::ranges::find(now[i], vt), at_u = std::ranges::find(now[i], vu);
      if (at_t == now[i].end() || at_u == now[i].end()) continue;
      const AttributeId a = of_corner[3 * i + std::size_t(at_t - now[i].begin())];
      const AttributeId b = of_corner[3 * i + std::size_t(at_u - now[i].begin())];
      linked[a].insert(b);
      linked[b].insert(a);
      now[i].fill(VertexId(kNone));
    }
    for (std::size_t corner : corners_at(vu)) now[corner / 3][corner % 3] = vt;
    std::set<AttributeId> standing;
    for (std::size_t corner : corners_at(vt)) standing.insert(of_corner[corner]);
    Contraction contraction;
    contraction.kept = vt;
    contraction.removed = vu;
    contraction.first_change = static_cast<std::uint32_t>(sequence.changes.size());
    while (!standing.empty()) {
      std::set<AttributeId> all{*standing.begin()}, members;
      for (std::size_t before = 0; before != all.size();) {
        before = all.size();
        for (AttributeId a : std::set<AttributeId>(all)) all.merge(std::set(linked[a]));
      }
      std::ranges::set_intersection(all, standing, std::inserter(members, members.end()));
      for (AttributeId a : members) standing.erase(a);
      if (members.size() > 1) join(vt, members);
    }
    contraction.change_count =
        static_cast<std::uint32_t>(sequence.changes.size()) - contraction.first_change;
    sequence.contractions.push_back(contraction);
  }

  HierarchyCase build() const { return case_of(mesh, sequence); }

 private:
  std::vector<std::size_t> corners_at(VertexId v) const {
    std::vector<std::size_t> found;
    for (std::size_t corner = 0; corner < 3 * now.size(); ++corner) {
      if (now[corner / 3][corner % 3] == v) found.push_back(corner);
    }
    return found;
  }

  void join(VertexId v, const std::set<AttributeId>& members) {
    std::vector<float>& added = sequence.new_values[0];
    const auto joined = AttributeId(128 + added.size());
    float sum = 0;
    for (AttributeId a : members) {
      sum += index_of(a) < 128 ? float(index_of(a)) : added[index_of(a) - 128];
      sequence.changes.push_back({0, a, joined});
    }
    added.push_back(sum / float(members.size()));
    for (std::size_t corner : corners_at(v)) {
      if (members.contains(of_corner[corner])) of_corner[corner] = joined;
    }
  }
};

// A split's symbols, which say all there is.
SubgraphCode checked_code(const HierarchyCase& c, std::size_t layer, SplitId s) {
  const CornerSubgraph graph = corner_subgraph(c.hierarchy, layer, s);
  const SubgraphCode code = encode_subgraph(graph);
  REQUIRE(decode_subgraph(code) == graph);
  return code;
}

// The symbols at a contraction, each before its attribute's character: "Ca Mb / Mc".
std::string symbols(const HierarchyCase& c, std::size_t contraction) {
  const Status status = check_hierarchy(c.hierarchy);
  CHECK_MESSAGE(status.ok(), (status.ok() ? "" : status.failure().message));
  const SplitId s = c.maps.split_of_contraction[contraction];
  const SubgraphCode code = checked_code(c, 0, s);
  if (code.is_explicit) return "explicit";
  std::string text;
  for (bool second : {false, true}) {
    const NodeId child = c.hierarchy.vertices.child(s, second);
    RelativeAttribute a = 0;
    for (AttributeSymbol symbol : second ? code.second : code.first) {
      text += "RCMX"[static_cast<int>(symbol)];
      text += char(c.hierarchy.value(0, child, a++)[0]);
      text += ' ';
    }
    text += second ? "" : "/ ";
  }
  return text;
}

// The values at v_s.
std::vector<float> values_above(const HierarchyCase& c, std::size_t contraction) {
  const SplitId s = c.maps.split_of_contraction[contraction];
  const NodeId node = c.hierarchy.vertices.node_of_split[index_of(s)];
  std::vector<float> values;
  for (std::uint32_t a = 0; a < c.hierarchy.layers[0].attribute_count(node); ++a) {
    values.push_back(c.hierarchy.value(0, node, RelativeAttribute(a))[0]);
  }
  return values;
}

// All of figure 6 is about this patch; triangles tuw and txu collapse.
//
//          w
//        / | \            left:  lwt, lt x
//       /  |  \           right: urw, uxr
//      l--t---u--r
//       \  |  /
//        \ | /
//          x
//
// Attributes at t, from the left upper triangle on clockwise: lwt, tuw, txu, lxt; at u: tuw, urw,
// uxr, txu.
Figure patch(const char (&at_t)[5], const char (&at_u)[5], const char* at_w = "WWW") {
  const std::string lwt{'L', at_w[0], at_t[0]}, tuw{at_t[1], at_u[0], at_w[1]},
      urw{at_u[1], 'R', at_w[2]}, uxr{at_u[2], 'X', 'R'}, txu{at_t[2], 'X', at_u[3]},
      lxt{'L', 'X', at_t[3]};
  return Figure({{"lwt", lwt.c_str()},
                 {"tuw", tuw.c_str()},
                 {"urw", urw.c_str()},
                 {"uxr", uxr.c_str()},
                 {"txu", txu.c_str()},
                 {"lxt", lxt.c_str()}});
}

HierarchyCase contracted(Figure figure) {
  figure.contract('t', 'u');
  return figure.build();
}

TEST_CASE("6 a: in a smooth region the two attributes merge") {
  const HierarchyCase c = contracted(patch("aaaa", "cccc"));
  CHECK(symbols(c, 0) == "Ma / Mc ");
  CHECK(values_above(c, 0) == std::vector<float>{'b'});
}

//  a   c        the edge t-u is sharp, and so are l-t and u-r
//  ------
//  e   g
TEST_CASE("6 b: along a sharp edge each side merges on its own") {
  const HierarchyCase c = contracted(patch("aaee", "ccgg"));
  CHECK(symbols(c, 0) == "Ma Me / Mc Mg ");
  CHECK(values_above(c, 0) == std::vector<float>{'b', 'f'});
}

//    w
//  a/           w-t and t-l are sharp: a crease that turns at t
//  --  c   e
TEST_CASE("6 c: an attribute without counterpart is copied") {
  const HierarchyCase c = contracted(patch("accc", "eeee"));
  CHECK(symbols(c, 0) == "Ca Mc / Me ");
  CHECK(values_above(c, 0) == std::vector<float>{'a', 'd'});
}

//    w
//  a/ \d        w-t-x and w-u-x are sharp: the collapsed triangles are enclosed
//   \ /
//    x
TEST_CASE("6 d: the attributes of enclosed collapsed triangles are removed") {
  const HierarchyCase c = contracted(patch("abba", "cddc"));
  CHECK(symbols(c, 0) == "Ca Rb / Rc Cd ");
  CHECK(values_above(c, 0) == std::vector<float>{'a', 'd'});
}

//  a
//  ---- d       l-t is sharp, t-u is sharp at t and smooth at u: semi-sharp
//  b
TEST_CASE("6 e: a collapsed semi-sharp edge merges three attributes, with a branch code") {
  const HierarchyCase c = contracted(patch("aabb", "dddd"));
  CHECK(symbols(c, 0) == "Ma Xb / Md ");
  CHECK(values_above(c, 0).size() == 1);
  const auto& layer = c.hierarchy.layers[0];
  const SplitId s = c.maps.split_of_contraction[0];
  CHECK(layer.branches_of_split.of(index_of(s)).size() == 2);
  // The way down tells the upper left triangle from the lower left one.
  for (const auto& [triangle, expected] : {std::pair(0u, 'a'), std::pair(5u, 'b')}) {
    const std::size_t n = index_of(c.maps.new_of_triangle[triangle]);
    const WedgeId wedge = c.hierarchy.vertices.triangles[n][2];
    const RelativeAttribute a = c.hierarchy.below(0, s, false, 0, wedge);
    CHECK(c.hierarchy.value(0, c.hierarchy.vertices.first_child(s), a)[0] == float(expected));
  }
}

//    w          tuw is enclosed by sharp edges; left and right of it w has different attributes,
//  a/_\c        below it everything is smooth
TEST_CASE("6 f: contracting sharp and smooth edges makes a semi-sharp one") {
  const HierarchyCase c = contracted(patch("abaa", "dccc", "YWZ"));
  CHECK(symbols(c, 0) == "Ma Rb / Mc Rd ");
  CHECK(values_above(c, 0) == std::vector<float>{'b'});
  // The edge s-w: one attribute at s on both sides, two at w.
  const Cut merged = linear_cut(c, 1);
  const CutTriangle left = triangle_at_cut(c, merged, TriangleId{0});
  const CutTriangle right = triangle_at_cut(c, merged, TriangleId{2});
  REQUIRE(left.nodes[2] == right.nodes[0]);
  REQUIRE(left.nodes[1] == right.nodes[2]);
  CHECK(value_at_cut(c, left, 0, TriangleId{0}, 2)[0] ==
        value_at_cut(c, right, 0, TriangleId{2}, 0)[0]);
  CHECK(value_at_cut(c, left, 0, TriangleId{0}, 1)[0] !=
        value_at_cut(c, right, 0, TriangleId{2}, 2)[0]);
}

// Five triangles around the tip o, smooth at the base 0 1 2 3 4, with an attribute each at the tip.
TEST_CASE("3: a cone has semi-sharp edges, and its tip as many attributes as triangles") {
  Figure cone({{"01o", "ABa"}, {"12o", "BCb"}, {"23o", "CDc"}, {"34o", "DEd"}, {"40o", "EAe"}});
  cone.contract('0', '1');  // a is not shown any more; a cut that splits this one shows it
  cone.contract('o', '0');
  const HierarchyCase c = cone.build();
  CHECK(symbols(c, 0) == "MA / MB ");
  const NodeId tip = c.maps.leaf_of_vertex['o'];
  CHECK(c.hierarchy.layers[0].attribute_count(tip) == 5);
  // Triangles 12o and 40o collapse: b and e join what the base had, and c and d, which go on to
  // stand at the tip, are copied. a goes with its triangle, of which two corners are there now.
  CHECK(symbols(c, 1).find("Ra") != std::string::npos);
  CHECK(symbols(c, 1).find("Cc") != std::string::npos);
  CHECK(symbols(c, 1).find("Cd") != std::string::npos);
}

// Three triangles at the edge t-u: w's and x's are smooth with each other, y's is apart.
TEST_CASE("7: a non-manifold edge needs no other rules") {
  Figure figure({{"tuw", "acW"},
                 {"utx", "caX"},
                 {"tuy", "egY"},
                 {"ltw", "LaW"},
                 {"lty", "LeY"},
                 {"urw", "cRW"},
                 {"ury", "gRY"}});
  figure.contract('t', 'u');
  const HierarchyCase c = figure.build();
  CHECK(symbols(c, 0) == "Ma Me / Mc Mg ");
  CHECK(values_above(c, 0) == std::vector<float>{'b', 'f'});
}

//    1-----2        123 has a at 3, the triangles beside it have b. 1-2 is contracted first, and a
//     \ a /         is in no triangle of any level; then 3-4.
//   5-b-3-b-6
//       4
TEST_CASE("8: an attribute that no level shows is there when selective refinement needs it") {
  Figure figure({{"123", "ABa"}, {"153", "ACb"}, {"263", "BDb"}, {"354", "bCE"}, {"364", "bDE"}});
  figure.contract('1', '2');
  figure.contract('3', '4');
  const HierarchyCase c = figure.build();
  CHECK(symbols(c, 1).starts_with("Ca "));
  const Cut refined{false, true};  // 1 and 2 are there, 3 and 4 are one
  CHECK(difference_at_cut(c, refined) == "");
  const CutTriangle triangle = triangle_at_cut(c, refined, TriangleId{0});
  REQUIRE(triangle.is_active);
  CHECK(value_at_cut(c, triangle, 0, TriangleId{0}, 2)[0] == 'a');
}

// As 6 b, with the attributes of v_u numbered the other way round in the input.
TEST_CASE("9: attributes are in the order of their smooth regions, whatever their numbers") {
  for (const char* at_u : {"ccgg", "ggcc"}) {
    const char of_u[5] = {at_u[0], at_u[1], at_u[2], at_u[3], 0};
    const HierarchyCase c = contracted(patch("aaee", of_u));
    const SplitId s = c.maps.split_of_contraction[0];
    CHECK(!has_crossing(corner_subgraph(c.hierarchy, 0, s)));
    CHECK(symbols(c, 0).starts_with("Ma Me / M"));
  }
}

TEST_CASE("10: a Moebius strip with a crease has subgraphs that no order untangles") {
  std::size_t explicit_count = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const HierarchyCase c = random_case(moebius_strip(12), {.seed = seed, .derive_share = 0});
    REQUIRE(check_hierarchy(c.hierarchy).ok());
    for (std::size_t l = 0; l < c.hierarchy.layers.size(); ++l) {
      for (std::uint32_t s = 0; s < c.hierarchy.vertices.split_count(); ++s) {
        if (checked_code(c, l, SplitId{s}).is_explicit) ++explicit_count;
      }
    }
  }
  CHECK(explicit_count > 0);
}

}  // namespace
}  // namespace crease
