#include "assemble/inherit_values.h"

#include <utility>

namespace crease {

void inherit_values(const VertexHierarchy& vertices, AttributeHierarchy& layer) {
  if (layer.keeps_values.empty()) return;
  const auto keeps = [&layer](SplitId s) { return layer.keeps_values.test(index_of(s)); };
  RankedBits has_value;
  PackedIndices<> values(layer.value_of_attribute.bits());
  for (std::uint32_t n = 0; n < vertices.node_count(); ++n) {
    const NodeId node{n};
    const CompactRanges::Range range = layer.attribute_ranges.range(n);
    const SplitId below = vertices.split_of(node);
    bool inherits = range.end - range.begin > 1 && !vertices.is_root(node) &&
                    keeps(vertices.split_above(node)) && (below == kNoSplit || keeps(below));
    ParentMaps::Map parents;
    if (inherits) parents = layer.parents_of_split.of(index_of(vertices.split_above(node)));
    inherits = inherits && !parents.empty();
    const std::size_t first =
        inherits && vertices.is_second(node) ? parents.size() - (range.end - range.begin) : 0;
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
      const bool has = !inherits || parents[first + i - range.begin] == kRemoved;
      has_value.push_back(has);
      if (has) values.push_back(layer.value_of_attribute[i]);
    }
  }
  if (values.bytes() + has_value.bytes() >= layer.value_of_attribute.bytes()) return;
  layer.value_of_attribute = std::move(values);
  layer.has_value = std::move(has_value);
}

}  // namespace crease
