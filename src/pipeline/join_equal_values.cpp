#include "pipeline/join_equal_values.h"

#include "codec/triangle_lists.h"
#include "crease/vec.h"
#include "hierarchy/attribute_values.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

namespace crease {

namespace {

constexpr std::uint32_t kNowhere = 0xffffffffu;

// Where a free code is looked for: in rings about a direction that are a code's size apart, or so.
constexpr int kMostRings = 32;
constexpr double kExactStep = 1e-6;
constexpr std::array<std::pair<double, double>, 8> kAround{
    {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};

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
  ValueJoiner(ContractionSequence& sequence, const Mesh& mesh, std::span<const LayerCoding> codings)
      : sequence_(sequence),
        mesh_(mesh),
        codings_(codings),
        quantizers_(codings.begin(), codings.end()),
        corners_(mesh.triangles),
        is_alive_(mesh.triangle_count(), 1),
        is_derived_(mesh.triangle_count(), 0) {
    for (const AttributeLayer& layer : mesh.layers) of_corner_.push_back(layer.of_corner);
    planned_ = of_corner_;
    for (std::uint32_t l = 0; l < mesh.layers.size(); ++l) {
      is_flat_.emplace_back(mesh.layers[l].value_count() +
                            new_value_count(mesh.layers[l], sequence, l));
      for (std::uint32_t t = 0; t < corners_.size(); ++t) note_flat(l, t);
    }
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

  // What only becomes equal keeps a value that it had, so that a hard edge between stays one; or
  // where those are others', gets one beside. Only what is no direction goes on as one as well.
  void join(std::uint32_t layer) {
    constexpr std::size_t kFew = 16;  // no more are looked at in pairs without need
    if (at_vertex_.size() < 2) return;
    const bool pairs = at_vertex_.size() <= kFew || several_are_equal(layer);
    if (pairs) join_flat(layer);
    for (const bool joins_another : {false, true}) {
      for (const AtVertex& value : at_vertex_) {
        if (value.to == value.from || is_there(value.to) != joins_another) continue;
        if (is_taken(layer, value, value.to)) part(layer, value.to);
      }
    }
    if (pairs) follow_equal(layer);
  }
  // What is flat and was equal at the two ends goes on as one: a reader has it as one.
  void join_flat(std::uint32_t layer) {
    const auto is_flat = [&](const AtVertex& value) {
      return is_flat_[layer][static_cast<std::uint32_t>(value.from)] != 0;
    };
    for (AtVertex& value : at_vertex_) {
      if (!is_flat(value)) continue;
      for (AtVertex& other : at_vertex_) {
        if (other.to == value.to || !is_flat(other)) continue;
        if (!equal(layer, other.from, value.from)) continue;
        AtVertex& follower = other.to == other.from ? value : other;
        follower.to = follower.to == value.to ? other.to : value.to;
      }
    }
  }
  // What becomes `to` still becomes one: a reader sees that triangles link it.
  void part(std::uint32_t layer, AttributeId to) {
    AttributeId apart = to;
    for (const AtVertex& member : at_vertex_) {
      if (member.to != to || member.from == to || is_taken(layer, member, member.from)) continue;
      apart = member.from;
      break;
    }
    if (apart == to) apart = free_value(layer, to);
    for (AtVertex& value : at_vertex_) {
      if (value.to == to && value.from != to) value.to = apart;
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
  bool is_there(AttributeId a) const { return value_from_.find(a) != kNowhere; }

  // Whether another attribute gets that value.
  bool is_taken(std::uint32_t layer, const AtVertex& value, AttributeId wanted) const {
    return std::any_of(at_vertex_.begin(), at_vertex_.end(), [&](const AtVertex& other) {
      return other.to != value.to && (other.from == wanted || equal(layer, other.to, wanted));
    });
  }

  // A new attribute next to one, with a code that nothing gets; or itself, if there is none.
  AttributeId free_value(std::uint32_t layer, AttributeId near) {
    const AttributeLayer& source = mesh_.layers[layer];
    if (source.interpolation != Interpolation::Direction || source.dimension != 3) return near;
    const auto value = attribute_value(source, sequence_, layer, near);
    const Vec3d n{value[0], value[1], value[2]};
    const Vec3d across = std::abs(n.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    const Vec3d u = normalized(cross(n, across)), v = cross(n, u);
    const LayerCoding& coding = codings_[layer];
    const double step =
        coding.kind == LayerCoding::Kind::Exact ? kExactStep : std::ldexp(1.0, -coding.bits);
    for (int ring = 1; ring <= kMostRings; ++ring) {
      for (const auto& [a, b] : kAround) {
        const Vec3d moved = normalized(n + u * (a * ring * step) + v * (b * ring * step));
        std::array<float, 3> candidate{float(moved.x), float(moved.y), float(moved.z)};
        quantizers_[layer].snap(candidate);
        const bool is_free =
            std::none_of(at_vertex_.begin(), at_vertex_.end(), [&](const AtVertex& other) {
              const auto taken = attribute_value(source, sequence_, layer, other.to);
              return std::memcmp(taken.data(), candidate.data(), sizeof candidate) == 0;
            });
        if (is_free) return add_value(layer, candidate);
      }
    }
    return near;
  }
  AttributeId add_value(std::uint32_t layer, std::span<const float> value) {
    const auto id = static_cast<std::uint32_t>(is_flat_[layer].size());
    std::vector<float>& values = sequence_.new_values[layer];
    values.insert(values.end(), value.begin(), value.end());
    is_flat_[layer].push_back(0);
    return AttributeId{id};
  }

  bool equal(std::uint32_t layer, AttributeId a, AttributeId b) const {
    const auto x = attribute_value(mesh_.layers[layer], sequence_, layer, a);
    const auto y = attribute_value(mesh_.layers[layer], sequence_, layer, b);
    return std::memcmp(x.data(), y.data(), x.size_bytes()) == 0;
  }

  // A reader has a value that all corners of some triangle have as one wherever it is.
  void note_flat(std::uint32_t layer, std::uint32_t t) {
    const AttributeId* ids = &of_corner_[layer][3 * std::size_t(t)];
    if (!equal(layer, ids[0], ids[1]) || !equal(layer, ids[1], ids[2])) return;
    for (std::size_t c = 0; c < 3; ++c) is_flat_[layer][static_cast<std::uint32_t>(ids[c])] = 1;
  }

  void apply(VertexId v, std::uint32_t layer) {
    for (const std::uint32_t t : around_[static_cast<std::uint32_t>(v)]) {
      if (!is_shown(layer, t)) continue;
      AttributeId& now = of_corner_[layer][corner(t, v)];
      now = at_vertex_[value_from_.find(now)].to;
      note_flat(layer, t);
    }
  }

  ContractionSequence& sequence_;
  const Mesh& mesh_;
  const std::span<const LayerCoding> codings_;
  const std::vector<LayerQuantizer> quantizers_;
  std::vector<Triangle> corners_;
  codec::TriangleLists around_;                      // per vertex
  std::vector<char> is_alive_, is_derived_;          // per triangle
  std::vector<std::vector<AttributeId>> of_corner_;  // per layer, joined
  std::vector<std::vector<char>> is_flat_;           // per layer and attribute
  std::vector<std::vector<AttributeId>> planned_;    // per layer, as the sequence had it
  // Scratch.
  std::vector<AtVertex> at_vertex_;
  NumberOfAttribute value_from_;   // in at_vertex_
  NumberOfAttribute change_from_;  // of the contraction and the layer
  std::vector<AttributeId> by_value_;
};

}  // namespace

void join_equal_values(ContractionSequence& sequence, const Mesh& snapped,
                       std::span<const LayerCoding> codings) {
  if (snapped.layers.empty()) {
    sequence.changes.clear();
    for (Contraction& c : sequence.contractions) c.first_change = c.change_count = 0;
    return;
  }
  ValueJoiner(sequence, snapped, codings).run();
}

}  // namespace crease
