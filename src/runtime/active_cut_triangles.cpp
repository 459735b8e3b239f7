// What kind active triangles are, and where they are kept.
#include "hierarchy/geometric_normal.h"
#include "runtime/active_cut.h"

#include <algorithm>

namespace crease {

Part ActiveCut::kind_of(bool is_derived, std::span<const std::uint32_t, 3> slots,
                        std::span<std::uint32_t> values) const {
  if (normal_layer_ == kNone) return kFnPart;
  if (is_derived) {
    const Vec3f n = geometric_normal(vertices_[slots[0]].position, vertices_[slots[1]].position,
                                     vertices_[slots[2]].position);
    if (n != Vec3f{}) return kFnPart;
  }
  // A derived one without area shows what it stores, for as long as its corners stay: no SN.
  bool one_each = true;
  for (const std::uint32_t slot : slots) one_each &= vertices_[slot].has_one_normal();
  if (!is_derived && one_each) return kSnPart;
  const std::uint32_t place = place_of_layer_[normal_layer_];
  std::uint32_t at[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const ActiveVertex& v = vertices_[slots[k]];
    if (place == kNone) {
      at[k] = v.normal;
      continue;
    }
    std::uint32_t& value = values[k * tracked_.size() + place];
    // Not stored only where it changes, which nobody can foretell.
    const std::uint32_t keeps = v.has_one_normal() ? 0 : ~std::uint32_t(0);
    value = at[k] = (v.normal & ~keeps) | (value & keeps);
  }
  return at[0] == at[1] && at[1] == at[2] ? kFnPart : kNsnPart;
}

Part ActiveCut::sort(ActiveTriangles& part, std::uint32_t triangle) const {
  const std::size_t each = 3 * tracked_.size();
  return kind_of(part.is_derived[triangle] != 0,
                 std::span<const std::uint32_t, 3>(&part.slots[3 * std::size_t(triangle)], 3),
                 std::span<std::uint32_t>(part.values).subspan(each * triangle, each));
}

std::size_t ActiveCut::value_index(const ActiveTriangles& part, std::uint32_t corner_index,
                                   std::size_t layer) const {
  const std::uint32_t place = place_of_layer_[layer];
  const std::uint32_t slot = part.slots[corner_index];
  if (place != kNone) {
    return value_of(place, slot, part.values[tracked_.size() * corner_index + place]);
  }
  if (layer == normal_layer_) return vertices_[slot].normal;
  const AttributeHierarchy& source = hierarchy_.layers[layer];
  return source.own_value(source.attribute_ranges.begin(index_of(vertices_[slot].node)));
}

SplitId ActiveCut::introducing_split(TriangleId t) const {
  std::size_t low = 0, high = h_.triangle_ranges.size();  // begin(low) <= t < begin(high)
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (h_.triangle_ranges.begin(middle) <= index_of(t) ? low : high) = middle;
  }
  return low == 0 ? kNoSplit : SplitId{static_cast<std::uint32_t>(low - 1)};
}

void ActiveCut::replace_corner(CornerRef from, CornerRef to) {
  lists_.replace(vertices_[parts_[from.part()].slots[from.index()]].corners, from, to);
}

void ActiveCut::copy_triangle(Part from, std::uint32_t source, Part to, std::uint32_t target) {
  for (std::uint32_t k = 0; k < 3; ++k) {
    replace_corner(CornerRef(from, source, k), CornerRef(to, target, k));
  }
  const ActiveTriangles& old = parts_[from];
  ActiveTriangles& part = parts_[to];
  for (std::size_t k = 0; k < 3; ++k) {
    part.slots[3 * std::size_t(target) + k] = old.slots[3 * std::size_t(source) + k];
  }
  const std::size_t each = 3 * tracked_.size();
  for (std::size_t i = 0; i < each; ++i) {
    part.values[each * target + i] = old.values[each * source + i];
  }
  part.is_derived[target] = old.is_derived[source];
  part.moved.mark(target);
  part.shaded.mark(target);
}

void ActiveCut::move_triangle(Part from, std::uint32_t triangle, Part to) {
  const std::uint32_t target = parts_[to].add(parts_[from].ids[triangle], 3 * tracked_.size());
  copy_triangle(from, triangle, to, target);
  parts_[from].remove(triangle);
}

void ActiveCut::fill_holes() {
  for (const Part p : {kSnPart, kFnPart, kNsnPart}) {
    ActiveTriangles& part = parts_[p];
    while (part.hole_count > 0) {
      while (!part.ids.empty() && part.ids.back() == kNoTriangle) {
        part.ids.pop_back();
        --part.hole_count;
      }
      if (part.hole_count == 0) break;
      const std::uint32_t hole = part.holes.back();
      part.holes.pop_back();
      if (hole >= part.ids.size() || part.ids[hole] != kNoTriangle) continue;
      const auto last = static_cast<std::uint32_t>(part.ids.size() - 1);
      if (last >= 4 && part.ids[last - 4] != kNoTriangle) prefetch_vertices_of(part, last - 4);
      copy_triangle(p, last, p, hole);
      part.ids[hole] = part.ids[last];
      part.ids.pop_back();
      --part.hole_count;
    }
    part.holes.clear();
    part.slots.resize(3 * part.ids.size());
    part.values.resize(3 * tracked_.size() * part.ids.size());
    part.is_derived.resize(part.ids.size());
  }
}

void ActiveCut::hide_or_show(TriangleId t) {
  const std::array<WedgeId, 3> wedges = h_.triangles[index_of(t)];
  std::array<std::uint32_t, 3> slots;
  for (std::size_t k = 0; k < 3; ++k) slots[k] = map_.slot_at(wedges[k]);
  if (slots[0] == slots[1] || slots[1] == slots[2] || slots[2] == slots[0]) return;
  for (const CornerAt& at : lists_.of(vertices_[slots[0]].corners)) {
    const Part part = static_cast<Part>(at.corner.part());
    const std::uint32_t place = at.corner.triangle();
    if (at.wedge != wedges[0] || parts_[part].ids[place] != t) continue;
    if (!is_hidden(t)) return;
    for (std::uint32_t k = 0; k < 3; ++k) {
      lists_.erase(vertices_[slots[k]].corners, CornerRef(part, place, k));
    }
    return parts_[part].remove(place);
  }
  if (!is_hidden(t)) activate(t, wedges, slots);
}

std::size_t ActiveCut::bytes() const {
  std::size_t sum = 8 * done_.capacity() + map_.bytes() + lists_.bytes() +
                    sizeof(ActiveVertex) * vertices_.capacity() + 4 * free_slots_.capacity() +
                    4 * (following_of_slot_.capacity() + to_of_slot_.capacity()) +
                    sizeof(Following) * (following_.capacity() + left_.capacity()) +
                    4 * moves_.capacity() + sizeof(Born) * born_.capacity();
  for (const AttributeOrder& order : orders_) sum += order.bytes();
  for (const ActiveTriangles& part : parts_) {
    sum += 4 * (part.ids.capacity() + part.slots.capacity() + part.holes.capacity() +
                part.materials.capacity() + part.values.capacity()) +
           part.is_derived.capacity() + 12 * part.normals.capacity() + 16 * part.colors.capacity() +
           8 * part.texcoords.capacity();
  }
  return sum;
}

}  // namespace crease
