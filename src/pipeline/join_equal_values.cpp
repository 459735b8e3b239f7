#include "pipeline/join_equal_values.h"

#include "codec/triangle_lists.h"
#include "hierarchy/attribute_values.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

namespace crease {

namespace {

constexpr std::uint32_t kNowhere = 0xffffffffu;

// Numbers by attribute: a hash table that is filled anew for every vertex.
class NumberOfAttribute {
 public:
  void start(std::size_t most) {
    entries_.assign(std::bit_ceil(2 * most + 2), {AttributeId{}, kNowhere});
  }
  std::uint32_t find(AttributeId a) const { return entries_[place_of(a)].number; }
  // False if it had one.
  bool add(AttributeId a, std::uint32_t number) {
    Entry& entry = entries_[place_of(a)];
    if (entry.number != kNowhere) return false;
    entry = {a, number};
    return true;
  }

 private:
  struct Entry {
    AttributeId attribute;
    std::uint32_t number;
  };
  std::size_t place_of(AttributeId a) const {
    const std::size_t mask = entries_.size() - 1;
    std::size_t i = (static_cast<std::uint32_t>(a) * 0x9e3779b1u >> 8) & mask;
    while (entries_[i].number != kNowhere && entries_[i].attribute != a) i = (i + 1) & mask;
    return i;
  }
  std::vector<Entry> entries_;
};

class ValueJoiner {
 public:
  ValueJoiner(ContractionSequence& sequence, const Mesh& mesh)
      : sequence_(sequence),
        mesh_(mesh),
        corners_(mesh.triangles),
        is_alive_(mesh.triangle_count(), 1),
        is_derived_(mesh.triangle_count(), 0) {
    for (const AttributeLayer& layer : mesh.layers) of_corner_.push_back(layer.of_corner);
    planned_ = of_corner_;
    around_.resize(mesh.vertex_count());
    for (std::uint32_t t = 0; t < corners_.size(); ++t) {
      for (const VertexId v : corners_[t]) around_.add(static_cast<std::uint32_t>(v), t);
    }
  }

  void run() {
    std::vector<AttributeChange> changes;
    for (Contraction& c : sequence_.contractions) {
      contract(c);
      for (TriangleId t : sequence_.derived_of(c)) is_derived_[index_of(t)] = 1;
      const auto first = static_cast<std::uint32_t>(changes.size());
      for (std::uint32_t l = 0; l < mesh_.layers.size(); ++l) {
        find_values(c, l);
        join(l);
        for (const AtVertex& value : at_vertex_) {
          if (value.to != value.from) changes.push_back({l, value.from, value.to});
        }
        apply(c.kept, l);
      }
      c.first_change = first;
      c.change_count = static_cast<std::uint32_t>(changes.size()) - first;
    }
    sequence_.changes = std::move(changes);
  }

 private:
  struct AtVertex {
    AttributeId from{}, to{};
  };

  void contract(const Contraction& c) {
    const auto removed = static_cast<std::uint32_t>(c.removed);
    const auto kept = static_cast<std::uint32_t>(c.kept);
    for (std::size_t i = 0; i < around_[removed].size(); ++i) {
      const std::uint32_t t = around_[removed][i];
      if (!is_alive_[t]) continue;
      Triangle& corners = corners_[t];
      if (std::find(corners.begin(), corners.end(), c.kept) != corners.end()) {
        is_alive_[t] = 0;
      } else {
        std::replace(corners.begin(), corners.end(), c.removed, c.kept);
        around_.add(kept, t);
      }
    }
    around_.clear(removed);
    around_.remove_if(kept, [this](std::uint32_t t) { return !is_alive_[t]; });
  }

  bool is_shown(std::uint32_t layer, std::uint32_t t) const {
    return mesh_.layers[layer].role != AttributeRole::Normal || !is_derived_[t];
  }
  std::size_t corner(std::uint32_t t, VertexId v) const {
    const Triangle& corners = corners_[t];
    return 3 * std::size_t(t) + (corners[0] == v ? 0 : corners[1] == v ? 1 : 2);
  }

  // What stands at v_s, and what the sequence makes of it.
  void find_values(const Contraction& c, std::uint32_t layer) {
    at_vertex_.clear();
    const std::span<const AttributeChange> all_changes = sequence_.changes_of(c);
    change_from_.start(all_changes.size());
    for (std::uint32_t i = 0; i < all_changes.size(); ++i) {
      if (all_changes[i].layer == layer) change_from_.add(all_changes[i].from, i);
    }
    const std::span<const std::uint32_t> around = around_[static_cast<std::uint32_t>(c.kept)];
    value_from_.start(around.size());
    for (const std::uint32_t t : around) {
      if (!is_shown(layer, t)) continue;
      const std::size_t at = corner(t, c.kept);
      AttributeId& planned = planned_[layer][at];
      if (const std::uint32_t i = change_from_.find(planned); i != kNowhere) {
        planned = all_changes[i].to;
      }
      const AttributeId now = of_corner_[layer][at];
      if (value_from_.add(now, static_cast<std::uint32_t>(at_vertex_.size()))) {
        at_vertex_.push_back({now, planned});
      }
    }
  }

  // Whether different attributes of those that stand there, or will, have the same value.
  bool several_are_equal(std::uint32_t layer) {
    by_value_.clear();
    for (const AtVertex& value : at_vertex_) {
      by_value_.push_back(value.from);
      by_value_.push_back(value.to);
    }
    const std::size_t size = sizeof(float) * mesh_.layers[layer].dimension;
    const auto bytes = [&](AttributeId a) {
      return attribute_value(mesh_.layers[layer], sequence_, layer, a).data();
    };
    std::sort(by_value_.begin(), by_value_.end(), [&](AttributeId a, AttributeId b) {
      const int order = a == b ? 0 : std::memcmp(bytes(a), bytes(b), size);
      return order != 0 ? order < 0 : a < b;
    });
    for (std::size_t i = 1; i < by_value_.size(); ++i) {
      if (by_value_[i - 1] != by_value_[i] && equal(layer, by_value_[i - 1], by_value_[i])) {
        return true;
      }
    }
    return false;
  }

  // What was equal at the two ends goes on as one. What only becomes equal keeps the value that it
  // had, so that a hard edge between stays one; or where that is another's, goes on as one as well.
  void join(std::uint32_t layer) {
    constexpr std::size_t kFew = 16;  // no more are looked at in pairs without need
    if (at_vertex_.size() < 2) return;
    const bool pairs = at_vertex_.size() <= kFew || several_are_equal(layer);
    if (pairs) join_equal(layer);
    for (AtVertex& value : at_vertex_) {
      if (value.to != value.from && is_taken(layer, value, value.to)) {
        if (!is_taken(layer, value, value.from)) value.to = value.from;
      }
    }
    if (pairs) follow_equal(layer);
  }
  void join_equal(std::uint32_t layer) {
    for (AtVertex& value : at_vertex_) {
      for (AtVertex& other : at_vertex_) {
        if (other.to == value.to || !equal(layer, other.from, value.from)) continue;
        AtVertex& follower = other.to == other.from ? value : other;
        follower.to = follower.to == value.to ? other.to : value.to;
      }
    }
  }
  void follow_equal(std::uint32_t layer) {
    for (AtVertex& value : at_vertex_) {
      for (const AtVertex& other : at_vertex_) {
        if (other.to == value.to || !equal(layer, other.to, value.to)) continue;
        const bool other_stays = other.to == other.from, stays = value.to == value.from;
        const bool is_before = &other < &value;
        if (other_stays > stays || (other_stays == stays && is_before)) value.to = other.to;
      }
    }
  }

  // Whether another attribute has, or had, that value.
  bool is_taken(std::uint32_t layer, const AtVertex& value, AttributeId wanted) const {
    return std::any_of(at_vertex_.begin(), at_vertex_.end(), [&](const AtVertex& other) {
      if (&other == &value || other.to == value.to) return false;
      return equal(layer, other.to, wanted) || equal(layer, other.from, wanted);
    });
  }

  bool equal(std::uint32_t layer, AttributeId a, AttributeId b) const {
    const auto x = attribute_value(mesh_.layers[layer], sequence_, layer, a);
    const auto y = attribute_value(mesh_.layers[layer], sequence_, layer, b);
    return std::memcmp(x.data(), y.data(), x.size_bytes()) == 0;
  }

  void apply(VertexId v, std::uint32_t layer) {
    for (const std::uint32_t t : around_[static_cast<std::uint32_t>(v)]) {
      if (!is_shown(layer, t)) continue;
      AttributeId& now = of_corner_[layer][corner(t, v)];
      now = at_vertex_[value_from_.find(now)].to;
    }
  }

  ContractionSequence& sequence_;
  const Mesh& mesh_;
  std::vector<Triangle> corners_;
  codec::TriangleLists around_;                      // per vertex
  std::vector<char> is_alive_, is_derived_;          // per triangle
  std::vector<std::vector<AttributeId>> of_corner_;  // per layer, joined
  std::vector<std::vector<AttributeId>> planned_;    // per layer, as the sequence had it
  // Scratch.
  std::vector<AtVertex> at_vertex_;
  NumberOfAttribute value_from_;   // in at_vertex_
  NumberOfAttribute change_from_;  // of the contraction and the layer
  std::vector<AttributeId> by_value_;
};

}  // namespace

void join_equal_values(ContractionSequence& sequence, const Mesh& snapped) {
  if (snapped.layers.empty()) {
    sequence.changes.clear();
    for (Contraction& c : sequence.contractions) c.first_change = c.change_count = 0;
    return;
  }
  ValueJoiner(sequence, snapped).run();
}

}  // namespace crease
