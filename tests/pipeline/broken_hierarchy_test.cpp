// Every invariant of a hierarchy, broken on purpose: the checks must say which one it is.
#include "pipeline/hierarchy_case.h"
#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace crease {
namespace {

// The arrays of a hierarchy are written once, front to back: to change them is to write them anew.
template <typename Index>
void set(PackedIndices<Index>& all, std::size_t i, Index value) {
  PackedIndices<Index> changed(32);
  for (std::size_t k = 0; k < all.size(); ++k) changed.push_back(k == i ? value : all[k]);
  all = changed;
}

template <typename Index>
void swap(PackedIndices<Index>& all, std::size_t i, std::size_t k) {
  const Index at_i = all[i];
  set(all, i, all[k]);
  set(all, k, at_i);
}

// Of the values, whose numbers `harm` changes.
template <typename Harm>
void change_numbers(AttributeHierarchy& layer, Harm harm) {
  std::vector<float> numbers;
  for (std::size_t i = 0; i < layer.values.size(); ++i) {
    const StoredValue value = layer.values[i];
    numbers.insert(numbers.end(), value.begin(), value.end());
  }
  harm(numbers);
  layer.values = StoredValues(std::move(numbers), layer.values.dimension());
}

using ParentMap = std::vector<RelativeAttribute>;

ParentMap parents_of(const AttributeHierarchy& layer, std::size_t split) {
  const ParentMaps::Map map = layer.parents_of_split.of(split);
  ParentMap parents;
  for (std::size_t i = 0; i < map.size(); ++i) parents.push_back(map[i]);
  return parents;
}

void set_parents(AttributeHierarchy& layer, std::size_t split, const ParentMap& parents) {
  ParentMaps changed;
  for (std::size_t s = 0; s < layer.parents_of_split.size(); ++s) {
    changed.push_back(s == split ? parents : parents_of(layer, s));
  }
  layer.parents_of_split = changed;
}

// The first split whose v_s has several attributes of layer 0.
std::size_t rich_split(const MeshHierarchy& h) {
  for (std::uint32_t s = 0;; ++s) {
    REQUIRE(s < h.vertices.split_count());
    if (h.layers[0].attribute_count(h.vertices.node_of_split[s]) > 1) return s;
  }
}

struct Harm {
  const char* what;  // the check's words
  std::function<void(MeshHierarchy&)> harm;
};

void check_named(const Harm& harm, const MeshHierarchy& sound) {
  CAPTURE(harm.what);
  MeshHierarchy hierarchy = sound;
  harm.harm(hierarchy);
  const Status status = check_hierarchy(hierarchy);
  REQUIRE(!status.ok());
  CHECK_MESSAGE(status.failure().message.find(harm.what) != std::string::npos,
                status.failure().message);
}

// A model with materials, parts, normals that are derived, and several attributes at most vertices.
HierarchyCase rich_case() {
  return random_case(random_complex(3, 30, 90), {.seed = 3, .change_share = 0});
}

TEST_CASE("a hierarchy whose vertices are broken is refused, with the reason") {
  const HierarchyCase c = rich_case();
  REQUIRE(check_hierarchy(c.hierarchy).ok());
  const Harm harms[] = {
      {"add up", [](MeshHierarchy& h) { ++h.vertices.root_count; }},
      {"lacks its position or wedges", [](MeshHierarchy& h) { h.vertices.root_positions = {}; }},
      {"an array of splits", [](MeshHierarchy& h) { h.vertices.bounds.pop_back(); }},
      {"lacks its position", [](MeshHierarchy& h) { h.vertices.wide_deltas.push_back({}); }},
      {"an array of triangles", [](MeshHierarchy& h) { h.vertices.deriving_splits.push_back({}); }},
      {"not above its children",
       [](MeshHierarchy& h) {
         set(h.vertices.node_of_split, 1, NodeId(std::uint32_t(h.vertices.node_count() - 1)));
       }},
      {"has another split",
       [](MeshHierarchy& h) {
         const VertexHierarchy& v = h.vertices;
         std::uint32_t s = 0;
         while (v.node_of_split[s + 1] >= v.first_child(SplitId{s})) ++s;
         swap(h.vertices.node_of_split, s, s + 1);
       }},
      {"do not ascend from 0", [](MeshHierarchy& h) { h.vertices.root_wedges[0] = WedgeId{1}; }},
      {"wedges of v_u",
       [](MeshHierarchy& h) {
         set(h.vertices.second_wedge, 0, WedgeId(std::uint32_t(h.vertices.wedge_count() + 1)));
       }},
      {"material out of range",
       [](MeshHierarchy& h) {
         set(h.vertices.material_of_triangle, 2, MaterialId(std::uint32_t(h.materials.size())));
       }},
      {"part out of range",
       [](MeshHierarchy& h) {
         set(h.vertices.part_of_triangle, 2, PartId(std::uint32_t(h.parts.size())));
       }},
      {"wedge out of range",
       [](MeshHierarchy& h) {
         set(h.vertices.triangles.of_corner, 4, WedgeId(std::uint32_t(h.vertices.wedge_count())));
       }},
      {"two corners at one leaf",
       [](MeshHierarchy& h) {
         set(h.vertices.triangles.of_corner, 4, h.vertices.triangles.of_corner[3]);
       }},
      {"not introduced where it collapses",
       [](MeshHierarchy& h) {
         const std::size_t last = h.vertices.triangles.size() - 1;
         for (std::size_t k = 0; k < 3; ++k) {
           swap(h.vertices.triangles.of_corner, k, 3 * last + k);
         }
       }},
      {"names another split",
       [](MeshHierarchy& h) {
         SplitId& s = h.vertices.deriving_splits[0];
         s = s == SplitId{0} ? SplitId{1} : SplitId{0};
       }},
      {"not in its split's list",
       [](MeshHierarchy& h) {
         SparseLists<TriangleId> none;
         for (std::size_t s = 0; s < h.vertices.split_count(); ++s) none.push_back({});
         h.vertices.derived_of_split = none;
       }},
      {"error is less", [](MeshHierarchy& h) { h.vertices.bounds[0].line = {}; }},
      {"sphere", [](MeshHierarchy& h) { h.vertices.bounds[0].radius = {}; }},
      {"cone", [](MeshHierarchy& h) { h.vertices.bounds[0].cone_angle = 1; }},
  };
  for (const Harm& harm : harms) check_named(harm, c.hierarchy);
}

TEST_CASE("a hierarchy whose attributes are broken is refused, with the reason") {
  const HierarchyCase c = rich_case();
  REQUIRE(check_hierarchy(c.hierarchy).ok());
  const Harm harms[] = {
      {"its dimension", [](MeshHierarchy& h) { h.layers[0].dimension = 5; }},
      {"a node lacks its range",
       [](MeshHierarchy& h) { h.layers[0].attribute_ranges = CompactRanges(); }},
      {"a split lacks its parent map", [](MeshHierarchy& h) { h.layers[0].parents_of_split = {}; }},
      {"not finite",
       [](MeshHierarchy& h) {
         change_numbers(h.layers[0], [](auto& numbers) { numbers[0] = std::nanf(""); });
       }},
      {"not of its dimension",
       [](MeshHierarchy& h) {
         h.layers[0].values = {{}, 2};
       }},
      {"an attribute lacks its value",
       [](MeshHierarchy& h) {
         AttributeHierarchy& layer = h.layers[0];
         layer.value_of_attribute = {};
         layer.values = {std::vector<float>(layer.dimension *
                                            (layer.attribute_ranges.total() + std::size_t(1))),
                         layer.dimension};
       }},
      {"value out of range",
       [](MeshHierarchy& h) {
         AttributeHierarchy& layer = h.layers[0];
         layer.has_value = {};
         PackedIndices<> indices(32);
         for (std::size_t i = 0; i < layer.attribute_ranges.total(); ++i) {
           indices.push_back(std::uint32_t(layer.values.size()));
         }
         layer.value_of_attribute = indices;
       }},
      {"a wedge lacks its attribute",
       [](MeshHierarchy& h) { h.layers[0].leaf_attribute.push_back({}); }},
      {"no parent map",
       [](MeshHierarchy& h) { set_parents(h.layers[0], rich_split(h), ParentMap()); }},
      {"a wrong parent map",
       [](MeshHierarchy& h) {
         ParentMap parents = parents_of(h.layers[0], rich_split(h));
         parents[0] = 1000;
         set_parents(h.layers[0], rich_split(h), parents);
       }},
      {"a wrong parent map",
       [](MeshHierarchy& h) {
         ParentMap parents = parents_of(h.layers[0], rich_split(h));
         parents.push_back(0);
         set_parents(h.layers[0], rich_split(h), parents);
       }},
      {"a wrong branch code",
       [](MeshHierarchy& h) {
         SparseLists<BranchRun> changed;
         bool done = false;
         for (std::size_t s = 0; s < h.vertices.split_count(); ++s) {
           const auto runs = h.layers[0].branches_of_split.of(s);
           std::vector<BranchRun> copy(runs.begin(), runs.end());
           if (!copy.empty() && !done) copy[0].at_child = 1000;
           done = done || !copy.empty();
           changed.push_back(copy);
         }
         REQUIRE(done);
         h.layers[0].branches_of_split = changed;
       }},
      {"the way down is not the way up",
       [](MeshHierarchy& h) {
         SparseLists<BranchRun> none;
         for (std::size_t s = 0; s < h.vertices.split_count(); ++s) none.push_back({});
         h.layers[0].branches_of_split = none;
       }},
      {"an attribute is missing",
       [](MeshHierarchy& h) {
         PackedIndices<RelativeAttribute> far(16);
         for (std::size_t w = 0; w < h.vertices.wedge_count(); ++w) far.push_back(1000);
         h.layers[0].leaf_attribute = far;
       }},
      {"a live attribute is removed",
       [](MeshHierarchy& h) {
         ParentMap parents = parents_of(h.layers[0], rich_split(h));
         for (RelativeAttribute& p : parents) p = kRemoved;
         set_parents(h.layers[0], rich_split(h), parents);
       }},
      {"no cut can show",
       [](MeshHierarchy& h) {
         AttributeHierarchy& layer = h.layers[0];
         // One more at the last leaf, and its place in the map above it.
         CompactRanges ranges(1);
         const std::size_t last = h.vertices.node_count() - 1;
         for (std::size_t n = 0; n <= last; ++n) {
           ranges.push_back(layer.attribute_ranges.count(n) + (n == last ? 1 : 0));
         }
         if (layer.value_of_attribute.empty()) {
           change_numbers(layer, [&](auto& numbers) {
             numbers.resize(numbers.size() + layer.dimension, 1.0f);
           });
         } else {
           layer.value_of_attribute.push_back(0);
           if (layer.has_value.size() != 0) layer.has_value.push_back(true);
         }
         const std::size_t split = index_of(h.vertices.split_above(NodeId(std::uint32_t(last))));
         ParentMap parents = parents_of(layer, split);
         if (parents.empty())
           parents.assign(layer.attribute_count(NodeId(std::uint32_t(last - 1))) +
                              layer.attribute_count(NodeId(std::uint32_t(last))),
                          0);
         parents.push_back(kRemoved);
         layer.attribute_ranges = ranges;
         set_parents(layer, split, parents);
       }},
  };
  for (const Harm& harm : harms) check_named(harm, c.hierarchy);
}

// Walls keep their normals, whatever becomes of their corners.
HierarchyCase city_case() {
  return simplified_case(city_blocks(6, 2));
}

TEST_CASE("a hierarchy that is wrong about values that stay is refused, with the reason") {
  const HierarchyCase c = city_case();
  REQUIRE(check_hierarchy(c.hierarchy).ok());
  REQUIRE(c.hierarchy.layers[0].has_value.size() != 0);
  const Harm harms[] = {
      {"where values stay is not told of all",
       [](MeshHierarchy& h) { h.layers[0].keeps_values.append(1, 1); }},
      {"where values stay is not told of all",
       [](MeshHierarchy& h) { h.layers[0].constant_of_wedge = {}; }},
      {"a constant value changes",
       [](MeshHierarchy& h) {
         auto& constants = h.layers[0].constant_of_wedge;
         set(constants, 0, constants[0] == 1 ? 2u : 1u);
       }},
      {"nowhere to have a value from",
       [](MeshHierarchy& h) {
         AttributeHierarchy& layer = h.layers[0];
         RankedBits none;
         for (std::size_t i = 0; i < layer.has_value.size(); ++i) none.push_back(false);
         layer.has_value = none;
         layer.value_of_attribute = PackedIndices<>(1);
         layer.values = {{}, layer.dimension};
       }},
      {"an attribute lacks its value", [](MeshHierarchy& h) { h.layers[0].has_value = {}; }},
  };
  for (const Harm& harm : harms) check_named(harm, c.hierarchy);
}

// Only some attributes have a value of their own that a split is said to keep.
TEST_CASE("a split that changes a value and says it does not is found") {
  const HierarchyCase c = city_case();
  const PackedIndices<>& values = c.hierarchy.layers[0].value_of_attribute;
  bool found = false;
  for (std::size_t i = 0; i < values.size() && !found; ++i) {
    MeshHierarchy h = c.hierarchy;
    set(h.layers[0].value_of_attribute, i, values[i] == 0 ? 1u : 0u);
    const Status status = check_hierarchy(h);
    REQUIRE(!status.ok());
    found = status.failure().message.find("a value that should stay changes") != std::string::npos;
  }
  CHECK(found);
}

TEST_CASE("leaves that are not the mesh are told from it") {
  const HierarchyCase c = rich_case();
  REQUIRE(check_leaves(c.hierarchy, c.maps, c.mesh).ok());
  struct Case {
    const char* what;
    std::function<void(HierarchyCase&)> harm;
  };
  const Case cases[] = {
      {"number of triangles", [](HierarchyCase& h) { h.maps.new_of_triangle.pop_back(); }},
      {"number of triangles", [](HierarchyCase& h) { h.hierarchy.materials.pop_back(); }},
      {"position", [](HierarchyCase& h) { ++h.hierarchy.vertices.root_positions[0].x; }},
      {"vertex", [](HierarchyCase& h) { swap(h.hierarchy.vertices.triangles.of_corner, 6, 7); }},
      {"material",
       [](HierarchyCase& h) {
         auto& of = h.hierarchy.vertices.material_of_triangle;
         set(of, 5, MaterialId{of[5] == MaterialId{0} ? 1u : 0u});
       }},
      {"part",
       [](HierarchyCase& h) {
         auto& of = h.hierarchy.vertices.part_of_triangle;
         set(of, 5, PartId{of[5] == PartId{0} ? 1u : 0u});
       }},
      {"value of layer",
       [](HierarchyCase& h) {
         change_numbers(h.hierarchy.layers[1], [](auto& numbers) {
           for (float& f : numbers) f += 1;
         });
       }},
      {"sharing of attributes",
       [](HierarchyCase& h) {
         // Two attributes of one vertex in the mesh, with one value.
         AttributeLayer& layer = h.mesh.layers[0];
         const AttributeId id = layer.of_corner[0];
         const std::vector<float> value(layer.value(id).begin(), layer.value(id).end());
         layer.values.insert(layer.values.end(), value.begin(), value.end());
         for (std::size_t k = 0; k < layer.of_corner.size(); ++k) {
           if (layer.of_corner[k] == id && k % 2 == 1) {
             layer.of_corner[k] = AttributeId(std::uint32_t(layer.value_count() - 1));
           }
         }
       }},
      {"no longer share",
       [](HierarchyCase& h) {
         // All normals are one in the mesh, and in the hierarchy of one value but apart.
         AttributeLayer& layer = h.mesh.layers[0];
         layer.values.resize(3);
         for (AttributeId& id : layer.of_corner) id = AttributeId{0};
         AttributeHierarchy& shown = h.hierarchy.layers[0];
         change_numbers(shown, [&](auto& numbers) {
           for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = layer.values[i % 3];
         });
       }},
  };
  for (const Case& broken : cases) {
    CAPTURE(broken.what);
    HierarchyCase h = c;
    broken.harm(h);
    const Status status = check_leaves(h.hierarchy, h.maps, h.mesh);
    REQUIRE(!status.ok());
    CHECK_MESSAGE(status.failure().message.find(broken.what) != std::string::npos,
                  status.failure().message);
  }
}

}  // namespace
}  // namespace crease
