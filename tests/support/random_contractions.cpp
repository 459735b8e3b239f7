#include "support/random_contractions.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

namespace crease {

namespace {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(engine_() % n); }
  bool chance(double p) { return unit() < p; }
  double unit() { return double(engine_() >> 11) / 9007199254740992.0; }
  float signed_unit() { return static_cast<float>(2 * unit() - 1); }

 private:
  std::mt19937_64 engine_;
};

std::vector<float> random_value(Random& random, const AttributeLayer& layer) {
  std::vector<float> value(layer.dimension);
  for (float& f : value) f = random.signed_unit();
  if (layer.interpolation != Interpolation::Direction) return value;
  float square = 0;
  for (float f : value) square += f * f;
  if (square == 0) return {0, 0, 1};
  for (float& f : value) f /= std::sqrt(square);
  return value;
}

class Generator {
 public:
  Generator(const Mesh& mesh, const Grid& grid, const RandomContractionOptions& options)
      : mesh_(mesh), options_(options), random_(options.seed) {
    sequence_.grid = grid;
    sequence_.placement = options.placement;
    sequence_.new_values.resize(mesh.layers.size());
    triangles_ = mesh.triangles;
    alive_.assign(mesh.triangle_count(), true);
    derived_.assign(mesh.triangle_count(), false);
    around_.resize(mesh.vertex_count());
    errors_.resize(mesh.vertex_count());
    for (const Vec3d& p : mesh.positions) positions_.push_back(grid.nearest(p));
    for (const AttributeLayer& layer : mesh.layers) {
      of_corner_.push_back(layer.of_corner);
      value_counts_.push_back(layer.value_count());
    }
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
      for (VertexId v : triangles_[t]) around_[index_of(v)].push_back(t);
      live_triangles_.push_back(t);
    }
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) live_vertices_.push_back(v);
  }

  ContractionSequence run() {
    while (live_vertices_.size() > 1) contract();
    return std::move(sequence_);
  }

 private:
  using Pair = std::pair<std::uint32_t, std::uint32_t>;

  Pair choose_pair() {
    if (!live_triangles_.empty() && !random_.chance(options_.virtual_share)) {
      const Triangle& t = triangles_[live_triangles_[random_.below(live_triangles_.size())]];
      const std::size_t c = random_.below(3);
      return {static_cast<std::uint32_t>(index_of(t[c])),
              static_cast<std::uint32_t>(index_of(t[(c + 1) % 3]))};
    }
    const std::size_t i = random_.below(live_vertices_.size());
    std::size_t j = random_.below(live_vertices_.size() - 1);
    if (j >= i) ++j;
    return {live_vertices_[i], live_vertices_[j]};
  }

  void contract() {
    const auto [p, q] = choose_pair();
    Contraction c;
    c.removed = VertexId{p};
    c.kept = VertexId{q};
    c.position = random_.chance(0.5) ? positions_[p] : positions_[q];
    if (options_.placement == Placement::Optimal) {
      const Vec3i delta = positions_[p] - positions_[q];
      c.position = positions_[q] + Vec3i{delta.x / 2, delta.y / 3, delta.z / 2 + 1};
    }
    for (float LevelError::*part :
         {&LevelError::surface, &LevelError::line, &LevelError::degrees, &LevelError::texture}) {
      c.error.*part = std::max(errors_[p].*part, errors_[q].*part);
      if (random_.chance(0.3)) c.error.*part += static_cast<float>(random_.unit());
    }
    c.first_change = static_cast<std::uint32_t>(sequence_.changes.size());
    c.first_derived = static_cast<std::uint32_t>(sequence_.derived.size());

    std::vector<std::vector<Pair>> joins(mesh_.layers.size());
    collapse(p, q, joins);
    positions_[q] = c.position;
    errors_[q] = c.error;
    std::erase(live_vertices_, p);
    std::erase_if(live_triangles_, [this](std::uint32_t t) { return !alive_[t]; });
    for (std::uint32_t l = 0; l < mesh_.layers.size(); ++l) change_layer(l, p, q, joins[l]);
    if (random_.chance(options_.derive_share)) derive_one();

    c.change_count = static_cast<std::uint32_t>(sequence_.changes.size()) - c.first_change;
    c.derived_count = static_cast<std::uint32_t>(sequence_.derived.size()) - c.first_derived;
    sequence_.contractions.push_back(c);
  }

  // Notes which attributes the vanishing triangles join.
  void collapse(std::uint32_t p, std::uint32_t q, std::vector<std::vector<Pair>>& joins) {
    const VertexId vp{p}, vq{q};
    for (std::uint32_t t : around_[p]) {
      if (!alive_[t]) continue;
      const auto at_q = std::ranges::find(triangles_[t], vq);
      const auto at_p = std::ranges::find(triangles_[t], vp);
      if (at_q == triangles_[t].end()) {
        around_[q].push_back(t);
        continue;
      }
      alive_[t] = false;
      for (std::size_t l = 0; l < joins.size(); ++l) {
        const auto attribute_at = [&](auto corner) {
          const auto c = static_cast<std::size_t>(corner - triangles_[t].begin());
          return static_cast<std::uint32_t>(index_of(of_corner_[l][3 * t + c]));
        };
        joins[l].push_back({attribute_at(at_p), attribute_at(at_q)});
      }
    }
    if (options_.smooth_only) {
      for (std::size_t l = 0; l < joins.size(); ++l) join_all(l, p, q, joins[l]);
    }
    for (std::uint32_t t : around_[p]) {
      if (alive_[t]) std::ranges::replace(triangles_[t], vp, vq);
    }
    std::erase_if(around_[q], [this](std::uint32_t t) { return !alive_[t]; });
  }

  void join_all(std::size_t l, std::uint32_t p, std::uint32_t q, std::vector<Pair>& joins) {
    std::vector<std::uint32_t> all;
    for (std::uint32_t v : {p, q}) {
      for (std::uint32_t t : around_[v]) {
        for (std::size_t c = 0; alive_[t] && c < 3; ++c) {
          if (index_of(triangles_[t][c]) != v) continue;
          all.push_back(static_cast<std::uint32_t>(index_of(of_corner_[l][3 * t + c])));
        }
      }
    }
    for (std::size_t i = 1; i < all.size(); ++i) joins.push_back({all[0], all[i]});
  }

  std::uint32_t new_value(std::uint32_t l, std::uint32_t near) {
    const AttributeLayer& layer = mesh_.layers[l];
    std::vector<float> value = random_value(random_, layer);
    if (random_.chance(0.1)) {  // a new attribute with the value of an old one
      const std::size_t d = layer.dimension, input = layer.value_count();
      const std::vector<float>& from = near < input ? layer.values : sequence_.new_values[l];
      const std::size_t first = (near < input ? near : near - input) * d;
      value.assign(from.begin() + std::ptrdiff_t(first), from.begin() + std::ptrdiff_t(first + d));
    }
    std::vector<float>& values = sequence_.new_values[l];
    values.insert(values.end(), value.begin(), value.end());
    return static_cast<std::uint32_t>(value_counts_[l]++);
  }

  void change_layer(std::uint32_t l, std::uint32_t, std::uint32_t q,
                    const std::vector<Pair>& joins) {
    std::map<std::uint32_t, std::uint32_t> parent;
    const auto find = [&](std::uint32_t a) {
      while (parent.try_emplace(a, a).first->second != a) a = parent[a];
      return a;
    };
    std::set<std::uint32_t> standing;
    for (std::uint32_t t : around_[q]) {
      for (std::size_t c = 0; c < 3; ++c) {
        if (index_of(triangles_[t][c]) != q) continue;
        standing.insert(static_cast<std::uint32_t>(index_of(of_corner_[l][3 * t + c])));
      }
    }
    for (const auto& [a, b] : joins) parent[find(a)] = find(b);
    std::map<std::uint32_t, std::vector<std::uint32_t>> components;
    for (std::uint32_t a : standing) components[find(a)].push_back(a);
    for (const auto& [a, b] : joins) {
      for (std::uint32_t member : {a, b}) {
        if (standing.contains(member) || !components.contains(find(member))) continue;
        components[find(member)].push_back(member);  // no triangle left, but its value may be taken
        standing.insert(member);
      }
    }

    std::map<std::uint32_t, std::uint32_t> image;
    const bool inherits = options_.placement == Placement::Endpoint;
    for (const auto& [root, members] : components) {
      std::uint32_t to = members[random_.below(members.size())];
      const bool joined = members.size() > 1;
      if (!joined && !random_.chance(options_.change_share)) continue;
      if ((!inherits && random_.chance(0.5)) || !joined) to = new_value(l, to);
      for (std::uint32_t member : members) image[member] = to;
    }
    apply(l, q, image);
  }

  void apply(std::uint32_t l, std::uint32_t q,
             const std::map<std::uint32_t, std::uint32_t>& image) {
    std::set<std::uint32_t> changed;
    for (std::uint32_t t : around_[q]) {
      for (std::size_t c = 0; c < 3; ++c) {
        AttributeId& attribute = of_corner_[l][3 * t + c];
        const auto from = static_cast<std::uint32_t>(index_of(attribute));
        const auto found = image.find(from);
        if (index_of(triangles_[t][c]) != q || found == image.end()) continue;
        if (found->second == from) continue;
        attribute = AttributeId{found->second};
        if (!changed.insert(from).second) continue;
        sequence_.changes.push_back({l, AttributeId{from}, AttributeId{found->second}});
      }
    }
  }

  void derive_one() {
    std::size_t normal_layer = 0;
    while (normal_layer < mesh_.layers.size() &&
           mesh_.layers[normal_layer].role != AttributeRole::Normal) {
      ++normal_layer;
    }
    if (live_triangles_.empty() || normal_layer == mesh_.layers.size()) return;
    const std::uint32_t t = live_triangles_[random_.below(live_triangles_.size())];
    const AttributeId* normal = &of_corner_[normal_layer][3 * t];
    const bool flat = normal[0] == normal[1] && normal[1] == normal[2];
    if (derived_[t] || (!flat && !random_.chance(0.2))) return;
    derived_[t] = true;
    sequence_.derived.push_back(TriangleId{t});
  }

  const Mesh& mesh_;
  const RandomContractionOptions options_;
  Random random_;
  ContractionSequence sequence_;
  std::vector<Triangle> triangles_;
  std::vector<bool> alive_, derived_;
  std::vector<std::vector<std::uint32_t>> around_;
  std::vector<std::vector<AttributeId>> of_corner_;
  std::vector<std::size_t> value_counts_;
  std::vector<Vec3i> positions_;
  std::vector<LevelError> errors_;
  std::vector<std::uint32_t> live_vertices_, live_triangles_;
};

}  // namespace

ContractionSequence random_contractions(const Mesh& snapped, const Grid& grid,
                                        const RandomContractionOptions& options) {
  return Generator(snapped, grid, options).run();
}

Mesh random_complex(std::uint64_t seed, std::size_t vertex_count, std::size_t triangle_count) {
  Random random(seed);
  Mesh mesh;
  for (std::size_t v = 0; v < vertex_count; ++v) {
    mesh.positions.push_back(
        {double(random.below(9)), double(random.below(9)), double(random.below(9))});
  }
  mesh.materials = {{"stone", {1, 0, 0, 1}, "stone.png"}, {"glass", {0, 1, 0, 0.5f}, ""}};
  mesh.parts = {"left", "right"};
  for (std::size_t t = 0; t < triangle_count; ++t) {
    std::set<std::uint32_t> corners;
    while (corners.size() < 3) {
      corners.insert(static_cast<std::uint32_t>(random.below(vertex_count)));
    }
    Triangle triangle{};
    std::ranges::transform(corners, triangle.begin(), [](std::uint32_t v) { return VertexId{v}; });
    if (random.chance(0.5)) std::swap(triangle[0], triangle[1]);
    mesh.triangles.push_back(triangle);
    mesh.material_of_triangle.push_back(MaterialId{static_cast<std::uint32_t>(random.below(2))});
    mesh.part_of_triangle.push_back(PartId{static_cast<std::uint32_t>(random.below(2))});
  }
  mesh.layers = {
      {"normal", AttributeRole::Normal, Interpolation::Direction, 3, {}, {}},
      {"uv", AttributeRole::TexCoord, Interpolation::Linear, 2, {}, {}},
      {"color", AttributeRole::Color, Interpolation::Linear, 4, {}, {}},
      {"use", AttributeRole::Other, Interpolation::Categorical, 1, {}, {}},
  };
  for (std::size_t l = 0; l < mesh.layers.size(); ++l) {
    AttributeLayer& layer = mesh.layers[l];
    // Mostly one value a vertex (the first ones) or one a triangle, so that all kinds come up.
    const std::size_t value_count = vertex_count + triangle_count;
    for (std::size_t i = 0; i < value_count; ++i) {
      const std::vector<float> value = random_value(random, layer);
      layer.values.insert(layer.values.end(), value.begin(), value.end());
    }
    const double vertex_share = random.chance(0.2) ? 0.0 : 0.8;
    for (std::size_t t = 0; t < triangle_count; ++t) {
      const bool by_vertex = random.chance(vertex_share);
      for (VertexId v : mesh.triangles[t]) {
        const std::size_t id = by_vertex ? index_of(v) : vertex_count + t;
        layer.of_corner.push_back(AttributeId{static_cast<std::uint32_t>(id)});
      }
    }
    for (int i = 0; i < 4 && !layer.of_corner.empty(); ++i) {
      layer.of_corner[random.below(layer.of_corner.size())] =
          AttributeId{static_cast<std::uint32_t>(random.below(value_count))};
    }
  }
  return mesh;
}

}  // namespace crease
