#include "assemble/arrange.h"

#include "assemble/replay.h"
#include "assemble/value_table.h"
#include "base/assert.h"
#include "hierarchy/attribute_values.h"
#include "hierarchy/packed_contraction.h"
#include "mesh/drawn_texcoords.h"

#include <algorithm>
#include <bit>
#include <tuple>

namespace crease {

namespace {

using Storage = ProgressiveLayer::Storage;

// New numbers, section by section: survivors in their order, then the lost, those lost first last.
template <typename SectionOf>
std::vector<std::uint32_t> order_by_loss(std::size_t count, int section_count,
                                         std::span<const std::uint32_t> lost,
                                         SectionOf section_of) {
  std::vector<std::uint32_t> new_of_old(count, kNone);
  std::vector<std::uint32_t> end(static_cast<std::size_t>(section_count), 0);
  for (std::size_t i = 0; i < count; ++i) ++end[static_cast<std::size_t>(section_of(i))];
  std::uint32_t sum = 0;
  std::vector<std::uint32_t> next;
  for (std::uint32_t& e : end) {
    next.push_back(sum);
    sum += e;
    e = sum;
  }
  for (std::uint32_t old : lost) new_of_old[old] = --end[static_cast<std::size_t>(section_of(old))];
  for (std::size_t i = 0; i < count; ++i) {
    if (new_of_old[i] == kNone) new_of_old[i] = next[static_cast<std::size_t>(section_of(i))]++;
  }
  return new_of_old;
}

void add_lost_vertex(SectionCounts& lost, bool is_sn) {
  is_sn ? ++lost.sn_vertices : ++lost.nsn_vertices;
}

void add_lost_triangle(SectionCounts& lost, TriangleKind kind) {
  kind == TriangleKind::SN   ? ++lost.sn_triangles
  : kind == TriangleKind::FN ? ++lost.fn_triangles
                             : ++lost.nsn_triangles;
}

class Arranger {
 public:
  Arranger(const Mesh& snapped, const ContractionSequence& sequence, Restructured parts)
      : mesh_(snapped), sequence_(sequence), parts_(std::move(parts)), replay_(snapped, sequence) {
    CREASE_ASSERT(snapped.layers.size() < kMaxLayers);
  }

  ProgressiveArrays run(Arrangement* arrangement) {
    count_sections();
    new_of_triangle_ = order_by_loss(mesh_.triangle_count(), 3, parts_.lost_triangles,
                                     [this](std::size_t t) { return parts_.kind_of_triangle[t]; });
    number_rows();
    first_positions_ = replay_.positions();
    for (std::size_t l = 0; l < mesh_.layers.size(); ++l) {
      first_owned_.emplace_back();
      for (std::uint32_t v = 0; v < mesh_.vertex_count(); ++v) {
        first_owned_[l].push_back(parts_.sharing[l].owned(v));
      }
    }
    arrays_.placement = stored_placement();
    for (std::uint32_t i = 0; i < sequence_.contractions.size(); ++i) pack(i);
    slot_of_vertex_ = order_by_loss(mesh_.vertex_count(), 2, lost_slots_, [this](std::size_t v) {
      return is_sn_slot(static_cast<std::uint32_t>(v)) ? 0 : 1;
    });
    for (std::uint32_t& kept : arrays_.contractions.kept) kept = slot_of_vertex_[kept];
    fill_vertices_and_triangles();
    fill_values();
    if (arrangement != nullptr) *arrangement = {new_of_triangle_, slot_of_vertex_};
    return std::move(arrays_);
  }

 private:
  // An index change that waits for the values' new numbers.
  struct PendingChange {
    std::size_t word;  // in blocks
    std::uint32_t layer, from, to;
  };

  bool is_sn_slot(std::uint32_t v) const { return first_owned_[parts_.normal_layer][v] != kNone; }

  void count_sections() {
    for (TriangleKind kind : parts_.kind_of_triangle) add_lost_triangle(arrays_.full, kind);
    for (std::uint32_t v = 0; v < mesh_.vertex_count(); ++v) {
      add_lost_vertex(arrays_.full, parts_.sharing[parts_.normal_layer].owned(v) != kNone);
    }
  }

  // Rows of the triangles that have indices of their own in a layer that is stored by vertex.
  void number_rows() {
    for (std::size_t l = 0; l < mesh_.layers.size(); ++l) {
      std::vector<std::uint32_t>& rows = rows_.emplace_back();
      if (l == parts_.normal_layer || parts_.storage[l] != Storage::Vertex) continue;
      if (parts_.sharing[l].explicit_count() == 0) continue;
      rows.assign(mesh_.triangle_count(), kNone);
      for (std::size_t t = 0; t < mesh_.triangle_count(); ++t) {
        if (parts_.sharing[l].is_explicit(t)) rows[new_of_triangle_[t]] = 0;
      }
      std::uint32_t row = 0;
      for (std::uint32_t& r : rows) {
        if (r != kNone) r = row++;
      }
    }
  }

  // A sequence that calls itself Endpoint and is not gets deltas all the same.
  Placement stored_placement() const {
    if (sequence_.placement == Placement::Optimal) return Placement::Optimal;
    std::vector<Vec3i> positions = replay_.positions();
    for (const Contraction& c : sequence_.contractions) {
      Vec3i& q = positions[index_of(c.kept)];
      if (c.position != q && c.position != positions[index_of(c.removed)]) {
        return Placement::Optimal;
      }
      q = c.position;
    }
    return Placement::Endpoint;
  }

  std::uint32_t new_corner(std::uint32_t corner) const {
    return 3 * new_of_triangle_[corner / 3] + corner % 3;
  }

  void pack(std::uint32_t i) {
    const Contraction& c = sequence_.contractions[i];
    const auto changes = sequence_.changes_of(c);
    const Step& step = replay_.look(i);
    const bool keep_p = parts_.sharing[parts_.normal_layer].prefers_p(step, changes);
    const std::uint32_t kept = keep_p ? step.p_slot : step.q_slot;
    const std::uint32_t removed = keep_p ? step.q_slot : step.p_slot;
    PackedContractions& packed = arrays_.contractions;

    PackedHeader header;
    header.removed_is_nsn = !is_sn_slot(removed);
    const Vec3i before = replay_.position(kept);
    if (arrays_.placement == Placement::Optimal) {
      Vec3i delta;
      for (int k = 0; k < 3; ++k) {
        delta[k] = static_cast<std::int32_t>(static_cast<std::uint32_t>(c.position[k]) -
                                             static_cast<std::uint32_t>(before[k]));
      }
      packed.deltas.push_back(delta);
    } else {
      header.swaps_positions = c.position != before;
    }

    const std::size_t first_corner = packed.corners.size();
    for (std::uint32_t corner : keep_p ? step.at_q : step.at_p) {
      packed.corners.push_back(new_corner(corner));
    }
    std::sort(packed.corners.begin() + static_cast<std::ptrdiff_t>(first_corner),
              packed.corners.end());
    header.corner_changes = static_cast<std::uint32_t>(packed.corners.size() - first_corner);

    pack_own(header, step, keep_p, changes);
    items_.clear();
    gather_touched(step, keep_p, c.position != before);
    gather_derived(c);
    for (std::uint32_t t : step.lost) add_lost_triangle(header.lost, parts_.kind_of_triangle[t]);
    replay_.contract(
        i, keep_p,
        [this](std::uint32_t layer, std::uint32_t corner, std::uint32_t from, std::uint32_t to) {
          if (!parts_.sharing[layer].is_explicit(corner / 3)) return;
          const std::uint32_t stored = layer == parts_.normal_layer  ? 0
                                       : layer < parts_.normal_layer ? layer + 1
                                                                     : layer;
          items_.push_back({BlockKind::Indices, stored, new_corner(corner), layer, from, to});
        });
    header.has_block = pack_block();

    lost_slots_.push_back(removed);
    add_lost_vertex(header.lost, is_sn_slot(removed));
    for (std::uint32_t slot : replay_.lost_slots()) {
      lost_slots_.push_back(slot);
      add_lost_vertex(header.lost, is_sn_slot(slot));
    }
    packed.kept.push_back(kept);  // renumbered at the end
    packed.headers.push_back(pack_header(header));
    if (header.is_wide) packed.wide.push_back({header.lost, header.corner_changes});
    const LevelError error = larger(error_, c.error);
    if (error.surface != error_.surface || error.line != error_.line ||
        error.degrees != error_.degrees || error.texture != error_.texture) {
      error_ = error;
      packed.errors.push_back({i + 1, error});
    }
  }

  // Moves what the slots own along, and notes which layers that a renderer sees change at v_s.
  void pack_own(PackedHeader& header, const Step& step, bool keep_p,
                std::span<const AttributeChange> changes) {
    const std::uint32_t kept = keep_p ? step.p_slot : step.q_slot;
    repainted_.clear();
    own_words_.clear();
    for (std::size_t l = 0; l < mesh_.layers.size(); ++l) {
      const bool is_normal = l == parts_.normal_layer;
      if (!is_normal && parts_.storage[l] != Storage::Vertex) continue;
      Sharing& sharing = parts_.sharing[l];
      const std::uint32_t before = sharing.owned(kept);
      sharing.contract(replay_, step, keep_p, changes);
      const std::uint32_t after = sharing.owned(kept);
      if (is_normal) {
        header.own_normal_changes = push_xor(l, before, after, arrays_.contractions.own);
        continue;
      }
      const bool changed = push_xor(l, before, after, own_words_);
      if (!changed) own_words_.insert(own_words_.end(), mesh_.layers[l].dimension, 0);
      header.own_values_change = header.own_values_change || changed;
      if (changed && is_drawn(l)) repainted_.push_back(l);
    }
    if (header.own_values_change) {
      arrays_.contractions.own.insert(arrays_.contractions.own.end(), own_words_.begin(),
                                      own_words_.end());
    }
  }

  // Nothing where the bits stay the same.
  bool push_xor(std::size_t layer, std::uint32_t before, std::uint32_t after,
                std::vector<std::uint32_t>& words) const {
    if (before == after) return false;
    const auto a = attribute_value(mesh_.layers[layer], sequence_, layer, AttributeId{before});
    const auto b = attribute_value(mesh_.layers[layer], sequence_, layer, AttributeId{after});
    const std::size_t first = words.size();
    bool differs = false;
    for (std::size_t k = 0; k < a.size(); ++k) {
      words.push_back(std::bit_cast<std::uint32_t>(a[k]) ^ std::bit_cast<std::uint32_t>(b[k]));
      differs = differs || words.back() != 0;
    }
    if (!differs) words.resize(first);
    return differs;
  }

  std::size_t color_layer() const {
    for (std::size_t l = 0; l < mesh_.layers.size(); ++l) {
      if (mesh_.layers[l].role == AttributeRole::Color) return l;
    }
    return mesh_.layers.size();
  }

  bool is_drawn(std::size_t layer) const { return layer == color_layer() || layer == painted_; }

  void gather_touched(const Step& step, bool keep_p, bool moves) {
    if (!moves && repainted_.empty()) return;
    for (std::uint32_t corner : keep_p ? step.at_p : step.at_q) {
      const std::uint32_t t = corner / 3;
      const bool is_repainted =
          std::any_of(repainted_.begin(), repainted_.end(),
                      [&](std::size_t l) { return !parts_.sharing[l].is_explicit(t); });
      if ((moves && replay_.is_derived(t)) || is_repainted) {
        items_.push_back({BlockKind::Touched, 0, new_corner(corner), 0, 0, 0});
      }
    }
  }

  void gather_derived(const Contraction& c) {
    for (TriangleId t : sequence_.derived_of(c)) {
      items_.push_back({BlockKind::Derived, 0, new_of_triangle_[index_of(t)], 0, 0, 0});
    }
  }

  bool pack_block() {
    if (items_.empty()) return false;
    std::sort(items_.begin(), items_.end(), [](const Item& a, const Item& b) {
      return std::tie(a.kind, a.stored_layer, a.id) < std::tie(b.kind, b.stored_layer, b.id);
    });
    PackedContractions& packed = arrays_.contractions;
    for (std::size_t i = 0; i < items_.size();) {
      PackedGroup group{items_[i].kind, items_[i].stored_layer, 0};
      const std::size_t group_word = packed.blocks.size();
      packed.blocks.push_back(0);
      for (; i < items_.size() && group.count < kMaxGroupCount; ++i) {
        const Item& item = items_[i];
        if (item.kind != group.kind || item.stored_layer != group.layer) break;
        ++group.count;
        packed.blocks.push_back(item.id);
        if (item.kind != BlockKind::Indices) continue;
        pending_.push_back({packed.blocks.size(), item.layer, item.from, item.to});
        packed.blocks.push_back(0);
      }
      packed.blocks[group_word] = pack_group(group);
    }
    CREASE_ASSERT(packed.blocks.size() < kNone);
    packed.block_ends.push_back(static_cast<std::uint32_t>(packed.blocks.size()));
    return true;
  }

  void fill_vertices_and_triangles() {
    arrays_.grid = sequence_.grid;
    arrays_.positions.resize(mesh_.vertex_count());
    for (std::size_t v = 0; v < mesh_.vertex_count(); ++v) {
      arrays_.positions[slot_of_vertex_[v]] = first_positions_[v];
    }
    arrays_.indices.resize(3 * mesh_.triangle_count());
    for (std::size_t t = 0; t < mesh_.triangle_count(); ++t) {
      for (std::size_t c = 0; c < 3; ++c) {
        arrays_.indices[3 * new_of_triangle_[t] + c] =
            slot_of_vertex_[index_of(mesh_.triangles[t][c])];
      }
    }
    arrays_.materials = mesh_.materials;
    arrays_.parts = mesh_.parts;
    arrays_.up = mesh_.up;
    arrays_.material_of_triangle.resize(mesh_.material_of_triangle.size());
    for (std::size_t t = 0; t < mesh_.material_of_triangle.size(); ++t) {
      arrays_.material_of_triangle[new_of_triangle_[t]] =
          static_cast<std::uint32_t>(index_of(mesh_.material_of_triangle[t]));
    }
    arrays_.part_of_triangle.resize(mesh_.part_of_triangle.size());
    for (std::size_t t = 0; t < mesh_.part_of_triangle.size(); ++t) {
      arrays_.part_of_triangle[new_of_triangle_[t]] =
          static_cast<std::uint32_t>(index_of(mesh_.part_of_triangle[t]));
    }
  }

  // Values in their new order, indices to them, and the index changes that waited for them.
  void fill_values() {
    std::vector<std::uint32_t> order(mesh_.triangle_count());  // old triangle of new
    for (std::size_t t = 0; t < order.size(); ++t) {
      order[new_of_triangle_[t]] = static_cast<std::uint32_t>(t);
    }
    std::vector<ValueTable> tables;
    for (std::size_t l = 0; l < mesh_.layers.size(); ++l) {
      tables.emplace_back(mesh_.layers[l], sequence_, l);
      number_values(l, order, tables[l]);
    }
    for (const PendingChange& change : pending_) {
      const ValueTable& table = tables[change.layer];
      arrays_.contractions.blocks[change.word] =
          table.number(change.from) ^ table.number(change.to);
    }
  }

  void number_values(std::size_t l, const std::vector<std::uint32_t>& order, ValueTable& table) {
    const AttributeLayer& source = mesh_.layers[l];
    const bool is_normal = l == parts_.normal_layer;
    const bool by_vertex = is_normal || parts_.storage[l] == Storage::Vertex;
    if (by_vertex) {
      std::vector<std::uint32_t> owned(is_normal ? arrays_.full.sn_vertices : mesh_.vertex_count());
      for (std::size_t v = 0; v < mesh_.vertex_count(); ++v) {
        if (slot_of_vertex_[v] < owned.size()) owned[slot_of_vertex_[v]] = first_owned_[l][v];
      }
      table.add_owned(owned);
    }
    for (std::size_t corner = 0; corner < source.of_corner.size(); ++corner) {
      if (parts_.sharing[l].is_explicit(corner / 3)) {
        table.use(static_cast<std::uint32_t>(index_of(source.of_corner[corner])));
      }
    }
    for (const PendingChange& change : pending_) {
      if (change.layer == l) table.use(change.to);
    }
    table.number_the_rest();

    const bool once = !is_normal && parts_.storage[l] == Storage::Face;
    std::vector<std::uint32_t> indices;
    for (std::uint32_t t : order) {
      if (!parts_.sharing[l].is_explicit(t)) continue;
      const bool one = once || (is_normal && parts_.kind_of_triangle[t] == TriangleKind::FN);
      for (std::size_t c = 0; c < (one ? 1u : 3u); ++c) {
        indices.push_back(
            table.number(static_cast<std::uint32_t>(index_of(source.of_corner[3 * t + c]))));
      }
    }
    if (is_normal) {
      const std::vector<float>& values = table.values();
      arrays_.normal_name = source.name;
      for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
        arrays_.normals.push_back({values[i], values[i + 1], values[i + 2]});
      }
      const auto end_of_fn = indices.begin() + arrays_.full.fn_triangles;
      arrays_.fn_normals.assign(indices.begin(), end_of_fn);
      arrays_.nsn_normals.assign(end_of_fn, indices.end());
      return;
    }
    ProgressiveLayer layer;
    layer.name = source.name;
    layer.role = source.role;
    layer.interpolation = source.interpolation;
    layer.dimension = source.dimension;
    layer.storage = parts_.storage[l];
    layer.values = table.take_values();
    layer.row_of_triangle = std::move(rows_[l]);
    layer.indices = std::move(indices);
    arrays_.layers.push_back(std::move(layer));
  }

  struct Item {
    BlockKind kind;
    std::uint32_t stored_layer;
    std::uint32_t id;  // new corner or triangle
    std::uint32_t layer, from, to;
  };

  const Mesh& mesh_;
  const ContractionSequence& sequence_;
  Restructured parts_;
  Replay replay_;
  ProgressiveArrays arrays_;
  std::vector<std::uint32_t> new_of_triangle_, slot_of_vertex_;
  std::vector<std::vector<std::uint32_t>> rows_;         // per layer, by new triangle
  std::vector<std::vector<std::uint32_t>> first_owned_;  // per layer, by old slot
  std::vector<Vec3i> first_positions_;
  std::vector<std::uint32_t> lost_slots_;
  std::vector<PendingChange> pending_;
  LevelError error_;
  std::vector<Item> items_;               // scratch of one contraction
  std::vector<std::uint32_t> own_words_;  // likewise
  std::vector<std::size_t> repainted_;    // likewise
  const std::uint32_t painted_ = drawn_texcoords(mesh_.layers);
};

}  // namespace

ProgressiveArrays arrange(const Mesh& snapped, const ContractionSequence& sequence,
                          Restructured parts, Arrangement* arrangement) {
  return Arranger(snapped, sequence, std::move(parts)).run(arrangement);
}

}  // namespace crease
