#include "codec/whole_parts.h"

#include "codec/patch_geometry.h"
#include "hierarchy/resting_parts.h"
#include "hierarchy/whole_part.h"
#include "mesh/disjoint_sets.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace crease::codec {

namespace {

struct PartOfBlock {
  PartDamage damage_of_triangles;
  double damage = 0, loss = 0;  // of a part that vanishes
  std::uint32_t triangles = 0, vanishing = 0;
  double cost = 0;  // of each contraction once one has broken it
  bool is_broken = false;
  std::uint32_t first_place = 0;  // of what breaks it, in the order
};

// By their first vertices; the others stay empty.
std::vector<PartOfBlock> parts_of(const UnfoldedBlock& block, double radian,
                                  std::span<const std::uint32_t> vanished_of_split,
                                  DisjointSets& sets) {
  const PatchPlaces places(block.end);
  std::vector<PartOfBlock> parts(block.end.positions.size());
  for (std::size_t i = 0; i < block.splits.size(); ++i) {
    parts[sets.find(block.splits[i].vertex)].vanishing += vanished_of_split[i];
  }
  for (const Corners& t : block.end.triangles) ++parts[sets.find(t[0])].triangles;
  for (const Corners& t : block.end.triangles) {
    PartOfBlock& part = parts[sets.find(t[0])];
    if (part.vanishing != part.triangles) continue;
    part.damage_of_triangles.add(places.place(t[0]), places.place(t[1]), places.place(t[2]));
  }
  for (PartOfBlock& part : parts) {
    part.damage = part.damage_of_triangles.distances();
    part.loss = part.damage_of_triangles.all(radian);
  }
  return parts;
}

// Parts that would float without another one go before it, those on top of others first.
void hold_what_others_rest_on(const UnfoldedBlock& block, DisjointSets& sets,
                              std::vector<PartOfBlock>& parts) {
  const PatchPlaces places(block.end);
  std::vector<std::uint32_t> name, number(parts.size(), kNone);  // of those that have triangles
  std::vector<PartBox> boxes;
  for (const Corners& t : block.end.triangles) {
    std::uint32_t& own = number[sets.find(t[0])];
    if (own == kNone) {
      own = static_cast<std::uint32_t>(boxes.size());
      boxes.emplace_back();
      name.push_back(sets.find(t[0]));
    }
    for (const std::uint32_t v : t) boxes[own].add(places.place(v));
  }
  const std::vector<std::uint32_t> rests_on = only_contacts(boxes);
  constexpr int kMostOnEachOther = 4;
  for (int storey = 0; storey < kMostOnEachOther; ++storey) {
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
      if (rests_on[i] == kNone) continue;
      const PartOfBlock& upper = parts[name[i]];
      PartOfBlock& lower = parts[name[rests_on[i]]];
      if (!upper.is_broken || !lower.is_broken) continue;
      lower.cost = std::max(lower.cost, kAfter * upper.cost);
    }
  }
}

// Of a contraction in the new order.
struct Rank {
  double cost;
  std::uint32_t broken_part;  // its number and one, or 0
  std::uint32_t place;        // in the old order
  bool operator<(const Rank& o) const {
    return std::tie(cost, broken_part, place) < std::tie(o.cost, o.broken_part, o.place);
  }
};

}  // namespace

void keep_parts_whole(const UnfoldedBlock& block, std::span<const std::uint32_t> vanished_of_split,
                      double radian, std::vector<OrderedContraction>& order) {
  DisjointSets sets(block.end.positions.size());
  for (const Corners& t : block.end.triangles) {
    sets.unite(t[0], t[1]);
    sets.unite(t[0], t[2]);
  }
  for (std::size_t i = 0; i < block.splits.size(); ++i) {
    sets.unite(block.splits[i].vertex, block.second_child(i));
  }
  std::vector<PartOfBlock> parts = parts_of(block, radian, vanished_of_split, sets);
  std::vector<std::uint32_t> number_of(order.size());  // of each contraction's part
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    const std::uint32_t number = number_of[i] = sets.find(block.splits[order[i].split].vertex);
    PartOfBlock& part = parts[number];
    if (!part.is_broken && breaks_part(order[i].cost, part.damage, part.triangles)) {
      part.is_broken = true;
      part.first_place = i;
      part.cost = std::max(order[i].cost, price_of_part(part.loss, part.triangles));
    }
    part.triangles -= vanished_of_split[order[i].split];
  }
  hold_what_others_rest_on(block, sets, parts);

  std::vector<Rank> ranks;
  ranks.reserve(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    const PartOfBlock& part = parts[number_of[i]];
    const bool goes = part.is_broken && i >= part.first_place;
    ranks.push_back(goes ? Rank{part.cost, number_of[i] + 1, i} : Rank{order[i].cost, 0, i});
  }
  std::sort(ranks.begin(), ranks.end());

  std::vector<OrderedContraction> reordered;
  reordered.reserve(order.size());
  for (const Rank& rank : ranks) {
    reordered.push_back(order[rank.place]);
    reordered.back().cost = rank.cost;
  }
  order = std::move(reordered);
}

}  // namespace crease::codec
