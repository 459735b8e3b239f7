#include "runtime/extract_level.h"

#include "hierarchy/geometric_normal.h"
#include "runtime/layer_like.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <span>
#include <vector>

namespace crease {

namespace {

// Values by their bits, so that an owned value finds its id. Open addressing; the order in the
// table is of no consequence.
class IdOfBits {
 public:
  explicit IdOfBits(std::size_t capacity) : table_(std::bit_ceil(2 * capacity + 1), kNone) {}

  // The id that was noted first for these bits; `fresh` is noted if there is none.
  std::uint32_t find_or_note(const AttributeLayer& layer, std::span<const float> value,
                             std::uint32_t fresh) {
    std::uint64_t hash = 0;
    for (float f : value) {
      hash = (hash ^ std::bit_cast<std::uint32_t>(f)) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 29;
    }
    std::size_t place = hash & (table_.size() - 1);
    while (table_[place] != kNone) {
      const float* other = &layer.values[std::size_t(table_[place]) * layer.dimension];
      if (std::memcmp(other, value.data(), value.size_bytes()) == 0) return table_[place];
      place = (place + 1) & (table_.size() - 1);
    }
    table_[place] = fresh;
    return fresh;
  }

 private:
  std::vector<std::uint32_t> table_;
};

// Makes one layer. `index_of` and `value_of` tell what a corner has, by its number in the arrays.
class LayerMaker {
 public:
  LayerMaker(const LinearState& state, std::span<const std::uint32_t> triangles,
             AttributeLayer& target)
      : state_(state), triangles_(triangles), target_(target) {}

  template <typename IndexOf, typename ValueOf, typename DerivedNormal>
  void run(std::size_t index_count, std::size_t slot_count, IndexOf index_of_corner,
           ValueOf value_of_corner, DerivedNormal derived_normal) {
    target_.of_corner.assign(3 * triangles_.size(), kNoAttribute);
    take_indices(index_count, index_of_corner, value_of_corner, derived_normal);
    take_owned(slot_count, index_of_corner, value_of_corner);
  }

 private:
  std::uint32_t append(std::span<const float> value) {
    const auto id = static_cast<std::uint32_t>(target_.value_count());
    target_.values.insert(target_.values.end(), value.begin(), value.end());
    return id;
  }

  template <typename IndexOf, typename ValueOf, typename DerivedNormal>
  void take_indices(std::size_t index_count, IndexOf index_of_corner, ValueOf value_of_corner,
                    DerivedNormal derived_normal) {
    std::vector<std::uint32_t> id_of_index(index_count, kNone);
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      if (const Vec3f n = derived_normal(triangles_[i]); n != Vec3f{}) {
        const float value[] = {n.x, n.y, n.z};
        const AttributeId id{append(value)};
        std::fill_n(target_.of_corner.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, id);
        continue;
      }
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t c = 3 * triangles_[i] + k;
        const std::uint32_t index = index_of_corner(c);
        if (index == kNone) continue;
        if (id_of_index[index] == kNone) id_of_index[index] = append(value_of_corner(c));
        target_.of_corner[3 * i + k] = AttributeId{id_of_index[index]};
        indexed_.push_back({state_.indices[c], id_of_index[index]});
      }
    }
    std::sort(indexed_.begin(), indexed_.end(), [](const AtSlot& a, const AtSlot& b) {
      return a.slot != b.slot ? a.slot < b.slot : a.id < b.id;
    });
  }

  template <typename IndexOf, typename ValueOf>
  void take_owned(std::size_t slot_count, IndexOf index_of_corner, ValueOf value_of_corner) {
    IdOfBits id_of_bits(target_.value_count() + slot_count);
    for (const AtSlot& at : indexed_) {
      id_of_bits.find_or_note(target_, target_.value(AttributeId{at.id}), at.id);
    }
    std::vector<std::uint32_t> id_of_slot(slot_count, kNone);
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        AttributeId& id = target_.of_corner[3 * i + k];
        const std::uint32_t c = 3 * triangles_[i] + k;
        if (id != kNoAttribute || index_of_corner(c) != kNone) continue;
        std::uint32_t& owned = id_of_slot[state_.indices[c]];
        if (owned == kNone) owned = owned_id(state_.indices[c], value_of_corner(c), id_of_bits);
        id = AttributeId{owned};
      }
    }
  }

  std::uint32_t owned_id(std::uint32_t slot, std::span<const float> value, IdOfBits& id_of_bits) {
    auto at = std::lower_bound(indexed_.begin(), indexed_.end(), slot,
                               [](const AtSlot& a, std::uint32_t s) { return a.slot < s; });
    for (; at != indexed_.end() && at->slot == slot; ++at) {
      const std::span<const float> other = target_.value(AttributeId{at->id});
      if (std::memcmp(other.data(), value.data(), value.size_bytes()) == 0) return at->id;
    }
    const auto fresh = static_cast<std::uint32_t>(target_.value_count());
    const std::uint32_t id = id_of_bits.find_or_note(target_, value, fresh);
    if (id == fresh) append(value);
    return id;
  }

  struct AtSlot {
    std::uint32_t slot, id;
  };

  const LinearState& state_;
  std::span<const std::uint32_t> triangles_;
  AttributeLayer& target_;
  std::vector<AtSlot> indexed_;  // corners that have an index, by slot
};

std::vector<std::uint32_t> active_triangles(const ProgressiveArrays& arrays,
                                            const SectionCounts& active) {
  std::vector<std::uint32_t> triangles;
  triangles.reserve(active.triangles());
  const auto take = [&triangles](std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t t = first; t < first + count; ++t) triangles.push_back(t);
  };
  take(0, active.sn_triangles);
  take(arrays.full.sn_triangles, active.fn_triangles);
  take(arrays.full.sn_triangles + arrays.full.fn_triangles, active.nsn_triangles);
  return triangles;
}

void extract_geometry(const ProgressiveArrays& arrays, const LinearState& state,
                      std::span<const std::uint32_t> triangles, Mesh& mesh) {
  std::vector<std::uint32_t> vertex_of_slot(arrays.full.vertices(), kNone);
  for (std::uint32_t t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) vertex_of_slot[state.indices[3 * std::size_t(t) + k]] = 0;
  }
  for (std::size_t slot = 0; slot < vertex_of_slot.size(); ++slot) {
    if (vertex_of_slot[slot] == kNone) continue;
    vertex_of_slot[slot] = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.push_back(arrays.grid.position(state.positions[slot]));
  }
  mesh.triangles.reserve(triangles.size());
  for (std::uint32_t t : triangles) {
    const std::uint32_t* slots = &state.indices[3 * std::size_t(t)];
    mesh.triangles.push_back({VertexId{vertex_of_slot[slots[0]]},
                              VertexId{vertex_of_slot[slots[1]]},
                              VertexId{vertex_of_slot[slots[2]]}});
    if (!arrays.material_of_triangle.empty()) {
      mesh.material_of_triangle.push_back(MaterialId{arrays.material_of_triangle[t]});
    }
    if (!arrays.part_of_triangle.empty()) {
      mesh.part_of_triangle.push_back(PartId{arrays.part_of_triangle[t]});
    }
  }
  mesh.materials = arrays.materials;
  mesh.parts = arrays.parts;
  mesh.up = arrays.up;
}

AttributeLayer extract_normals(const ProgressiveArrays& arrays, const LinearState& state,
                               std::span<const std::uint32_t> triangles) {
  AttributeLayer layer{.name = arrays.normal_name,
                       .role = AttributeRole::Normal,
                       .interpolation = Interpolation::Direction,
                       .dimension = 3,
                       .values = {},
                       .of_corner = {}};
  float value[3];
  LayerMaker(state, triangles, layer)
      .run(
          arrays.normals.size(), arrays.full.sn_vertices,
          [&](std::uint32_t c) { return state.normal_index(c); },
          [&](std::uint32_t c) {
            const Vec3f n = state.stored_normal(c);
            value[0] = n.x, value[1] = n.y, value[2] = n.z;
            return std::span<const float>(value);
          },
          [&](std::uint32_t t) {
            if (!state.is_derived(t)) return Vec3f{};
            const std::uint32_t* slots = &state.indices[3 * std::size_t(t)];
            return geometric_normal(state.positions[slots[0]], state.positions[slots[1]],
                                    state.positions[slots[2]]);
          });
  return layer;
}

AttributeLayer extract_layer(const ProgressiveArrays& arrays, const LinearState& state,
                             std::span<const std::uint32_t> triangles, std::size_t l) {
  const ProgressiveLayer& source = arrays.layers[l];
  AttributeLayer layer = layer_like(source);
  LayerMaker(state, triangles, layer)
      .run(
          source.value_count(), arrays.full.vertices(),
          [&](std::uint32_t c) { return state.index_of_corner(l, c); },
          [&](std::uint32_t c) { return state.value_of_corner(l, c); },
          [](std::uint32_t) { return Vec3f{}; });
  return layer;
}

}  // namespace

Mesh extract_level(const ProgressiveArrays& arrays, const LinearState& state) {
  Mesh mesh;
  const std::vector<std::uint32_t> triangles = active_triangles(arrays, state.active());
  extract_geometry(arrays, state, triangles, mesh);
  mesh.layers.push_back(extract_normals(arrays, state, triangles));
  for (std::size_t l = 0; l < arrays.layers.size(); ++l) {
    mesh.layers.push_back(extract_layer(arrays, state, triangles, l));
  }
  return mesh;
}

}  // namespace crease
