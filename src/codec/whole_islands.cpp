#include "codec/whole_islands.h"

#include "codec/patch_geometry.h"
#include "hierarchy/island.h"
#include "mesh/disjoint_sets.h"

#include <algorithm>
#include <cstddef>
#include <tuple>

namespace crease::codec {

namespace {

// Of what its dearest contraction costs: those that cost less may be long before it.
constexpr double kWaitingShare = 0.05;

// By what is of one category at one vertex.
struct Spot {
  std::uint32_t vertex, category, triangle;
};

// Triangles of one category that have vertices in common, where there are several categories.
DisjointSets regions_of(const PatchMesh& mesh) {
  DisjointSets regions(mesh.triangles.size());
  constexpr std::uint32_t kUnknown = ~0u;
  std::vector<Spot> first_of_vertex(mesh.positions.size(), {kUnknown, 0, 0});
  std::vector<Spot> others;  // where a vertex has more than the category that it was first met with
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      Spot& first = first_of_vertex[v];
      if (first.vertex == kUnknown) first = {v, mesh.category[t], t};
      if (first.category == mesh.category[t]) {
        regions.unite(first.triangle, t);
      } else {
        others.push_back({v, mesh.category[t], t});
      }
    }
  }
  std::sort(others.begin(), others.end(), [](const Spot& a, const Spot& b) {
    return a.vertex != b.vertex ? a.vertex < b.vertex : a.category < b.category;
  });
  for (std::size_t i = 1; i < others.size(); ++i) {
    if (others[i].vertex != others[i - 1].vertex) continue;
    if (others[i].category == others[i - 1].category) {
      regions.unite(others[i].triangle, others[i - 1].triangle);
    }
  }
  return regions;
}

struct Island {
  std::uint32_t triangles = 0, vanishing = 0;
  double area = 0;
  Vec3d normal;  // of its first triangle
  bool is_flat = true, has_wall = false;
  double dearest = 0;

  bool may_be_one() const {
    return is_flat && vanishing == triangles && triangles <= kMostOfIsland;
  }
};

// Whether around them, or around what leads from them to it, something lies in their planes.
void find_walls(const PatchMesh& mesh, const PatchGeometry& geometry, DisjointSets& regions,
                std::vector<Island>& islands) {
  std::vector<std::uint32_t> island_near(mesh.positions.size(), kNone);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t own = regions.find(t);
    if (!islands[own].may_be_one()) continue;
    for (const std::uint32_t v : mesh.triangles[t]) island_near[v] = own;
  }
  for (const bool is_last : {false, true}) {
    const std::vector<std::uint32_t> near = island_near;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const Corners& corners = mesh.triangles[t];
      for (const std::uint32_t v : corners) {
        if (near[v] == kNone || regions.find(t) == near[v]) continue;
        Island& island = islands[near[v]];
        const Vec3d from = geometry.place(mesh.triangles[near[v]][0]);
        const double away = dot(island.normal, geometry.place(corners[0]) - from);
        island.has_wall |=
            are_parallel(island.normal, geometry.normal(t).unit) && is_in_plane(away, island.area);
        if (is_last) continue;
        for (const std::uint32_t w : corners) {
          if (island_near[w] == kNone) island_near[w] = near[v];
        }
      }
    }
  }
}

std::vector<Island> islands_of(const UnfoldedBlock& block,
                               std::span<const std::uint32_t> split_of_vanished,
                               std::span<const OrderedContraction> order, DisjointSets& regions) {
  const PatchMesh& mesh = block.end;
  const PatchGeometry geometry(mesh);
  std::vector<double> cost_of_split(block.splits.size(), 0);
  for (const OrderedContraction& c : order) cost_of_split[c.split] = c.cost;
  std::vector<Island> islands(mesh.triangles.size());  // by their first triangles
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    Island& island = islands[regions.find(t)];
    const ScaledNormal& normal = geometry.normal(t);
    if (island.triangles == 0) island.normal = normal.unit;
    island.is_flat = island.is_flat && are_parallel(island.normal, normal.unit);
    island.area += 0.5 * normal.size;
    ++island.triangles;
    if (split_of_vanished[t] == kNone) continue;
    ++island.vanishing;
    island.dearest = std::max(island.dearest, cost_of_split[split_of_vanished[t]]);
  }
  find_walls(mesh, geometry, regions, islands);
  return islands;
}

// What a contraction has to wait for: the dearest one of an island, which has a number.
struct Wait {
  double cost = 0;
  std::uint32_t island = 0;
  bool operator<(const Wait& o) const {
    return std::tie(cost, island) < std::tie(o.cost, o.island);
  }
};

// Per vertex of the fine end, that of the dearest island that it is of.
std::vector<Wait> waits_of(const UnfoldedBlock& block,
                           std::span<const std::uint32_t> split_of_vanished,
                           std::span<const OrderedContraction> order) {
  const PatchMesh& mesh = block.end;
  DisjointSets regions = regions_of(mesh);
  const std::vector<Island> islands = islands_of(block, split_of_vanished, order, regions);
  std::vector<Wait> waits(mesh.positions.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t number = regions.find(t);
    if (!islands[number].may_be_one() || !islands[number].has_wall) continue;
    for (const std::uint32_t v : mesh.triangles[t]) {
      waits[v] = std::max(waits[v], Wait{islands[number].dearest, number});
    }
  }
  return waits;
}

}  // namespace

void keep_islands_whole(const UnfoldedBlock& block,
                        std::span<const std::uint32_t> split_of_vanished,
                        std::vector<OrderedContraction>& order) {
  const std::vector<std::uint32_t>& category = block.end.category;
  const auto differs = [&](std::uint32_t other) { return other != category.front(); };
  if (std::find_if(category.begin(), category.end(), differs) == category.end()) return;

  std::vector<Wait> waits = waits_of(block, split_of_vanished, order);
  struct Ranked {
    Wait rank;
    OrderedContraction contraction;
  };
  std::vector<Ranked> ranked;
  ranked.reserve(order.size());
  std::vector<Wait> last(waits.size());  // per vertex, the rank of its last contraction so far
  for (OrderedContraction& c : order) {
    const std::uint32_t first = block.splits[c.split].vertex;
    const std::uint32_t second = block.second_child(c.split);
    const Wait wait = std::max(waits[first], waits[second]);
    Wait rank{c.cost, 0};
    if (c.cost >= kWaitingShare * wait.cost) rank = std::max(rank, wait);
    rank = std::max({rank, last[first], last[second]});  // parents wait for their children
    waits[first] = wait;
    last[first] = rank;
    ranked.push_back({rank, c});
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Ranked& a, const Ranked& b) { return a.rank < b.rank; });
  for (std::size_t i = 0; i < order.size(); ++i) {
    order[i] = ranked[i].contraction;
    order[i].cost = ranked[i].rank.cost;
  }
}

}  // namespace crease::codec
