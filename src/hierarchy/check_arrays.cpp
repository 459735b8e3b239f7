// Whether foreign arrays can be moved in: sizes and ranges first, then every contraction in turn.
#include "crease/progressive_arrays.h"
#include "hierarchy/linear_state.h"
#include "hierarchy/packed_contraction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>

namespace crease {

namespace {

using Storage = ProgressiveLayer::Storage;

Failure broken(std::string what) {
  return fail(Error::Invalid, std::move(what));
}

Failure broken_at(std::size_t contraction, const char* what) {
  return broken("contraction " + std::to_string(contraction) + ": " + what);
}

bool all_below(std::span<const std::uint32_t> indices, std::size_t count) {
  return std::all_of(indices.begin(), indices.end(),
                     [count](std::uint32_t i) { return i < count; });
}

bool all_finite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float f) { return std::isfinite(f); });
}

std::optional<Failure> check_layer(const ProgressiveLayer& layer, const SectionCounts& full) {
  const std::string who = "layer '" + layer.name + "': ";
  if (layer.dimension < 1 || layer.dimension > 4) return broken(who + "dimension not 1 to 4");
  if (layer.values.size() % layer.dimension != 0) return broken(who + "odd number of values");
  if (!all_finite(layer.values)) return broken(who + "a value is not finite");
  std::size_t index_count = 3 * full.triangles();
  switch (layer.storage) {
    case Storage::Corner:
      break;
    case Storage::Face:
      index_count = full.triangles();
      break;
    case Storage::Vertex: {
      if (layer.value_count() < full.vertices()) return broken(who + "not one value a vertex");
      if (!layer.row_of_triangle.empty() && layer.row_of_triangle.size() != full.triangles()) {
        return broken(who + "not one row a triangle");
      }
      std::uint32_t rows = 0;  // they are numbered in the order of their triangles
      for (std::uint32_t row : layer.row_of_triangle) {
        if (row != kNone && row != rows++) return broken(who + "rows are out of order");
      }
      index_count = 3 * std::size_t(rows);
      break;
    }
    default:
      return broken(who + "unknown storage");
  }
  if (layer.storage != Storage::Vertex && !layer.row_of_triangle.empty()) {
    return broken(who + "rows where there are none");
  }
  if (layer.indices.size() != index_count) return broken(who + "wrong number of indices");
  if (!all_below(layer.indices, layer.value_count())) return broken(who + "index out of range");
  return std::nullopt;
}

std::optional<Failure> check_categories(const std::vector<std::uint32_t>& of_triangle,
                                        std::size_t triangle_count, std::size_t name_count,
                                        const char* what) {
  if (of_triangle.empty()) return std::nullopt;
  if (of_triangle.size() != triangle_count) {
    return broken(std::string(what) + ": not one a triangle");
  }
  if (!all_below(of_triangle, name_count)) return broken(std::string(what) + " out of range");
  return std::nullopt;
}

std::optional<Failure> check_full_resolution(const ProgressiveArrays& a) {
  const SectionCounts& full = a.full;
  for (double d : {a.grid.origin.x, a.grid.origin.y, a.grid.origin.z, a.grid.step}) {
    if (!(std::abs(d) < 1e290)) return broken("the grid is not finite");  // nor its far points
  }
  if (!(a.grid.step > 0)) return broken("the grid's step is not above zero");
  if (full.vertices() >= kNone || 3 * full.triangles() >= kNone) return broken("too many elements");
  if (a.positions.size() != full.vertices()) return broken("not one position a vertex");
  if (a.indices.size() != 3 * full.triangles()) return broken("not three indices a triangle");
  if (!all_below(a.indices, full.vertices())) return broken("vertex index out of range");
  for (std::size_t c = 0; c < a.indices.size(); c += 3) {
    const std::uint32_t i = a.indices[c], j = a.indices[c + 1], k = a.indices[c + 2];
    if (i == j || j == k || k == i) return broken("a triangle has two equal corners");
  }
  const std::size_t sn_corners = 3 * std::size_t(full.sn_triangles);
  if (!all_below(std::span(a.indices).first(sn_corners), full.sn_vertices)) {
    return broken("an SN triangle has a vertex that is not SN");
  }
  if (a.normals.size() < full.sn_vertices) return broken("not one normal an SN vertex");
  if (a.normals.size() >= kNone) return broken("too many normals");
  for (const Vec3f& n : a.normals) {
    if (!all_finite(std::array{n.x, n.y, n.z})) return broken("a normal is not finite");
  }
  if (a.fn_normals.size() != full.fn_triangles) return broken("not one normal an FN triangle");
  if (a.nsn_normals.size() != 3 * std::size_t(full.nsn_triangles)) {
    return broken("not three normals an NSN triangle");
  }
  if (!all_below(a.fn_normals, a.normals.size()) || !all_below(a.nsn_normals, a.normals.size())) {
    return broken("normal index out of range");
  }
  if (a.layers.size() >= kMaxLayers) return broken("too many layers");
  for (const ProgressiveLayer& layer : a.layers) {
    if (auto failure = check_layer(layer, full)) return failure;
  }
  if (auto failure = check_categories(a.material_of_triangle, full.triangles(), a.materials.size(),
                                      "material")) {
    return failure;
  }
  return check_categories(a.part_of_triangle, full.triangles(), a.parts.size(), "part");
}

// The streams hold exactly what the headers ask for.
std::optional<Failure> check_stream_sizes(const ProgressiveArrays& a) {
  const PackedContractions& p = a.contractions;
  if (p.headers.size() != p.count()) return broken("not one header a contraction");
  if (p.deltas.size() != (a.placement == Placement::Optimal ? p.count() : 0)) {
    return broken("not one delta a contraction");
  }
  std::uint64_t corners = 0, own = 0, wide = 0, blocks = 0;
  const std::size_t own_words = own_value_words(a);
  for (std::uint32_t word : p.headers) {
    const PackedHeader h = unpack_header(word);
    if (h.is_wide) {
      if (wide >= p.wide.size()) return broken("wide counts are missing");
      corners += p.wide[wide++].corner_changes;
    } else {
      corners += h.corner_changes;
    }
    own += (h.own_normal_changes ? 3 : 0) + (h.own_values_change ? own_words : 0);
    blocks += h.has_block ? 1 : 0;
    if (h.swaps_positions && a.placement == Placement::Optimal) {
      return broken("a swap where there are deltas");
    }
  }
  if (corners != p.corners.size()) return broken("wrong number of corner changes");
  if (own != p.own.size()) return broken("wrong number of own values");
  if (wide != p.wide.size()) return broken("wrong number of wide counts");
  if (blocks != p.block_ends.size()) return broken("wrong number of blocks");
  std::uint32_t end = 0;
  for (std::uint32_t next : p.block_ends) {
    if (next < end) return broken("blocks are out of order");
    end = next;
  }
  if (end != p.blocks.size()) return broken("wrong number of block words");
  std::uint32_t applied = 0;
  std::array<float, 4> least{};
  for (const ErrorStep& step : p.errors) {
    if (step.applied <= applied || step.applied > p.count()) return broken("errors out of order");
    applied = step.applied;
    const LevelError& e = step.error;
    const std::array errors{e.surface, e.line, e.degrees, e.texture};
    for (std::size_t k = 0; k < errors.size(); ++k) {
      if (!std::isfinite(errors[k]) || errors[k] < least[k]) return broken("an error goes down");
      least[k] = errors[k];
    }
  }
  return std::nullopt;
}

// Follows the contractions. What is looked at before LinearState writes is exactly what it indexes
// with; what is looked at after makes sure that vanished slots and triangles stay out of use.
class Follower {
 public:
  explicit Follower(const ProgressiveArrays& arrays)
      : a_(arrays), p_(arrays.contractions), state_(arrays) {
    valence_.assign(a_.full.vertices(), 0);
    for (std::uint32_t slot : a_.indices) ++valence_[slot];
  }

  std::optional<Failure> run() {
    for (std::size_t i = 0; i < p_.count(); ++i) {
      if (const char* what = step(i)) return broken_at(i, what);
    }
    return std::nullopt;
  }

 private:
  bool is_active(const SectionCounts& active, std::uint32_t triangle) const {
    const std::uint32_t first_nsn = a_.full.sn_triangles + a_.full.fn_triangles;
    if (triangle < a_.full.sn_triangles) return triangle < active.sn_triangles;
    if (triangle < first_nsn) return triangle - a_.full.sn_triangles < active.fn_triangles;
    return triangle - first_nsn < active.nsn_triangles;
  }

  const char* step(std::size_t i) {
    PackedHeader h = unpack_header(p_.headers[i]);
    if (h.is_wide) {
      h.lost = p_.wide[wide_].lost;
      h.corner_changes = p_.wide[wide_++].corner_changes;
    }
    const SectionCounts& active = state_.active();
    if (h.lost.sn_vertices > active.sn_vertices || h.lost.nsn_vertices > active.nsn_vertices ||
        h.lost.sn_triangles > active.sn_triangles || h.lost.fn_triangles > active.fn_triangles ||
        h.lost.nsn_triangles > active.nsn_triangles) {
      return "it loses more than there is";
    }
    if ((h.removed_is_nsn ? h.lost.nsn_vertices : h.lost.sn_vertices) == 0) {
      return "it does not lose the vertex that it removes";
    }
    SectionCounts after = active;
    after.sn_vertices -= h.lost.sn_vertices;
    after.nsn_vertices -= h.lost.nsn_vertices;
    after.sn_triangles -= h.lost.sn_triangles;
    after.fn_triangles -= h.lost.fn_triangles;
    after.nsn_triangles -= h.lost.nsn_triangles;

    const std::uint32_t kept = p_.kept[i];
    const bool kept_is_sn = kept < a_.full.sn_vertices;
    if (kept_is_sn ? kept >= after.sn_vertices : kept - a_.full.sn_vertices >= after.nsn_vertices) {
      return "the kept vertex is not active";
    }
    if (h.own_normal_changes && !kept_is_sn) return "the kept vertex owns no normal";
    const std::uint32_t removed =
        h.removed_is_nsn ? a_.full.sn_vertices + active.nsn_vertices - 1 : active.sn_vertices - 1;
    if (const char* what = check_corners(h, after, kept, removed)) return what;
    if (h.has_block) {
      if (const char* what = check_block(after)) return what;
    }
    NoMarks marks;
    state_.apply(marks);
    if (const char* what = check_lost(active, h)) return what;
    return check_own(h, kept);
  }

  const char* check_corners(const PackedHeader& h, const SectionCounts& after, std::uint32_t kept,
                            std::uint32_t removed) {
    for (std::uint32_t k = 0; k < h.corner_changes; ++k) {
      const std::uint32_t c = p_.corners[corner_++];
      if (c >= a_.indices.size() || !is_active(after, c / 3))
        return "a changed corner is not active";
      if (state_.indices[c] != removed) return "a changed corner is not at the removed vertex";
      const std::uint32_t* slots = &state_.indices[c - c % 3];
      if (slots[0] == kept || slots[1] == kept || slots[2] == kept) {
        return "a surviving triangle has both vertices";
      }
      if (c / 3 < a_.full.sn_triangles && kept >= a_.full.sn_vertices) {
        return "an SN triangle gets a vertex that is not SN";
      }
      --valence_[removed];
      ++valence_[kept];
    }
    return nullptr;
  }

  const char* check_block(const SectionCounts& after) {
    const std::size_t end = p_.block_ends[block_++];
    std::uint64_t last = 0;  // kind, layer and item ascend, so nothing is there twice
    while (word_ < end) {
      const PackedGroup group = unpack_group(p_.blocks[word_++]);
      const std::size_t words = group.kind == BlockKind::Indices ? 2 : 1;
      if (group.count > (end - word_) / words) return "its block is cut";
      const std::uint64_t base = (std::uint64_t(group.kind) << 14 | group.layer) << 32;
      for (std::uint32_t k = 0; k < group.count; ++k, word_ += words) {
        const std::uint64_t item = (base | p_.blocks[word_]) + 1;
        if (item <= last) return "its block is out of order";
        last = item;
        if (const char* what = check_item(group, after)) return what;
      }
    }
    return nullptr;
  }

  const char* check_item(const PackedGroup& group, const SectionCounts& after) {
    const std::uint32_t item = p_.blocks[word_];
    switch (group.kind) {
      case BlockKind::Indices:
        return check_index_change(group.layer, item, p_.blocks[word_ + 1], after);
      case BlockKind::Derived:
        if (item >= a_.full.triangles() || !is_active(after, item)) {
          return "a derived triangle is not active";
        }
        if (!state_.is_explicit_normal(item)) return "an SN triangle is derived";
        if (state_.is_derived(item)) return "a triangle is derived twice";
        return nullptr;
      case BlockKind::Touched:
        if (item >= a_.indices.size() || !is_active(after, item / 3)) {
          return "a touched corner is not active";
        }
        return nullptr;
    }
    return "unknown item in its block";
  }

  const char* check_index_change(std::uint32_t layer, std::uint32_t c, std::uint32_t flip,
                                 const SectionCounts& after) {
    if (c >= a_.indices.size() || !is_active(after, c / 3)) return "a changed index is not active";
    if (layer > a_.layers.size()) return "a layer is out of range";
    if (layer == 0) {
      if (c / 3 < a_.full.sn_triangles + a_.full.fn_triangles) {
        return "a normal index changes where none may";
      }
      return (state_.normal_index(c) ^ flip) < a_.normals.size() ? nullptr
                                                                 : "a normal is out of range";
    }
    const ProgressiveLayer& source = a_.layers[layer - 1];
    const std::uint32_t index = state_.index_of_corner(layer - 1, c);
    if (source.storage == Storage::Face || index == kNone) {
      return "a value index changes where none may";
    }
    return (index ^ flip) < source.value_count() ? nullptr : "a value is out of range";
  }

  // After the fact, with `after` active.
  const char* check_lost(const SectionCounts& after, const PackedHeader& h) {
    const std::uint32_t first_nsn = a_.full.sn_triangles + a_.full.fn_triangles;
    const std::uint32_t kept = p_.kept[state_.applied() - 1];
    const std::uint32_t removed =
        h.removed_is_nsn ? a_.full.sn_vertices + after.nsn_vertices + h.lost.nsn_vertices - 1
                         : after.sn_vertices + h.lost.sn_vertices - 1;
    const struct {
      std::uint32_t first, count;
    } lost[] = {{after.sn_triangles, h.lost.sn_triangles},
                {a_.full.sn_triangles + after.fn_triangles, h.lost.fn_triangles},
                {first_nsn + after.nsn_triangles, h.lost.nsn_triangles}};
    for (const auto& section : lost) {
      for (std::uint32_t t = section.first; t < section.first + section.count; ++t) {
        const std::span<const std::uint32_t> slots =
            std::span(state_.indices).subspan(3 * std::size_t(t), 3);
        if (std::count(slots.begin(), slots.end(), kept) != 1 ||
            std::count(slots.begin(), slots.end(), removed) != 1) {
          return "a lost triangle does not have both vertices";
        }
        for (std::uint32_t slot : slots) --valence_[slot];
      }
    }
    for (std::uint32_t k = 0; k < h.lost.sn_vertices; ++k) {
      if (valence_[after.sn_vertices + k] != 0) return "a lost vertex is still in use";
    }
    for (std::uint32_t k = 0; k < h.lost.nsn_vertices; ++k) {
      if (valence_[a_.full.sn_vertices + after.nsn_vertices + k] != 0) {
        return "a lost vertex is still in use";
      }
    }
    return nullptr;
  }

  const char* check_own(const PackedHeader& h, std::uint32_t kept) const {
    if (h.own_normal_changes) {
      const Vec3f& n = state_.own_normals[kept];
      if (!all_finite(std::array{n.x, n.y, n.z})) return "a normal is not finite";
    }
    if (!h.own_values_change) return nullptr;
    for (std::size_t l = 0; l < a_.layers.size(); ++l) {
      if (a_.layers[l].storage != Storage::Vertex) continue;
      const std::size_t d = a_.layers[l].dimension;
      if (!all_finite(std::span(state_.layers[l].own).subspan(kept * d, d))) {
        return "a value is not finite";
      }
    }
    return nullptr;
  }

  const ProgressiveArrays& a_;
  const PackedContractions& p_;
  LinearState state_;
  std::vector<std::uint32_t> valence_;  // per slot: corners of active triangles
  std::size_t wide_ = 0, corner_ = 0, block_ = 0, word_ = 0;
};

}  // namespace

Status check_progressive_arrays(const ProgressiveArrays& arrays) {
  if (auto failure = check_full_resolution(arrays)) return *failure;
  if (auto failure = check_stream_sizes(arrays)) return *failure;
  if (auto failure = Follower(arrays).run()) return *failure;
  return Done{};
}

}  // namespace crease
