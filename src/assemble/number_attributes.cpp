#include "assemble/number_attributes.h"

#include <algorithm>
#include <span>
#include <utility>

namespace crease {

namespace {

// An index an attribute where values repeat, or a value each, whichever is smaller. Returns, where
// there are indices, the value of each id.
std::vector<std::uint32_t> store_values(const std::vector<AttributeId>& ids,
                                        const RuledValues& values, AttributeHierarchy& result) {
  std::uint32_t id_count = 0;
  for (AttributeId id : ids) {
    id_count = std::max(id_count, static_cast<std::uint32_t>(index_of(id)) + 1);
  }
  std::vector<std::uint32_t> value_of_id(id_count, kNone);  // in the order of first use
  std::vector<float> numbers;
  std::uint32_t used = 0;
  for (AttributeId id : ids) {
    std::uint32_t& value = value_of_id[index_of(id)];
    if (value != kNone) continue;
    value = used++;
    const std::span<const float> floats = values.value(id);
    numbers.insert(numbers.end(), floats.begin(), floats.end());
  }
  result.values = StoredValues(std::move(numbers), result.dimension);
  if (result.interpolation == Interpolation::Direction) result.values.pack_directions();

  std::vector<std::uint32_t> value_of_attribute;
  value_of_attribute.reserve(ids.size());
  for (AttributeId id : ids) value_of_attribute.push_back(value_of_id[index_of(id)]);
  const std::size_t bits = bits_for(used);
  if (result.values.bytes() + ids.size() * bits / 8 >=
      ids.size() * result.values.bytes_per_value()) {
    result.values = result.values.chosen(value_of_attribute);
    return {};
  }
  result.value_of_attribute = PackedIndices<>(bits_for(used));
  for (std::uint32_t value : value_of_attribute) result.value_of_attribute.push_back(value);
  return value_of_id;
}

bool has_several(const AttributeHierarchy& layer) {
  return !layer.leaf_attribute.empty() || layer.parents_of_split.list_count() > 0;
}

// What needs no attribute to be followed.
void note_constants(const AttributeInput& input, std::size_t layer, const GrownAttributes& grown,
                    const std::vector<std::uint32_t>& value_of_id, AttributeHierarchy& result) {
  const LeafAttributes& leaves = input.wedges.layers[layer];
  result.constant_of_wedge = PackedIndices<>(bits_for(result.values.size() + 1));
  for (std::size_t w = 0; w < leaves.of_wedge.size(); ++w) {
    const AttributeId id = leaves.attributes[leaves.of_wedge[w]].id;
    result.constant_of_wedge.push_back(grown.varies_of_wedge[w] ? 0
                                                                : value_of_id[index_of(id)] + 1);
  }
  for (std::uint32_t i : input.forest.contraction_of_split) {
    const std::uint32_t first = grown.at_birth[input.forest.leaf_count + i].first;
    const Slice parents = grown.parents_at[i];
    std::uint32_t member = parents.first;
    bool keeps = true;
    for (std::uint32_t child : input.forest.children[i]) {
      const Slice at_child = grown.at_birth[child];
      for (std::uint32_t k = 0; parents.count > 0 && k < at_child.count; ++k, ++member) {
        const RelativeAttribute parent = grown.parents[member];
        if (parent == kRemoved) continue;
        keeps &= grown.at_node[at_child.first + k].id == grown.at_node[first + parent].id;
      }
    }
    result.keeps_values.append(keeps ? 1 : 0, 1);
  }
}

// Of the attributes of leaves that have several: then wedges tell them apart by their order.
bool each_has_one_wedge(const LeafAttributes& leaves,
                        const std::vector<RelativeAttribute>& relative) {
  std::vector<std::uint32_t> wedge_count(leaves.attributes.size(), 0);
  for (std::uint32_t attribute : leaves.of_wedge) ++wedge_count[attribute];
  for (std::size_t v = 0; v + 1 < leaves.first_of_vertex.size(); ++v) {
    const std::uint32_t first = leaves.first_of_vertex[v], end = leaves.first_of_vertex[v + 1];
    for (std::uint32_t a = first; a < end; ++a) {
      if (end - first > 1 && wedge_count[a] != 1) return false;
    }
  }
  // Another layer may have ordered them.
  for (std::size_t w = 0; w < leaves.of_wedge.size(); ++w) {
    const std::uint32_t a = leaves.of_wedge[w];
    if (relative[a] > 0 && (w == 0 || leaves.of_wedge[w - 1] + 1 != a)) return false;
  }
  return true;
}

void store_leaves(const LeafAttributes& leaves, AttributeHierarchy& result) {
  std::vector<RelativeAttribute> relative;
  for (std::size_t v = 0; v + 1 < leaves.first_of_vertex.size(); ++v) {
    const std::uint32_t first = leaves.first_of_vertex[v], end = leaves.first_of_vertex[v + 1];
    for (std::uint32_t a = first; a < end; ++a) {
      relative.push_back(static_cast<RelativeAttribute>(a - first));
    }
  }
  const auto most = std::max_element(relative.begin(), relative.end());
  if (most == relative.end() || *most == 0) return;
  if (result.parents_of_split.list_count() > 0 && each_has_one_wedge(leaves, relative)) return;
  result.leaf_attribute = PackedIndices<RelativeAttribute>(bits_for(*most + std::size_t(1)));
  for (std::uint32_t attribute : leaves.of_wedge) {
    result.leaf_attribute.push_back(relative[attribute]);
  }
}

}  // namespace

AttributeHierarchy number_attributes(const AttributeInput& input, std::size_t layer,
                                     const RuledValues& values, const GrownAttributes& grown) {
  AttributeHierarchy result;
  const AttributeLayer& source = values.source();
  result.name = source.name;
  result.role = source.role;
  result.interpolation = source.interpolation;
  result.dimension = source.dimension;

  std::vector<AttributeId> ids;
  for (std::uint32_t birth : input.forest.birth_of_node) {
    const Slice slice = grown.at_birth[birth];
    result.attribute_ranges.push_back(slice.count);
    for (std::uint32_t k = 0; k < slice.count; ++k)
      ids.push_back(grown.at_node[slice.first + k].id);
  }
  const std::vector<std::uint32_t> value_of_id = store_values(ids, values, result);
  for (std::uint32_t i : input.forest.contraction_of_split) {
    const auto part = [](const auto& items, Slice s) {
      return std::span(items).subspan(s.first, s.count);
    };
    result.parents_of_split.push_back(part(grown.parents, grown.parents_at[i]));
    result.branches_of_split.push_back(part(grown.branches, grown.branches_at[i]));
  }
  store_leaves(input.wedges.layers[layer], result);
  // Where most wedges vary, as along the creases of a machine, it would not pay.
  const auto varying = std::count(grown.varies_of_wedge.begin(), grown.varies_of_wedge.end(), true);
  const bool most_stay = 2 * static_cast<std::size_t>(varying) <= grown.varies_of_wedge.size();
  if (!value_of_id.empty() && has_several(result) && most_stay) {
    note_constants(input, layer, grown, value_of_id, result);
  }
  return result;
}

}  // namespace crease
