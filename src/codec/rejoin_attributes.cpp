#include "codec/rejoin_attributes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace crease::codec {

namespace {

// Where p is on the way from a to b, 0 to 1; half way where there is no way.
double share_on_the_way(const Vec3i& p, const Vec3i& a, const Vec3i& b) {
  double along = 0, whole = 0;
  for (int k = 0; k < 3; ++k) {
    const double way = double(b[k]) - double(a[k]);
    along += way * (double(p[k]) - double(a[k]));
    whole += way * way;
  }
  return whole > 0 ? std::clamp(along / whole, 0.0, 1.0) : 0.5;
}

}  // namespace

AttributeRejoiner::AttributeRejoiner(std::span<const LayerSchema> layers,
                                     std::vector<ValuePool>& pools,
                                     std::vector<std::vector<std::uint32_t>> of_corner)
    : layers_(layers), pools_(pools), of_corner_(std::move(of_corner)) {
  is_derived_.assign(of_corner_.empty() ? 0 : of_corner_[0].size() / 3, 0);
  has_normals_ = std::any_of(layers.begin(), layers.end(), [](const LayerSchema& layer) {
    return layer.role == AttributeRole::Normal;
  });
}

CornerChanges AttributeRejoiner::rejoin(const UnfoldedBlock& block,
                                        std::span<const OrderedContraction> order,
                                        std::vector<WedgeValues> wedges) {
  CornerChanges all;
  all.changes_of.resize(order.size());
  all.derived_of.resize(order.size());
  if (layers_.empty()) return all;
  load(block, wedges);
  ContractingPatch patch(block.end);
  std::vector<std::uint32_t> splits_left(block.vertices.size(), 0);
  for (const Split& split : block.splits) ++splits_left[split.vertex];
  std::vector<Vec3i> positions = block.end.positions;
  const auto since = [](std::size_t first, std::size_t size) -> CornerChanges::Range {
    return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(size - first)};
  };
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::uint32_t first = block.splits[order[i].split].vertex;
    const std::uint32_t second = block.second_child(order[i].split);
    const bool is_last = --splits_left[first] == 0 && first < block.coarse_vertex_count;
    const Vec3i& parent = block.splits[order[i].split].parent_position;
    const Vec3i before = std::exchange(positions[first], parent);
    const auto vanished = patch.contract(first, second);
    const std::size_t first_change = all.changes.size(), first_derived = all.derived.size();
    derive(block, patch, first, all.derived);
    all.derived_of[i] = since(first_derived, all.derived.size());
    for (std::size_t l = 0; l < layers_.size(); ++l) {
      find_values(block, patch, first, l, wedges[l]);
      join(block, patch, vanished, first, second, l);
      if (is_last) {
        go_to_coarse(block, l);
      } else if (are_known(wedges[l])) {
        go_to_best(wedges[l], l);
      } else {
        blend(l, share_on_the_way(parent, before, positions[second]));
      }
      if (!is_last) part(block, l);
      record(l, all.changes);
    }
    all.changes_of[i] = since(first_change, all.changes.size());
  }
  // What no contraction touches, which a file of our own does not have.
  for (std::uint32_t t = 0; any_next_derived_ && t < block.coarse_triangle_count(); ++t) {
    if (order.empty() || normals_[t] != Normals::NextDerived || !block.coarse_derived[t]) continue;
    normals_[t] = Normals::Derived;
    all.derived.push_back(TriangleId{block.triangles[t]});
    ++all.derived_of.back().count;
  }
  store(block);
  return all;
}

void AttributeRejoiner::load(const UnfoldedBlock& block, std::span<const WedgeValues> wedges) {
  const std::size_t count = block.triangles.size();
  at_corners_.resize(layers_.size());
  for (std::size_t l = 0; l < layers_.size(); ++l) {
    at_corners_[l].resize(count);
    const std::vector<std::uint32_t>& wedge_of_corner = wedges[l].of_corner;
    for (std::size_t t = 0; t < count; ++t) {
      AtCorners& at = at_corners_[l][t];
      std::copy_n(&of_corner_[l][3 * std::size_t(block.triangles[t])], 3, at.ids.begin());
      if (wedge_of_corner.empty()) {
        at.wedges.fill(kNone);
      } else {
        std::copy_n(&wedge_of_corner[3 * t], 3, at.wedges.begin());
      }
    }
  }
  coarse_is_flat_.resize(layers_.size());
  for (std::size_t l = 0; l < layers_.size(); ++l) {
    coarse_is_flat_[l].resize(block.coarse_triangle_count());
    for (std::size_t t = 0; t < block.coarse_triangle_count(); ++t) {
      const CodedValue* coarse = &block.coarse_values[l][3 * t];
      coarse_is_flat_[l][t] = coarse[0] == coarse[1] && coarse[1] == coarse[2];
    }
  }
  normals_.assign(count, Normals::Stored);
  any_next_derived_ = false;
  for (std::size_t t = 0; has_normals_ && t < count; ++t) {
    if (is_derived_[block.triangles[t]]) {
      normals_[t] = Normals::Derived;
    } else if (block.end.derived[t] ||
               (t < block.coarse_triangle_count() && block.coarse_derived[t])) {
      normals_[t] = Normals::NextDerived;
      any_next_derived_ = true;
    }
  }
}

// Those that the coarse end does not have are met no more.
void AttributeRejoiner::store(const UnfoldedBlock& block) {
  for (std::size_t t = 0; t < block.coarse_triangle_count(); ++t) {
    const std::size_t of_model = block.triangles[t];
    for (std::size_t l = 0; l < layers_.size(); ++l) {
      std::copy_n(at_corners_[l][t].ids.begin(), 3, &of_corner_[l][3 * of_model]);
    }
    is_derived_[of_model] = normals_[t] == Normals::Derived;
  }
}

void AttributeRejoiner::derive(const UnfoldedBlock& block, const ContractingPatch& patch,
                               std::uint32_t v, std::vector<TriangleId>& derived) {
  if (!any_next_derived_) return;
  for (const std::uint32_t t : patch.around(v)) {
    if (normals_[t] != Normals::NextDerived) continue;
    normals_[t] = Normals::Derived;
    derived.push_back(TriangleId{block.triangles[t]});
  }
}

AttributeRejoiner::AtVertex* AttributeRejoiner::find(std::uint32_t id) {
  if (id >= place_of_id_.size()) return nullptr;
  const std::uint32_t place = place_of_id_[id];
  return place < at_vertex_.size() && at_vertex_[place].id == id ? &at_vertex_[place] : nullptr;
}

AttributeRejoiner::AtVertex& AttributeRejoiner::add(std::uint32_t id, std::uint32_t wedge) {
  if (id >= place_of_id_.size()) place_of_id_.resize(std::max<std::size_t>(2 * id, 1024), 0);
  const std::uint32_t place = place_of_id_[id] = static_cast<std::uint32_t>(at_vertex_.size());
  return at_vertex_.emplace_back(AtVertex{.id = id, .to = id, .wedge = wedge, .joined = place});
}

// Which values stand at v, and where each is to be looked up at the coarse end.
void AttributeRejoiner::find_values(const UnfoldedBlock& block, const ContractingPatch& patch,
                                    std::uint32_t v, std::size_t layer, const WedgeValues& wedges) {
  at_vertex_.clear();
  shown_.clear();
  std::uint32_t last = kNone;
  AtVertex* value = nullptr;
  const std::vector<char>& is_flat = coarse_is_flat_[layer];
  const std::span<const std::uint32_t> around = patch.around(v);
  const std::size_t from_first = around.size() - patch.moved_count();
  for (std::size_t i = 0; i < around.size(); ++i) {
    const std::uint32_t t = around[i];
    const std::uint32_t c = corner_of(patch.corners(t), v);
    AtCorners& at = at_corners_[layer][t];
    std::uint32_t& wedge = at.wedges[c];
    if (wedge != kNone) wedge = wedges.into[wedge];
    if (is_hidden(layer, t)) continue;
    const std::uint32_t id = at.ids[c];
    if (id != last) {  // mostly the next one has it too
      last = id;
      value = find(id);
      if (value == nullptr) value = &add(id, wedge);
    }
    shown_.push_back({&at.ids[c], static_cast<std::size_t>(value - at_vertex_.data())});
    ++value->corners[i >= from_first];
    if (t >= block.coarse_triangle_count()) continue;
    if (value->wanted == kNone) value->wanted = 3 * t + c;
    value->is_flat = value->is_flat || is_flat[t] != 0;
  }
}

// A collapsed triangle joins what it has at the two children, unless the coarse end has both apart:
// what is joined does not part again.
void AttributeRejoiner::join(const UnfoldedBlock& block, const ContractingPatch& patch,
                             std::span<const std::uint32_t> vanished, std::uint32_t first,
                             std::uint32_t second, std::size_t layer) {
  const std::vector<CodedValue>& coarse = block.coarse_values[layer];
  const auto wanted_of = [&](std::uint32_t joined) {
    std::uint32_t wanted = kNone;
    for (const AtVertex& value : at_vertex_) {
      if (value.joined == joined && value.wanted != kNone) wanted = value.wanted;
    }
    return wanted;
  };
  for (const std::uint32_t t : vanished) {
    if (is_hidden(layer, t)) continue;
    const std::array<std::uint32_t, 3>& ids = at_corners_[layer][t].ids;
    const AtVertex* a = find(ids[corner_of(patch.corners(t), first)]);
    const AtVertex* b = find(ids[corner_of(patch.corners(t), second)]);
    if (a == nullptr || b == nullptr || a->joined == b->joined) continue;
    const std::uint32_t low = std::min(a->joined, b->joined), high = std::max(a->joined, b->joined);
    const std::uint32_t of_low = wanted_of(low), of_high = wanted_of(high);
    if (of_low != kNone && of_high != kNone && coarse[of_low] != coarse[of_high]) continue;
    for (AtVertex& value : at_vertex_) {
      if (value.joined == high) value.joined = low;
    }
  }
}

void AttributeRejoiner::go_to_coarse(const UnfoldedBlock& block, std::size_t layer) {
  ValuePool& pool = pools_[layer];
  const std::vector<CodedValue>& coarse = block.coarse_values[layer];
  // Those that vanish in this block have no value at its coarse end; they go with their neighbours.
  std::vector<std::uint32_t>& wanted_of = scratch_;  // per joined
  wanted_of.assign(at_vertex_.size(), kNone);
  for (const AtVertex& value : at_vertex_) {
    if (value.wanted != kNone) wanted_of[value.joined] = value.wanted;
  }
  for (AtVertex& value : at_vertex_) {
    if (value.wanted == kNone) value.wanted = wanted_of[value.joined];
  }
  const auto stays = [&](const AtVertex& value) {
    return value.wanted == kNone || pool.code(value.id) == coarse[value.wanted];
  };
  std::vector<std::uint32_t>& goes_to = scratch_;  // per value at the vertex
  goes_to.assign(at_vertex_.size(), kNone);
  for (std::size_t i = 0; i < at_vertex_.size(); ++i) {
    if (stays(at_vertex_[i])) goes_to[i] = at_vertex_[i].id;
  }
  for (std::size_t i = 0; i < at_vertex_.size(); ++i) {
    AtVertex& value = at_vertex_[i];
    if (goes_to[i] != kNone) continue;
    const CodedValue& wanted = coarse[value.wanted];
    bool is_flat = value.is_flat;
    for (std::size_t k = 0; k < at_vertex_.size(); ++k) {
      const AtVertex& other = at_vertex_[k];
      if (other.joined != value.joined || other.wanted == kNone || coarse[other.wanted] != wanted) {
        continue;
      }
      is_flat = is_flat || other.is_flat;
      if (goes_to[k] != kNone) goes_to[i] = goes_to[k];
    }
    if (goes_to[i] == kNone) {
      goes_to[i] = is_flat ? pool.intern(wanted, ValuePool::kFlat) : kNone;
      // What is not joined stays apart, even if its value is the same.
      const bool is_taken = goes_to[i] == kNone || find(goes_to[i]) != nullptr ||
                            std::count(goes_to.begin(), goes_to.end(), goes_to[i]) > 1;
      if (is_taken) goes_to[i] = pool.add(wanted);
    }
    value.to = goes_to[i];
  }
}

void AttributeRejoiner::blend(std::size_t layer, double second_share) {
  ValuePool& pool = pools_[layer];
  std::vector<std::uint32_t>& members_of = scratch_;  // per joined
  members_of.assign(at_vertex_.size(), 0);
  for (const AtVertex& value : at_vertex_) ++members_of[value.joined];
  for (std::uint32_t i = 0; i < at_vertex_.size(); ++i) {
    if (members_of[i] < 2) continue;
    // The mean of each child's own, by corners.
    std::array<std::array<double, 4>, 2> sums{};
    std::array<double, 2> corners{};
    const std::size_t nearer = second_share > 0.5;
    const AtVertex* most = &at_vertex_[i];
    for (const AtVertex& value : at_vertex_) {
      if (value.joined != i) continue;
      if (value.corners[nearer] > most->corners[nearer]) most = &value;
      const std::span<const float> numbers = pool.value(value.id);
      for (std::size_t side = 0; side < 2; ++side) {
        corners[side] += value.corners[side];
        for (std::size_t k = 0; k < numbers.size(); ++k) {
          sums[side][k] += double(value.corners[side]) * double(numbers[k]);
        }
      }
    }
    std::uint32_t to = most->id;
    if (layers_[layer].interpolation != Interpolation::Categorical) {
      const std::array<double, 2> weights{
          corners[0] > 0 ? (corners[1] > 0 ? 1 - second_share : 1) / corners[0] : 0,
          corners[1] > 0 ? (corners[0] > 0 ? second_share : 1) / corners[1] : 0};
      std::array<double, 4> sum{};
      for (std::size_t k = 0; k < sum.size(); ++k) {
        sum[k] = weights[0] * sums[0][k] + weights[1] * sums[1][k];
      }
      if (layers_[layer].interpolation == Interpolation::Direction) {
        const double size = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
        for (std::size_t k = 0; k < 3; ++k) {
          sum[k] = size > 0 ? sum[k] / size : double(pool.value(most->id)[k]);
        }
      }
      std::array<float, 4> blended{};
      for (std::size_t k = 0; k < sum.size(); ++k) blended[k] = static_cast<float>(sum[k]);
      const CodedValue code =
          pool.nearest_code(std::span<const float>(blended).first(layers_[layer].dimension));
      // Of its own, whatever its value: what is not joined here may part at the coarse end.
      to = pool.code(most->id) == code ? most->id : pool.add(code);
    }
    for (AtVertex& value : at_vertex_) {
      if (value.joined == i) value.to = to;
    }
  }
}

bool AttributeRejoiner::are_known(const WedgeValues& wedges) const {
  if (at_vertex_.size() > kMostKnown) return false;
  return std::all_of(at_vertex_.begin(), at_vertex_.end(), [&](const AtVertex& value) {
    return value.wedge != kNone && wedges.is_known[value.wedge];
  });
}

void AttributeRejoiner::go_to_best(const WedgeValues& wedges, std::size_t layer) {
  ValuePool& pool = pools_[layer];
  const std::size_t dimension = layers_[layer].dimension;
  for (std::size_t i = 0; i < at_vertex_.size(); ++i) {
    const std::uint32_t wedge = at_vertex_[i].wedge, joined = at_vertex_[i].joined;
    const auto goes_along = [&](const AtVertex& value) {
      return value.wedge == wedge && value.joined == joined;
    };
    const std::span<const float> best = std::span(wedges.value[wedge]).first(dimension);
    std::size_t members = 0;
    bool is_done = false;
    std::uint32_t nearest = kNone;
    double nearest_away2 = 0;
    for (std::size_t k = 0; k < at_vertex_.size(); ++k) {
      if (!goes_along(at_vertex_[k])) continue;
      is_done = is_done || k < i;
      ++members;
      const std::span<const float> value = pool.value(at_vertex_[k].id);
      double away2 = 0;
      for (std::size_t j = 0; j < dimension; ++j) {
        const double away = double(value[j]) - double(best[j]);
        away2 += away * away;
      }
      if (nearest != kNone && !(away2 < nearest_away2)) continue;
      nearest = at_vertex_[k].id;
      nearest_away2 = away2;
    }
    if (is_done) continue;
    const double same = members == 1 ? wedges.same.moved : wedges.same.joined;
    std::uint32_t to = nearest;
    if (!(nearest_away2 <= same * same)) to = pool.add(pool.nearest_code(best));
    for (AtVertex& value : at_vertex_) {
      if (goes_along(value)) value.to = to;
    }
  }
}

void AttributeRejoiner::part(const UnfoldedBlock& block, std::size_t layer) {
  ValuePool& pool = pools_[layer];
  const std::vector<CodedValue>& coarse = block.coarse_values[layer];
  for (const AtVertex& value : at_vertex_) {
    const std::uint32_t shared = value.to;
    if (!pool.is_flat(shared) || value.wanted == kNone) continue;
    const CodedValue code = pool.code(shared);
    if (code == coarse[value.wanted]) continue;
    const std::uint32_t own = pool.add(code);
    for (AtVertex& other : at_vertex_) {
      if (other.to == shared) other.to = own;
    }
  }
}

void AttributeRejoiner::record(std::size_t layer, std::vector<AttributeChange>& changes) {
  for (const Shown& shown : shown_) *shown.id = at_vertex_[shown.value].to;
  for (const AtVertex& value : at_vertex_) {
    if (value.to == value.id) continue;
    changes.push_back(
        {static_cast<std::uint32_t>(layer), AttributeId{value.id}, AttributeId{value.to}});
  }
}

}  // namespace crease::codec
