// Rounding, and the walks up and down.
#include "crease/mesh_hierarchy.h"

#include "base/assert.h"
#include "hierarchy/grid_sum.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace crease {

RoundedUp RoundedUp::from(float value) {
  CREASE_ASSERT(value >= 0);
  constexpr std::uint32_t kCut = 15;  // the sign is 0
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
  return {static_cast<std::uint16_t>((bits + ((1u << kCut) - 1)) >> kCut)};
}

float RoundedUp::value() const {
  return std::bit_cast<float>(std::uint32_t(bits) << 15);
}

namespace {

constexpr float kAxisSteps = 127;
constexpr float kAngleSteps = 255;

float sign_of(float f) {
  return f < 0 ? -1.0f : 1.0f;
}

Vec3f unpack_axis(const std::array<std::int8_t, 2>& packed) {
  float x = packed[0] / kAxisSteps, y = packed[1] / kAxisSteps;
  const float z = 1 - std::fabs(x) - std::fabs(y);
  if (z < 0) {
    const float folded = (1 - std::fabs(y)) * sign_of(x);
    y = (1 - std::fabs(x)) * sign_of(y);
    x = folded;
  }
  return normalized(Vec3f{x, y, z});
}

std::array<std::int8_t, 2> pack_axis(const Vec3f& axis) {
  const float sum = std::fabs(axis.x) + std::fabs(axis.y) + std::fabs(axis.z);
  float x = axis.x / sum, y = axis.y / sum;
  if (axis.z < 0) {
    const float folded = (1 - std::fabs(y)) * sign_of(x);
    y = (1 - std::fabs(x)) * sign_of(y);
    x = folded;
  }
  return {static_cast<std::int8_t>(std::lround(x * kAxisSteps)),
          static_cast<std::int8_t>(std::lround(y * kAxisSteps))};
}

}  // namespace

NormalCone SplitBounds::cone() const {
  return {unpack_axis(cone_axis), cone_angle * float(kPi) / kAngleSteps};
}

void SplitBounds::set_cone(const NormalCone& cone) {
  cone_axis = {};
  cone_angle = 255;
  if (!(cone.half_angle_rad >= 0) || cone.axis == Vec3f{}) return;
  cone_axis = pack_axis(cone.axis);
  const Vec3f axis = unpack_axis(cone_axis);
  const float off = std::atan2(length(cross(axis, cone.axis)), dot(axis, cone.axis));
  constexpr float kRounding = 1e-5f;  // of the floats here
  const float steps = (cone.half_angle_rad + off + kRounding) * (kAngleSteps / float(kPi));
  cone_angle = static_cast<std::uint8_t>(std::min(255.0f, std::ceil(steps)));
}

Vec3i VertexHierarchy::position_of(NodeId n) const {
  Vec3i delta{};
  for (; !is_root(n); n = parent(n)) delta = grid_sum(delta, delta_of(n));
  return grid_sum(root_positions[index_of(n)], delta);
}

RelativeAttribute MeshHierarchy::above(std::size_t layer, SplitId s, bool second,
                                       RelativeAttribute a, WedgeId) const {
  const AttributeHierarchy& attributes = layers[layer];
  const std::span<const RelativeAttribute> parents = attributes.parents_of_split.of(index_of(s));
  if (parents.empty()) return 0;
  return parents[second ? attributes.attribute_count(vertices.first_child(s)) + a : a];
}

RelativeAttribute MeshHierarchy::below(std::size_t layer, SplitId s, bool second,
                                       RelativeAttribute a, WedgeId wedge) const {
  const AttributeHierarchy& attributes = layers[layer];
  std::span<const RelativeAttribute> parents = attributes.parents_of_split.of(index_of(s));
  if (parents.empty()) return 0;
  const std::uint32_t of_first = attributes.attribute_count(vertices.first_child(s));
  parents = second ? parents.subspan(of_first) : parents.first(of_first);
  const auto found = std::find(parents.begin(), parents.end(), a);
  if (found == parents.end()) return 0;  // no corner with it stands there
  if (std::find(found + 1, parents.end(), a) == parents.end()) {
    return static_cast<RelativeAttribute>(found - parents.begin());
  }
  const std::span<const BranchRun> runs = attributes.branches_of_split.of(index_of(s));
  const auto after =
      std::upper_bound(runs.begin(), runs.end(), wedge,
                       [](WedgeId w, const BranchRun& run) { return w < run.first_wedge; });
  return after == runs.begin() ? RelativeAttribute{0} : (after - 1)->at_child;
}

RelativeAttribute MeshHierarchy::attribute_at(std::size_t layer, NodeId n, WedgeId wedge) const {
  const AttributeHierarchy& attributes = layers[layer];
  NodeId at = n;
  SplitId s = kNoSplit;
  while (attributes.attribute_count(at) > 1 && (s = vertices.split_of(at)) != kNoSplit) {
    at = vertices.child(s, vertices.goes_to_second(s, wedge));
  }
  RelativeAttribute a = 0;
  if (attributes.attribute_count(at) > 1 && !attributes.leaf_attribute.empty()) {
    a = attributes.leaf_attribute[index_of(wedge)];
  }
  for (; at != n; at = vertices.parent(at)) {
    a = above(layer, vertices.split_above(at), vertices.is_second(at), a, wedge);
  }
  return a;
}

namespace {

template <typename T>
std::size_t bytes_of(const std::vector<T>& items) {
  return sizeof(T) * items.size();
}

}  // namespace

HierarchyBytes hierarchy_bytes(const MeshHierarchy& hierarchy) {
  const VertexHierarchy& v = hierarchy.vertices;
  HierarchyBytes bytes;
  bytes.triangles = bytes_of(v.triangles) + v.triangle_ranges.bytes() +
                    bytes_of(v.material_of_triangle) + bytes_of(v.part_of_triangle) +
                    v.derived_of_split.bytes() + v.is_derived.bytes() + bytes_of(v.deriving_splits);
  bytes.positions =
      bytes_of(v.root_positions) + bytes_of(v.deltas) + v.is_wide.bytes() + bytes_of(v.wide_deltas);
  bytes.splits = v.is_split.bytes() + bytes_of(v.node_of_split) + bytes_of(v.second_wedge) +
                 bytes_of(v.bounds);
  for (const AttributeHierarchy& layer : hierarchy.layers) {
    bytes.values += bytes_of(layer.values) + bytes_of(layer.value_of_attribute);
    bytes.attributes += layer.attribute_ranges.bytes() + bytes_of(layer.leaf_attribute) +
                        layer.parents_of_split.bytes() + layer.branches_of_split.bytes();
  }
  return bytes;
}

}  // namespace crease
