#include "hierarchy/attribute_links.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <span>

namespace crease {

bool AttributeLinks::are_linked(SplitId s, WedgeId a, WedgeId b) {
  if (linked_split_ != s) link_all(s);
  const VertexHierarchy& h = hierarchy_.vertices;
  return root(member(s, h.goes_to_second(s, a), a)) == root(member(s, h.goes_to_second(s, b), b));
}

void AttributeLinks::link_all(SplitId s) {
  const AttributeHierarchy& layer = hierarchy_.layers[number_];
  const VertexHierarchy& h = hierarchy_.vertices;
  linked_split_ = s;
  first_count_ = layer.attribute_count(h.first_child(s));
  linked_to_.resize(first_count_ + layer.attribute_count(h.second_child(s)));
  std::iota(linked_to_.begin(), linked_to_.end(), 0u);
  link_corners(s);
  link_equal_values(s);
}

void AttributeLinks::link_corners(SplitId s) {
  const VertexHierarchy& h = hierarchy_.vertices;
  const TriangleRange born = h.triangles_of(s);
  for (std::uint32_t t = born.begin; t < born.end; ++t) {
    std::uint32_t ends[2] = {0, 0};
    for (const WedgeId wedge : h.triangles[t]) {
      for (const bool second : {false, true}) {
        if (is_under(h.child(s, second), wedge)) ends[second] = member(s, second, wedge);
      }
    }
    linked_to_[root(ends[0])] = root(ends[1]);
  }
}

void AttributeLinks::link_equal_values(SplitId s) {
  const auto value = [&](std::uint32_t m) {
    const bool second = m >= first_count_;
    return hierarchy_.value(number_, hierarchy_.vertices.child(s, second),
                            static_cast<RelativeAttribute>(second ? m - first_count_ : m));
  };
  const auto compare = [&](std::uint32_t a, std::uint32_t b) {
    const StoredValue of_a = value(a), of_b = value(b);
    return std::memcmp(of_a.begin(), of_b.begin(), of_a.size() * sizeof(float));
  };
  by_value_.resize(linked_to_.size());
  std::iota(by_value_.begin(), by_value_.end(), 0u);
  std::sort(by_value_.begin(), by_value_.end(),
            [&](std::uint32_t a, std::uint32_t b) { return compare(a, b) < 0; });
  for (std::size_t i = 1; i < by_value_.size(); ++i) {
    const std::uint32_t a = by_value_[i - 1], b = by_value_[i];
    if (compare(a, b) == 0) linked_to_[root(a)] = root(b);
  }
}

bool AttributeLinks::is_under(NodeId n, WedgeId wedge) const {
  const WedgeRange& under = ranges_[index_of(n)];
  return index_of(wedge) >= under.begin && index_of(wedge) < under.end;
}

std::uint32_t AttributeLinks::member(SplitId s, bool second, WedgeId wedge) const {
  const NodeId child = hierarchy_.vertices.child(s, second);
  return hierarchy_.attribute_at(number_, child, wedge) + (second ? first_count_ : 0);
}

std::uint32_t AttributeLinks::root(std::uint32_t m) {
  while (linked_to_[m] != m) m = linked_to_[m] = linked_to_[linked_to_[m]];
  return m;
}

}  // namespace crease
