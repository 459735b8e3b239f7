// What contracting a pair costs, and where the vertex that replaces it should stand.
#include "simplify/patch_simplifier.h"
#include "simplify/place_between.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

namespace crease::simplification {

namespace {

// Among contractions that cost nothing, short edges go first: they make the better triangles.
constexpr double kLengthShare = 1e-10;

// Between lines of flat faces the optimum must be this much cheaper than the better end: ends lie
// in the planes of their walls, and a vertex that has left them tears every later step.
constexpr double kLeavesPlanes = 0.3;

// The optimum stays within this many pair lengths of the pair's middle.
constexpr double kReach = 1.0;

// What a volume that is off counts, squared and by the area around, beside the distance to planes;
// of what the better place gains, folds and areas that change hands may take so much.
constexpr double kVolumeWeight = 40, kFoldsForVolume = 0.1;

// Of an area to the power 3/2: a volume that is left over is made up for later, but not one that a
// thin part has lost.
constexpr double kMostGrown = 0.02;

// Sets of at most eight: a byte for each member, with a bit for each member of its set.
class SmallSets {
 public:
  static constexpr std::uint32_t kMost = 8;

  std::uint32_t of(std::uint32_t i) const {
    return static_cast<std::uint32_t>(sets_ >> (8 * i)) & 0xff;
  }
  void unite(std::uint32_t i, std::uint32_t j) {
    const std::uint64_t everywhere = (of(i) | of(j)) * kEach;
    const std::uint64_t members = ((((everywhere & kAlone) + 0x7f * kEach) >> 7) & kEach) * 0xff;
    sets_ = (sets_ & ~members) | (everywhere & members);
  }

 private:
  static constexpr std::uint64_t kEach = 0x0101010101010101u, kAlone = 0x8040201008040201u;
  std::uint64_t sets_ = kAlone;
};

}  // namespace

inline double PatchSimplifier::layer_scale(std::size_t layer) const {
  const double unit = work_->layers[layer].length_per_unit;
  return unit * unit;
}

// The wedge's triangles, when the corner that they share carries `value`.
inline void PatchSimplifier::add_fixed_cost(std::size_t layer, const Wedge& wedge,
                                            const float* value, Quadric& sum) const {
  const int dimension = work_->layers[layer].dimension;
  if (wedge.quadric != kNone) {
    attribute_quadrics_[layer][wedge.quadric].add_fixed(sum, dimension, value, layer_scale(layer));
    return;
  }
  double away2 = 0;
  for (int j = 0; j < dimension; ++j) {
    const double away = double(wedge.value[j]) - double(value[j]);
    away2 += away * away;
  }
  sum.c += layer_scale(layer) * wedge.area * away2;
}

inline void PatchSimplifier::find_common(Index a, Index b, Joins& joins) const {
  const std::span<const Index> around = corners_of(a);
  Index* common = joins.common.start(around.size() + 1);
  for (Index corner : around) {  // two of many: no branch could foretell which
    const Index* others = others_of(corner);
    *common = corner;
    common += (others[0] == b) | (others[1] == b);
  }
  joins.common.finish(common);
}

// Calls unite(i, j) for wedges at two vertices with the same attribute, numbered as one list; none
// has an attribute twice.
template <typename Unite>
[[gnu::always_inline]] inline void PatchSimplifier::unite_equal(std::size_t layer, Slice wa,
                                                                Slice wb, Joins& joins,
                                                                Unite unite) const {
  constexpr std::size_t kFew = 400;  // comparisons
  constexpr Index kFewOfOne = 8;     // to sort the other's takes longer
  const Wedge* wedges = wedges_[layer].data();
  const auto id_of = [&](Index i) {
    return wedges[i < wa.count ? wa.first + i : wb.first + (i - wa.count)].id;
  };
  if (std::size_t(wa.count) * wb.count <= kFew || std::min(wa.count, wb.count) <= kFewOfOne) {
    for (Index i = 0; i < wa.count; ++i) {
      const Index id = id_of(i);
      for (Index j = wa.count; j < wa.count + wb.count; ++j) {
        if (id == id_of(j)) unite(i, j);
      }
    }
    return;
  }
  joins.by_id.resize(wa.count + wb.count);
  std::iota(joins.by_id.begin(), joins.by_id.end(), 0u);
  std::sort(joins.by_id.begin(), joins.by_id.end(),
            [&](Index i, Index j) { return id_of(i) < id_of(j); });
  for (std::size_t k = 1; k < joins.by_id.size(); ++k) {
    if (id_of(joins.by_id[k - 1]) == id_of(joins.by_id[k]))
      unite(joins.by_id[k - 1], joins.by_id[k]);
  }
}

// Which wedges at a and b become one: those that a vanishing triangle has at its two corners, and
// those that are the same attribute (equal index, same attribute). Members are indices
// into wedges_[layer].
CREASE_WIDE void PatchSimplifier::join_wedges(std::size_t layer, Index a, Index b,
                                              Joins& joins) const {
  const Slice wa = wedges_of(layer, a), wb = wedges_of(layer, b);
  const Wedge* wedges = wedges_[layer].data();
  const Index n = wa.count + wb.count;
  Index* members = joins.members.start(n);
  Joined* joined = joins.joined.start(n);
  joins.members.finish(members + n);
  if (wa.count == 1 && wb.count == 1) {
    const Wedge &x = wedges[wa.first], &y = wedges[wb.first];
    members[0] = wa.first;
    members[1] = wb.first;
    if (x.id == y.id || (!(x.pinned && y.pinned) && !joins.common.empty())) {
      *joined++ = {0, 2, x.pinned ? wa.first : y.pinned ? wb.first : kNone};
    } else {
      *joined++ = {0, 1, x.pinned ? wa.first : kNone};
      *joined++ = {1, 1, y.pinned ? wb.first : kNone};
    }
    joins.joined.finish(joined);
    return;
  }

  const Index* wedge_of_corner = wedge_of_corner_[layer].data();
  const auto unite_common = [&](auto unite) __attribute__((always_inline)) {
    for (Index corner : joins.common) {
      const Index after = corner_after(corner), before = corner_before(corner);
      const Index at_a = wedge_of_corner[corner];
      const Index at_b = wedge_of_corner[vertex_of_corner_[after] == b ? after : before];
      unite(at_a - wa.first, wa.count + (at_b - wb.first));
    }
  };
  const auto wedge_at = [&](Index i) {
    return i < wa.count ? wa.first + i : wb.first + (i - wa.count);
  };

  // Set by set, in the order of their first members.
  if (n <= SmallSets::kMost) {
    SmallSets sets;
    const Wedge *of_a = wedges + wa.first, *of_b = wedges + wb.first;
    std::uint32_t pinned = 0;
    for (Index j = 0; j < wb.count; ++j) pinned |= std::uint32_t(of_b[j].pinned) << j;
    pinned <<= wa.count;
    for (Index i = 0; i < wa.count; ++i) {
      pinned |= std::uint32_t(of_a[i].pinned) << i;
      for (Index j = 0; j < wb.count; ++j) {
        if (of_a[i].id == of_b[j].id) sets.unite(i, wa.count + j);
      }
    }
    unite_common([&](Index i, Index j) { sets.unite(i, j); });
    Index first = 0;
    for (std::uint32_t rest = (1u << n) - 1; rest != 0;) {
      const std::uint32_t set = sets.of(static_cast<std::uint32_t>(std::countr_zero(rest)));
      rest &= ~set;
      Index end = first;
      for (std::uint32_t left = set; left != 0; left &= left - 1) {
        members[end++] = wedge_at(static_cast<Index>(std::countr_zero(left)));
      }
      const std::uint32_t fixed = pinned & set;
      if ((fixed & (fixed - 1)) == 0) {
        *joined++ = {first, end - first,
                     fixed != 0 ? wedge_at(static_cast<Index>(std::countr_zero(fixed))) : kNone};
      } else {
        joined = join_pinned(layer, first, end, joined, joins);
      }
      first = end;
    }
    joins.joined.finish(joined);
    return;
  }

  // Union-find, where every set's root is the first of it.
  Index* parent = joins.parent.start(n);
  std::iota(parent, parent + n, 0u);
  const auto root = [&](Index i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  const auto unite = [&](Index i, Index j) {
    i = root(i);
    j = root(j);
    parent[std::max(i, j)] = std::min(i, j);
  };
  unite_equal(layer, wa, wb, joins, unite);
  unite_common(unite);
  Index* place =
      joins.place_of_set.start(n);  // of a root: how many it has, then where the next one goes
  std::fill_n(place, n, 0u);
  for (Index i = 0; i < n; ++i) {
    parent[i] = parent[parent[i]];
    ++place[parent[i]];
  }
  Index next = 0;
  for (Index i = 0; i < n; ++i) {
    if (parent[i] == i) next += std::exchange(place[i], next);
  }
  for (Index i = 0; i < n; ++i) members[place[parent[i]]++] = wedge_at(i);
  for (Index first = 0, i = 0; first < n; ++i) {
    if (parent[i] != i) continue;
    joined = join_pinned(layer, first, place[i], joined, joins);
    first = place[i];
  }
  joins.joined.finish(joined);
}

// Writes what becomes of a set of joins.members, of which any number are pinned; returns the end.
PatchSimplifier::Joined* PatchSimplifier::join_pinned(std::size_t layer, Index first, Index end,
                                                      Joined* joined, Joins& joins) const {
  const Wedge* wedges = wedges_[layer].data();
  Index* members = joins.members.begin();
  Index fixed = kNone;
  bool several_fixed = false;
  for (Index k = first; k < end; ++k) {
    const Index w = members[k];
    if (!wedges[w].pinned) continue;
    if (fixed == kNone) fixed = w;
    several_fixed = several_fixed || wedges[fixed].id != wedges[w].id;
  }
  if (!several_fixed) {
    *joined++ = {first, end - first, fixed};
    return joined;
  }
  // Two face normals would become one: neither may change (DB03 rule b), so each stays as it is.
  // Equal attributes are still one wedge.
  std::sort(members + first, members + end, [&](Index x, Index y) {
    return wedges[x].id != wedges[y].id ? wedges[x].id < wedges[y].id : x < y;
  });
  while (first < end) {
    Index after = first + 1;
    while (after < end && wedges[members[after]].id == wedges[members[first]].id) ++after;
    *joined++ = {first, after - first, members[first]};
    first = after;
  }
  return joined;
}

[[gnu::always_inline]] inline void PatchSimplifier::add_attribute_costs(Index a, Index b,
                                                                        Quadric& sum,
                                                                        Joins& joins) const {
  bool knows_common = false;
  for (std::size_t l = 0; l < layer_count(); ++l) {
    const WorkLayer& layer = work_->layers[l];
    if (!layer.steers) continue;
    // Face normals stay what they are (DB03 b); what they cost is in flat_shading.cpp.
    if (layer.is_normal && vertices_[a].flat_around && vertices_[b].flat_around) continue;
    const double scale = layer_scale(l);
    const std::vector<Wedge>& wedges = wedges_[l];
    const std::vector<AttributeQuadric>& quadrics = attribute_quadrics_[l];
    const Slice wa = wedges_of(l, a), wb = wedges_of(l, b);
    if (wa.count == 1 && wb.count == 1) {
      // The ordinary case: inside a smooth surface, or on a flat one.
      const Wedge &x = wedges[wa.first], &y = wedges[wb.first];
      if (!x.pinned && !y.pinned && x.quadric != kNone && y.quadric != kNone) {
        AttributeQuadric::add_reduced_pair(quadrics[x.quadric], quadrics[y.quadric],
                                           layer.dimension, sum, scale);
        continue;
      }
      if (x.id == y.id) {
        add_fixed_cost(l, x, x.value, sum);
        add_fixed_cost(l, y, x.value, sum);
        continue;
      }
    }
    if (!knows_common) find_common(a, b, joins);
    knows_common = true;
    join_wedges(l, a, b, joins);
    for (const Joined& joined : joins.joined) {
      const Index* members = &joins.members[joined.first_member];
      if (joined.fixed != kNone) {
        for (Index k = 0; k < joined.member_count; ++k) {
          add_fixed_cost(l, wedges[members[k]], wedges[joined.fixed].value, sum);
        }
      } else if (joined.member_count == 1) {
        const Wedge& wedge = wedges[members[0]];
        if (wedge.quadric != kNone) {
          quadrics[wedge.quadric].add_reduced(sum, layer.dimension, scale);
        }
      } else {
        const Index first = wedges[members[0]].quadric, second = wedges[members[1]].quadric;
        const bool both = first != kNone && second != kNone;
        AttributeQuadric all = both ? quadrics[first] + quadrics[second] : AttributeQuadric{};
        for (Index k = both ? 2 : 0; k < joined.member_count; ++k) {
          add_quadric(l, wedges[members[k]], all);
        }
        all.add_reduced(sum, layer.dimension, scale);
      }
    }
  }
}

// With Placement::Endpoint the attributes are inherited from the end that stays, where it has one.
void PatchSimplifier::add_endpoint_attribute_costs(Index kept, Index removed, Quadric& sum,
                                                   Joins& joins) const {
  find_common(kept, removed, joins);
  for (std::size_t l = 0; l < layer_count(); ++l) {
    const WorkLayer& layer = work_->layers[l];
    if (!layer.steers) continue;
    join_wedges(l, kept, removed, joins);
    for (const Joined& joined : joins.joined) {
      const Index* members = &joins.members[joined.first_member];
      const Index inherited = joined.fixed != kNone ? joined.fixed : members[0];
      for (Index k = 0; k < joined.member_count; ++k) {
        add_fixed_cost(l, wedges_[l][members[k]], wedges_[l][inherited].value, sum);
      }
    }
  }
}

// Of the surfaces and lines at both.
inline Quadric PatchSimplifier::sum_of(Index a, Index b) const {
  Quadric sum = surface_[a] + surface_[b];
  for (Index v : {a, b}) {
    if (line_of_vertex_[v] != kNone) {
      sum.add_scaled(line_[line_of_vertex_[v]], steering_.line_weight);
    }
  }
  return sum;
}

inline void PatchSimplifier::add_turns(Index a, Index b, Quadric& sum) const {
  if (turn_.empty()) return;
  sum.add(turn_[a]);
  sum.add(turn_[b]);
}

CREASE_WIDE PatchSimplifier::Placed PatchSimplifier::place(Index a, Index b, double bound,
                                                           Joins& joins) const {
  const Vec3d &pa = positions_[a], &pb = positions_[b];
  const Vec3d along = pb - pa;
  const double length2 = dot(along, along);
  Quadric sum = sum_of(a, b);
  const double tie = kLengthShare * length2 * sum.weight;
  const auto placed_at = [&](const Vec3d& x, double cost, const Quadric& free) {
    Placed placed{cost + tie, cost + tie, x};
    if (!turn_.empty() && placed.cost <= bound) {
      placed.free_cost = std::min(placed.cost, free.at(x));
    }
    return placed;
  };

  if (steering_.placement == Placement::Endpoint) {
    Quadric if_a = sum, if_b = sum;
    add_endpoint_attribute_costs(a, b, if_a, joins);
    add_endpoint_attribute_costs(b, a, if_b, joins);
    const Quadric free_a = if_a, free_b = if_b;
    add_turns(a, b, if_a);
    add_turns(a, b, if_b);
    const double cost_a = if_a.at(pa), cost_b = if_b.at(pb);
    return cost_a < cost_b ? placed_at(pa, cost_a, pa == pb ? free_b : free_a)
                           : placed_at(pb, cost_b, free_b);
  }

  add_attribute_costs(a, b, sum, joins);
  const Quadric free = sum;
  add_turns(a, b, sum);
  const Chosen chosen = choose(sum, a, b, bound);
  return placed_at(chosen.position, chosen.cost, free);
}

// The place that is worth the bits that a file takes for it: an end, between them, or the best. An
// end where nothing costs less than `bound`.
inline PatchSimplifier::Chosen PatchSimplifier::choose(const Quadric& sum, Index a, Index b,
                                                       double bound) const {
  const Vec3d &pa = positions_[a], &pb = positions_[b];
  const double cost_a = sum.at(pa), cost_b = sum.at(pb);
  const Chosen end = cost_a < cost_b ? Chosen{pa, cost_a} : Chosen{pb, cost_b};
  const Vec3d along = pb - pa;
  const double length2 = dot(along, along);
  const double share = is_corner(a) && is_corner(b) ? kLeavesPlanes : 1;
  const double noise = kLengthShare * length2 * sum.weight + kGridNoise * kGridNoise * sum.weight;
  const double most = steering_.leaves_ends * share * end.cost - noise;
  if (!(most > 0)) return end;  // as on planes: no cost is less
  const Vec3d middle = (pa + pb) * 0.5;
  Vec3d x = sum.minimum(middle, steering_.pull);
  // The pull, and rounding to a coarse grid, make this more than the least there is.
  if (!(sum.at(x) <= 1.5 * bound)) return end;
  const Vec3d away = x - middle;
  const double away2 = dot(away, away);
  if (away2 > kReach * kReach * length2) x = middle + away * (kReach * std::sqrt(length2 / away2));
  x = rounded(x);
  const double cost_x = sum.at(x);
  if (!(cost_x < most)) return end;
  const PlaceBetween between = place_between(sum, pa, pb, cost_a, steering_.pull);
  const Chosen near = between.cost < most ? Chosen{between.position, between.cost} : end;
  return cost_x < steering_.leaves_pair * share * near.cost - noise ? Chosen{x, cost_x} : near;
}

PatchSimplifier::Volume PatchSimplifier::volume_between(Index a, Index b) const {
  Volume volume;
  const auto add = [&](Index t, const Vec3d& from) {
    const Facing& facing = facing_[t];
    const Vec3d third = facing.normal * (facing.area / 3);
    volume.gradient = volume.gradient + third;
    volume.offset -= dot(third, from);
    volume.area += facing.area;
  };
  for (std::size_t i = 0; i < ring_.size(); ++i) {
    add(ring_[i].triangle, positions_[i < ring_kept_ ? a : b]);
  }
  for (const Vanishing& vanishing : vanishing_) add(vanishing.triangle, positions_[a]);
  return volume;
}

// Chooses the place again, now that the triangles around the pair are known (find_ring()): the
// triangles between vertices that lie on a surface cut off what bends outward, and quadrics move
// vertices by only half of what it takes to make up for that. Where the volume stays what it is
// (Lindstrom and Turk 1998) as much of the surface is above the triangles as below. Returns by how
// much it has grown with that. Corners of flat faces stay in their planes.
CREASE_WIDE float PatchSimplifier::keep_volume(Index a, Index b, Placed& placed) {
  if (steering_.placement == Placement::Endpoint || ring_.empty()) return 0;
  if (is_corner(a) && is_corner(b)) return 0;
  Volume volume = volume_between(a, b);
  if (!(volume.area > 0)) return 0;
  const double most_grown = kMostGrown * volume.area * std::sqrt(volume.area);
  volume.offset += std::clamp(double(grown_[a]) + double(grown_[b]), -most_grown, most_grown);
  const Vec3d& now = placed.position;
  const double grown = dot(volume.gradient, now) + volume.offset;
  const bool at_end = now == positions_[a] || now == positions_[b];
  if (at_end && steering_.stays_at_ends) return static_cast<float>(grown);
  const double scale = kVolumeWeight / volume.area;
  Quadric sum = sum_of(a, b);
  if (scale * grown * grown <= kGridNoise * kGridNoise * sum.weight) {
    return static_cast<float>(grown);
  }
  add_attribute_costs(a, b, sum, joins_);
  add_turns(a, b, sum);
  sum.add_plane(volume.gradient, volume.offset, scale);
  const Chosen chosen = choose(sum, a, b, std::numeric_limits<double>::infinity());
  const double gain = sum.at(now) - chosen.cost;
  if (!(gain > 0) || chosen.position == now) return static_cast<float>(grown);
  const double most = ring_cost(a, b, now, HUGE_VAL) + kFoldsForVolume * gain;
  if (!(ring_cost(a, b, chosen.position, most) <= most)) return static_cast<float>(grown);
  placed.position = chosen.position;
  return static_cast<float>(dot(volume.gradient, chosen.position) + volume.offset);
}

// At a, at b, and in the middle.
CREASE_WIDE void PatchSimplifier::find_costs_of_others(Candidate& pair) {
  const Index a = pair.a, b = pair.b;
  const Vec3d &pa = positions_[a], &pb = positions_[b];
  Quadric sum = sum_of(a, b);
  if (steering_.placement == Placement::Endpoint) {
    Quadric if_b = sum;
    add_endpoint_attribute_costs(a, b, sum, joins_);
    add_endpoint_attribute_costs(b, a, if_b, joins_);
    pair.cost_of_other[1] = if_b.at(pb);
  } else {
    add_attribute_costs(a, b, sum, joins_);
    pair.cost_of_other[1] = sum.at(pb);
  }
  pair.cost_of_other[0] = sum.at(pa);
  pair.cost_of_other[2] = sum.at(rounded((pa + pb) * 0.5));
}

}  // namespace crease::simplification
