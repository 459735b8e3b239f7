#include "runtime/block_links.h"

#include "base/assert.h"

#include <bit>

namespace crease {

// No root is split: triangles of the coarse end are those of coarser blocks.
BlockLinks::BlockLinks(const BlockHierarchy::Data& data)
    : data_(data),
      held_(data.leaf_of_vertex.size(), 0),
      required_(data.hierarchy.vertices.split_count(), 0),
      is_taken_(data.roots_of_triangle.size(), 0),
      split_corners_(data.coarse_triangles, 0),
      is_hidden_(data.roots_of_triangle.size(), 0),
      needed_(data.node_of_root.size(), 0),
      split_roots_((data.root_of_split.size() + 63) / 64, 0) {
  for (std::uint32_t t = 0; t < data_.coarse_triangles; ++t) set_hidden(t);
  hidden_changes_.clear();
}

void BlockLinks::hold(std::uint32_t vertex) {
  if (++held_[vertex] > 1) return;
  ++held_count_;
  if (data_.wedge_of_vertex[vertex] == kNone) return;
  newly_held_.push_back(vertex);
  const VertexHierarchy& h = data_.hierarchy.vertices;
  for (NodeId n = data_.leaf_of_vertex[vertex]; !h.is_root(n); n = h.parent(n)) {
    const SplitId s = h.split_above(n);
    if (++required_[index_of(s)] > 1) return;
    ++required_count_;
    required_changes_.push_back(s);
  }
}

void BlockLinks::release(std::uint32_t vertex) {
  CREASE_ASSERT(held_[vertex] > 0);
  if (--held_[vertex] > 0) return;
  --held_count_;
  if (data_.wedge_of_vertex[vertex] == kNone) return;
  const VertexHierarchy& h = data_.hierarchy.vertices;
  for (NodeId n = data_.leaf_of_vertex[vertex]; !h.is_root(n); n = h.parent(n)) {
    const SplitId s = h.split_above(n);
    if (--required_[index_of(s)] > 0) return;
    --required_count_;
    required_changes_.push_back(s);
  }
}

void BlockLinks::take(std::uint32_t triangle, bool is_taken) {
  if ((is_taken_[triangle] != 0) == is_taken) return;
  const bool is_coarse = triangle < data_.coarse_triangles;
  const bool took_before = is_coarse && takes(triangle);
  is_taken_[triangle] = is_taken;
  taken_count_ += is_taken ? 1 : -1;
  if (is_coarse) tell_taking(triangle, took_before);
  set_hidden(triangle);
}

void BlockLinks::set_root_split(std::uint32_t root, bool is_split) {
  split_root_count_ += is_split ? 1 : -1;
  for (std::uint32_t i = data_.first_in_ring[root]; i < data_.first_in_ring[root + 1]; ++i) {
    const std::uint32_t r = data_.rings[i];
    if (is_split ? needed_[r]++ == 0 : --needed_[r] == 0) root_changes_.push_back({r, is_split});
  }
  const std::uint32_t end = data_.first_triangle_of_root[root + 1];
  for (std::uint32_t i = data_.first_triangle_of_root[root]; i < end; ++i) {
    const std::uint32_t t = data_.triangles_of_root[i];
    const bool took_before = takes(t);
    const std::uint8_t before = split_corners_[t];
    split_corners_[t] = static_cast<std::uint8_t>(is_split ? before + 1 : before - 1);
    if ((before > 0) == (split_corners_[t] > 0)) continue;
    tell_taking(t, took_before);
    set_hidden(t);
  }
}

void BlockLinks::set_root_splits(std::span<const std::uint64_t> done_words) {
  const std::size_t count = data_.root_of_split.size();
  for (std::size_t w = 0; w < split_roots_.size(); ++w) {
    const std::size_t bits = count - 64 * w;
    const std::uint64_t mask = bits >= 64 ? ~std::uint64_t(0) : (std::uint64_t(1) << bits) - 1;
    const std::uint64_t now = done_words[w] & mask;
    for (std::uint64_t other = split_roots_[w] ^ now; other != 0; other &= other - 1) {
      const auto bit = static_cast<unsigned>(std::countr_zero(other));
      set_root_split(data_.root_of_split[64 * w + bit], (now >> bit & 1) != 0);
    }
    split_roots_[w] = now;
  }
}

void BlockLinks::tell_taking(std::uint32_t t, bool took_before) {
  if (takes(t) != took_before) triangle_changes_.push_back({t, !took_before});
}

void BlockLinks::set_hidden(std::uint32_t t) {
  const bool is_coarser = t < data_.coarse_triangles && split_corners_[t] == 0;
  const bool is_hidden = is_taken_[t] != 0 || is_coarser;
  const TriangleId id = data_.id_of_triangle[t];
  if ((is_hidden_[index_of(id)] != 0) == is_hidden) return;
  is_hidden_[index_of(id)] = is_hidden;
  hidden_count_ += is_hidden ? 1 : -1;
  hidden_changes_.push_back(id);
}

void BlockLinks::forget_changes() {
  root_changes_.clear();
  triangle_changes_.clear();
  newly_held_.clear();
  required_changes_.clear();
  hidden_changes_.clear();
}

std::size_t BlockLinks::bytes() const {
  return sizeof(*this) + 4 * (held_.capacity() + needed_.capacity() + newly_held_.capacity()) +
         required_.capacity() + is_taken_.capacity() + split_corners_.capacity() +
         is_hidden_.capacity() + 8 * split_roots_.capacity() +
         sizeof(Change) * (root_changes_.capacity() + triangle_changes_.capacity()) +
         4 * (required_changes_.capacity() + hidden_changes_.capacity());
}

}  // namespace crease
