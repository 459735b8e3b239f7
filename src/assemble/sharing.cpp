#include "assemble/sharing.h"

#include "base/assert.h"
#include "hierarchy/attribute_values.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace crease {

Sharing::Sharing(const Mesh& snapped, const ContractionSequence& sequence, std::size_t layer)
    : mesh_(snapped), sequence_(sequence), layer_(layer) {
  owned_.assign(snapped.vertex_count(), kNone);
  explicit_.assign(snapped.triangle_count(), 0);
  find_twins();
}

bool Sharing::are_twins(std::uint32_t a, std::uint32_t b) const {
  if (a == b || has_twin_[a] == 0 || has_twin_[b] == 0) return false;
  const AttributeLayer& source = mesh_.layers[layer_];
  const auto va = attribute_value(source, sequence_, layer_, AttributeId{a});
  const auto vb = attribute_value(source, sequence_, layer_, AttributeId{b});
  return std::memcmp(va.data(), vb.data(), va.size_bytes()) == 0;
}

// An open hash table of ids; the order in it is of no consequence.
void Sharing::find_twins() {
  const AttributeLayer& source = mesh_.layers[layer_];
  const std::size_t count = source.value_count() + new_value_count(source, sequence_, layer_);
  has_twin_.assign(count, 1);  // for are_twins()
  std::vector<std::uint8_t> found(count, 0);
  std::vector<std::uint32_t> table(std::bit_ceil(2 * count + 1), kNone);
  for (std::uint32_t id = 0; id < count; ++id) {
    std::uint64_t hash = 0;
    for (float f : attribute_value(source, sequence_, layer_, AttributeId{id})) {
      hash = (hash ^ std::bit_cast<std::uint32_t>(f)) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 29;
    }
    std::size_t place = hash & (table.size() - 1);
    while (table[place] != kNone && !are_twins(table[place], id)) {
      place = (place + 1) & (table.size() - 1);
    }
    if (table[place] == kNone) {
      table[place] = id;
    } else {
      found[id] = found[table[place]] = 1;
    }
  }
  has_twin_ = std::move(found);
}

void Sharing::own_where_all_agree() {
  const std::vector<AttributeId>& of_corner = mesh_.layers[layer_].of_corner;
  std::vector<std::uint8_t> disagrees(owned_.size(), 0);
  for (std::size_t corner = 0; corner < of_corner.size(); ++corner) {
    const std::size_t v = index_of(mesh_.triangles[corner / 3][corner % 3]);
    const auto id = static_cast<std::uint32_t>(index_of(of_corner[corner]));
    if (owned_[v] == kNone) owned_[v] = id;
    if (owned_[v] != id) disagrees[v] = 1;
  }
  for (std::size_t v = 0; v < owned_.size(); ++v) {
    if (disagrees[v] != 0) owned_[v] = kNone;
  }
  for (TriangleId t : sequence_.derived) explicit_[index_of(t)] = 1;
  explicit_where_not_owned();
}

void Sharing::own_what_most_have() {
  const std::vector<AttributeId>& of_corner = mesh_.layers[layer_].of_corner;
  // The corners of each vertex, by counting.
  std::vector<std::uint32_t> first(owned_.size() + 1, 0);
  for (const Triangle& t : mesh_.triangles) {
    for (VertexId v : t) ++first[index_of(v) + 1];
  }
  for (std::size_t v = 0; v < owned_.size(); ++v) first[v + 1] += first[v];
  std::vector<std::uint32_t> ids(of_corner.size());
  std::vector<std::uint32_t> fill(first.begin(), first.end() - 1);
  for (std::size_t corner = 0; corner < of_corner.size(); ++corner) {
    const std::size_t v = index_of(mesh_.triangles[corner / 3][corner % 3]);
    ids[fill[v]++] = static_cast<std::uint32_t>(index_of(of_corner[corner]));
  }
  for (std::size_t v = 0; v < owned_.size(); ++v) {
    const auto begin = ids.begin() + first[v], end = ids.begin() + first[v + 1];
    std::sort(begin, end);
    std::ptrdiff_t best = 0;
    bool twins = false;
    for (auto run = begin; run != end;) {
      const auto next = std::upper_bound(run, end, *run);
      if (next - run > best) {
        best = next - run;
        owned_[v] = *run;
      }
      run = next;
    }
    for (auto id = begin; id != end; ++id) twins = twins || are_twins(*id, owned_[v]);
    if (twins) owned_[v] = kNone;
  }
  explicit_where_not_owned();
}

void Sharing::explicit_where_not_owned() {
  const std::vector<AttributeId>& of_corner = mesh_.layers[layer_].of_corner;
  for (std::size_t corner = 0; corner < of_corner.size(); ++corner) {
    const std::size_t v = index_of(mesh_.triangles[corner / 3][corner % 3]);
    if (owned_[v] != index_of(of_corner[corner])) explicit_[corner / 3] = 1;
  }
}

void Sharing::own_what_is_used(bool all) {
  const std::vector<AttributeId>& of_corner = mesh_.layers[layer_].of_corner;
  owned_.assign(owned_.size(), kNone);
  for (int pass = 0; pass < (all ? 2 : 1); ++pass) {
    for (std::size_t corner = 0; corner < of_corner.size(); ++corner) {
      const std::size_t v = index_of(mesh_.triangles[corner / 3][corner % 3]);
      if (pass == 0 ? explicit_[corner / 3] != 0 : owned_[v] != kNone) continue;
      owned_[v] = static_cast<std::uint32_t>(index_of(of_corner[corner]));
    }
  }
  if (all && mesh_.layers[layer_].value_count() > 0) {
    std::replace(owned_.begin(), owned_.end(), kNone, 0u);  // isolated vertices
  }
}

std::size_t Sharing::explicit_count() const {
  return static_cast<std::size_t>(std::count(explicit_.begin(), explicit_.end(), 1));
}

std::size_t Sharing::shared_count(std::span<const std::uint32_t> corners) const {
  return static_cast<std::size_t>(std::count_if(
      corners.begin(), corners.end(), [this](std::uint32_t c) { return explicit_[c / 3] == 0; }));
}

std::uint32_t Sharing::after(std::uint32_t id, std::span<const AttributeChange> changes) const {
  for (const AttributeChange& change : changes) {
    if (change.layer == layer_ && index_of(change.from) == id) {
      return static_cast<std::uint32_t>(index_of(change.to));
    }
  }
  return id;
}

void Sharing::demote(std::span<const std::uint32_t> corners) {
  for (std::uint32_t corner : corners) explicit_[corner / 3] = 1;
}

// DB03 8.2: when p is SN, q is NSN and an SN triangle survives, q is replaced by p.
bool Sharing::prefers_p(const Step& step, std::span<const AttributeChange> changes) const {
  const std::size_t at_p = shared_count(step.at_p);
  if (at_p == 0) return false;
  const std::size_t at_q = shared_count(step.at_q);
  if (at_q == 0) return true;
  const std::uint32_t owned_p = owned_[step.p_slot], owned_q = owned_[step.q_slot];
  const std::uint32_t after_p = after(owned_p, changes), after_q = after(owned_q, changes);
  if (after_p != after_q) return at_p > at_q;  // the fewer are demoted
  // Words of corner changes and of the own value, either way.
  const auto own_words = [this](std::uint32_t before, std::uint32_t now) {
    return before == now || are_twins(before, now) ? 0u : mesh_.layers[layer_].dimension;
  };
  const std::size_t keeping_p = step.at_q.size() + own_words(owned_p, after_p);
  const std::size_t keeping_q = step.at_p.size() + own_words(owned_q, after_q);
  return keeping_p < keeping_q;
}

void Sharing::contract(const Replay& replay, const Step& step, bool keep_p,
                       std::span<const AttributeChange> changes) {
  const std::vector<std::uint32_t>& at_kept = keep_p ? step.at_p : step.at_q;
  const std::vector<std::uint32_t>& at_removed = keep_p ? step.at_q : step.at_p;
  std::uint32_t& kept = owned_[keep_p ? step.p_slot : step.q_slot];
  const std::uint32_t removed = owned_[keep_p ? step.q_slot : step.p_slot];
  const std::size_t kept_count = shared_count(at_kept), removed_count = shared_count(at_removed);
  if (kept_count + removed_count == 0) return;  // nobody cares what the slot owns

  const std::uint32_t after_kept = after(kept, changes), after_removed = after(removed, changes);
  if (removed_count == 0) {
    kept = after_kept;
  } else if (kept_count == 0 || after_kept == after_removed) {
    kept = after_removed;
  } else if (kept_count >= removed_count) {
    demote(at_removed);
    kept = after_kept;
  } else {
    demote(at_kept);
    kept = after_removed;
  }

  if (has_twin_[kept] == 0) return;
  for (const std::vector<std::uint32_t>* corners : {&at_kept, &at_removed}) {
    for (std::uint32_t corner : *corners) {
      if (!are_twins(after(replay.attribute(layer_, corner), changes), kept)) continue;
      demote(at_kept);
      demote(at_removed);
      return;
    }
  }
}

}  // namespace crease
