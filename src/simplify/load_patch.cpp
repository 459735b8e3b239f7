// A patch's own copy of its part of the mesh, with the quadrics of the band's start.
#include "simplify/patch_simplifier.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace crease::simplification {

namespace {

// A triangle so thin that its attribute gradient is noise.
constexpr double kThin = 1e-4;

// Edges between two flat triangles are lines of their own only where the surface really bends: on
// a faceted sphere every edge is hard, and none of them is a feature.
constexpr double kFlatLineCosine = 0.866;  // 30 degrees

// Where two surfaces touch or cross none ends, and their planes hold the edge. Whole lines spend
// the triangles of solids that share a wall on it, none lets the edge wander over coplanar sheets.
constexpr double kTouchingLine = 0.03;

// Where parts of one material meet nothing is to be seen: less than a line.
constexpr double kPartLine = 0.1;

// Two triangles on the same side of their edge, folded onto each other or doubled: the planes
// agree, so only a line can hold the edge.
constexpr double kFoldCosine = 0.5;

// Normals of an edge's two sides that differ by this, 17 degrees, or more make a whole line of it,
// and smaller differences by their square: every corner may have noise, and a surface full of lines
// could not be simplified.
constexpr double kCreaseChord = 0.3;

// The ways along a triangle's sides, each followed by its opposite.
struct EndsOfWay {
  std::uint32_t corner, other_corner;
};
constexpr EndsOfWay kEndsOfWay[] = {{0, 1}, {1, 0}, {0, 2}, {2, 0}, {1, 2}, {2, 1}};

// 1 if a < b, else 0: a number, of which no compiler makes a branch that nobody could foretell.
inline std::uint32_t less(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::uint32_t>((std::uint64_t(a) - std::uint64_t(b)) >> 63);
}

}  // namespace

void PatchSimplifier::start(WorkMesh& work, std::span<const std::uint32_t> triangles,
                            std::uint32_t patch_id, const Steering& steering) {
  work_ = &work;
  steering_ = steering;
  result_.clear();
  heap_.clear();
  held_.clear();
  last_key_ = 0;
  if (loaded_ != patch_id) {
    load(triangles, patch_id);
    load_wedges();
    load_quadrics();
    load_shading();
    load_edges();
    loaded_ = patch_id;
  }
  load_parts();
  load_turns();  // alone depends on the steering
  if (steering_.virtual_distance > 0 && work.part_count > 1) find_virtual_pairs();
}

void PatchSimplifier::load(std::span<const std::uint32_t> triangles, std::uint32_t patch_id) {
  if (local_of_vertex_.empty()) local_of_vertex_.assign(work_->positions.size(), kNone);
  const std::size_t n = triangles.size();
  clear_for(vertices_, n / 2);
  clear_for(errors_, n / 2);
  clear_for(grown_, n / 2);
  clear_for(positions_, n / 2);
  clear_for(global_triangle_, n);
  clear_for(vertex_of_corner_, 4 * n);
  global_triangle_.assign(triangles.begin(), triangles.end());
  vertex_of_corner_.resize(4 * n);
  triangle_alive_.assign(n, 1);
  derived_.resize(n);
  flat_.assign(n, 0);
  live_triangles_ = n;

  Vec3i low{INT32_MAX, INT32_MAX, INT32_MAX}, high{INT32_MIN, INT32_MIN, INT32_MIN};
  for (std::size_t t = 0; t < n; ++t) {
    derived_[t] = work_->derived[triangles[t]];
    for (std::size_t c = 0; c < 3; ++c) {
      const Index global = work_->vertex_of_corner[3 * triangles[t] + c];
      Index& local = local_of_vertex_[global];
      if (local == kNone) {
        local = static_cast<Index>(vertices_.size());
        Vertex vertex;
        vertex.global = global;
        vertex.locked = work_->owner_of_vertex[global] != patch_id;
        vertices_.push_back(vertex);
        errors_.push_back({work_->error_of_vertex[global], work_->error_of_vertex[global]});
        grown_.push_back(work_->grown_of_vertex[global]);
        const Vec3i& p = work_->positions[global];
        for (int i = 0; i < 3; ++i) {
          low[i] = std::min(low[i], p[i]);
          high[i] = std::max(high[i], p[i]);
        }
      }
      vertex_of_corner_[4 * t + c] = local;
      ++vertices_[local].corners.count;
    }
    vertex_of_corner_[4 * t + 3] = vertex_of_corner_[4 * t];
  }
  for (int i = 0; i < 3; ++i) {
    center_grid_[i] = static_cast<std::int32_t>((std::int64_t(low[i]) + high[i]) / 2);
  }
  for (Vertex& vertex : vertices_) {
    local_of_vertex_[vertex.global] = kNone;  // leave the scratch as it was
    const Vec3i p = work_->positions[vertex.global] - center_grid_;
    positions_.push_back({double(p.x), double(p.y), double(p.z)});
  }

  // Triangles around each vertex: counts, then slots.
  Index next = 0;
  for (Vertex& vertex : vertices_) {
    vertex.corners.first = next;
    next += std::exchange(vertex.corners.count, 0);
  }
  clear_for(corner_pool_, 2 * std::size_t(next));
  corner_pool_.resize(next);
  for (Index t = 0; t < n; ++t) {
    for (Index corner = 4 * t; corner != 4 * t + 3; ++corner) {
      Slice& around = vertices_[vertex_of_corner_[corner]].corners;
      corner_pool_[around.first + around.count++] = corner;
    }
  }
  mark_.assign(vertices_.size(), 0);
  mark_now_ = 0;

  if (!work_->category_of_triangle.empty()) {
    category_around_.resize(vertices_.size());
    for (Index t = 0; t < n; ++t) {
      for (Index c = 0; c < 3; ++c) category_around_[vertex_of_corner_[4 * t + c]] = category_of(t);
    }
    for (Index t = 0; t < n; ++t) {
      for (Index c = 0; c < 3; ++c) {
        Index& category = category_around_[vertex_of_corner_[4 * t + c]];
        if (category != category_of(t)) category = kNone;
      }
    }
  }
}

// Wedges of a vertex lie together, in the order in which its triangles name them. Nearly all
// vertices have one, so those that have several are sought out first.
void PatchSimplifier::load_wedges() {
  wedges_.resize(layer_count());
  wedge_slices_.resize(layer_count());
  wedge_of_corner_.resize(layer_count());
  attribute_quadrics_.resize(layer_count());
  std::vector<Index> first_id;
  for (std::size_t l = 0; l < layer_count(); ++l) {
    const WorkLayer& layer = work_->layers[l];
    std::vector<Index>& id_of_corner = wedge_of_corner_[l];  // until the wedges are known
    clear_for(id_of_corner, vertex_of_corner_.size());
    id_of_corner.resize(vertex_of_corner_.size());
    for (Index t = 0; t < global_triangle_.size(); ++t) {
      std::copy_n(&layer.of_corner[3 * global_triangle_[t]], 3, &id_of_corner[4 * t]);
    }

    std::vector<Slice>& slices = wedge_slices_[l];
    clear_for(slices, vertices_.size());
    slices.assign(vertices_.size(), Slice{kNone, 1});
    first_id.resize(vertices_.size());
    for (Index t = 0; t < global_triangle_.size(); ++t) {
      for (Index corner = 4 * t; corner != 4 * t + 3; ++corner) {
        const Index v = vertex_of_corner_[corner];
        if (slices[v].first == kNone) {
          slices[v].first = 0;
          first_id[v] = id_of_corner[corner];
        } else if (first_id[v] != id_of_corner[corner]) {
          slices[v].count = 2;  // or more
        }
      }
    }

    std::vector<Wedge>& wedges = wedges_[l];
    clear_for(wedges, vertices_.size());
    const auto append = [&](Index id) {
      Wedge& wedge = wedges.emplace_back();
      wedge.id = id;
      const float* value = layer.value(id);
      std::copy_n(value, layer.dimension, wedge.value);
    };
    for (Index v = 0; v < vertices_.size(); ++v) {
      Slice& slice = slices[v];
      slice.first = static_cast<Index>(wedges.size());
      if (slice.count == 1) {
        append(first_id[v]);
        continue;
      }
      for (Index corner : corners_of(v)) {
        Index& wedge = id_of_corner[corner];
        Index w = slice.first;
        while (w < wedges.size() && wedges[w].id != wedge) ++w;
        if (w == wedges.size()) append(wedge);
        wedge = w;
      }
      slice.count = static_cast<Index>(wedges.size()) - slice.first;
    }

    Index quadric_count = 0;
    for (Index t = 0; t < global_triangle_.size(); ++t) {
      Index* w = &id_of_corner[4 * t];
      for (Index c = 0; c < 3; ++c) {
        const Slice& slice = slices[vertex_of_corner_[4 * t + c]];
        w[c] = slice.count == 1 ? slice.first : w[c];
      }
      Wedge* const own[] = {&wedges[w[0]], &wedges[w[1]], &wedges[w[2]]};
      const bool constant = own[0]->id == own[1]->id && own[1]->id == own[2]->id;
      const bool pinned = constant && !(layer.is_normal && derived_[t]);
      if (pinned && layer.is_normal) flat_[t] = 1;
      for (Wedge* wedge : own) {
        if (pinned) wedge->pinned = true;
        if (!constant && layer.steers && wedge->quadric == kNone) wedge->quadric = quadric_count++;
      }
    }
    clear_for(attribute_quadrics_[l], quadric_count);
    attribute_quadrics_[l].assign(quadric_count, AttributeQuadric{});
  }
}

CREASE_WIDE void PatchSimplifier::load_quadrics() {
  clear_for(surface_, vertices_.size());
  clear_for(facing_, global_triangle_.size());
  surface_.assign(vertices_.size(), Quadric{});
  facing_.assign(global_triangle_.size(), Facing{});
  for (Index t = 0; t < global_triangle_.size(); ++t) {
    const Index* v = &vertex_of_corner_[4 * t];
    const Vec3d p0 = positions_[v[0]];
    const Vec3d e1 = positions_[v[1]] - p0, e2 = positions_[v[2]] - p0;
    const Vec3d twice = cross(e1, e2);
    const double twice_area = length(twice);
    if (!(twice_area > 0)) continue;
    const double area = 0.5 * twice_area;
    const Vec3d n = twice * (1 / twice_area);
    facing_[t] = {n, area};

    const Quadric plane = Quadric::of_plane(n, -dot(n, p0), area, area);
    for (int c = 0; c < 3; ++c) surface_[v[c]].add(plane);

    // The second and the third corner's barycentric coordinates, as linear functions.
    const double longest = std::max({dot(e1, e1), dot(e2, e2), dot(e2 - e1, e2 - e1)});
    Row second{0, 0, 0, 1.0 / 3}, third = second;
    if (twice_area >= kThin * longest) {
      const double inverse = 1 / (twice_area * twice_area);
      const Vec3d toward1 = cross(e2, twice) * inverse, toward2 = cross(twice, e1) * inverse;
      second = Row{toward1.x, toward1.y, toward1.z, -dot(toward1, p0)};
      third = Row{toward2.x, toward2.y, toward2.z, -dot(toward2, p0)};
    }
    for (std::size_t l = 0; l < layer_count(); ++l) {
      const Index* w = &wedge_of_corner_[l][4 * t];
      Wedge* wedges = wedges_[l].data();
      for (int c = 0; c < 3; ++c) wedges[w[c]].area += area;
      const WorkLayer& layer = work_->layers[l];
      if (!layer.steers) continue;
      AttributeQuadric* quadrics = attribute_quadrics_[l].data();
      const Wedge &w0 = wedges[w[0]], &w1 = wedges[w[1]], &w2 = wedges[w[2]];
      if (w0.id == w1.id && w1.id == w2.id) {
        for (const Wedge* wedge : {&w0, &w1, &w2}) {
          if (wedge->quadric == kNone) continue;
          quadrics[wedge->quadric].add_constant(wedge->value, area, layer.dimension);
        }
        continue;
      }
      AttributeQuadric* sums[] = {&quadrics[w0.quadric], &quadrics[w1.quadric],
                                  &quadrics[w2.quadric]};
      Row own[3] = {};
      double c = 0;
      for (int j = 0; j < layer.dimension; ++j) {
        const double value = double(w0.value[j]);
        const Row f = second * (double(w1.value[j]) - value) +
                      third * (double(w2.value[j]) - value) + Row{0, 0, 0, value};
        const Row g = f * area;
        for (int i = 0; i < 3; ++i) own[i] += f[i] * g;
        c += f[3] * g[3];
        for (AttributeQuadric* sum : sums) sum->linear[j] += g;
      }
      for (AttributeQuadric* sum : sums) {
        for (int i = 0; i < 3; ++i) sum->own.row[i] += own[i];
        sum->own.c += c;
        sum->own.weight += area;
      }
    }
  }
}

inline double PatchSimplifier::square_of_difference(const Wedge& a, const Wedge& b) {
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const double d = double(a.value[i]) - double(b.value[i]);
    sum += d * d;
  }
  return sum;
}

// How much of a line an edge is, 0 to 1: a border, a crease, where a sheet ends on others, and a
// little where sheets only touch or cross.
inline double PatchSimplifier::line_weight(Index v, const Edge& edge) const {
  if (edge.triangle_count != 2) return edge.triangle_count % 2 == 0 ? kTouchingLine : 1;
  const Index w = edge.other, t = triangle_of(edge.corner[0]), u = triangle_of(edge.corner[1]);
  double weight = 0;
  if (!work_->category_of_triangle.empty() && category_of(t) != category_of(u)) {
    const bool is_seen =
        material_of_category(category_of(t)) != material_of_category(category_of(u));
    if (is_seen) return 1;
    weight = kPartLine;
  }
  // Sides that run through the edge in the same direction are inside out to each other.
  const auto runs_to_w = [&](int side) {
    const Index from = edge.corner[side], to = edge.other_corner[side];
    return to == from + 1 || to + 2 == from;
  };
  const double bend = dot(facing_[t].normal, facing_[u].normal);
  if (runs_to_w(0) == runs_to_w(1) ? bend > kFoldCosine : bend < -kFoldCosine) return 1;
  if (!several_wedges_[v] && !several_wedges_[w]) return weight;
  for (std::size_t l = 0; l < layer_count(); ++l) {
    const WorkLayer& layer = work_->layers[l];
    const Index *at = wedge_of_corner_[l].data(), *from = edge.corner, *to = edge.other_corner;
    if (at[from[0]] == at[from[1]] && at[to[0]] == at[to[1]]) continue;
    if (!layer.is_normal) {
      weight = std::max(weight, layer.line_weight);
      continue;
    }
    const bool facets = (flat_[t] || derived_[t]) && (flat_[u] || derived_[u]);
    if (facets && bend >= kFlatLineCosine) continue;
    const Wedge* wedges = wedges_[l].data();
    const double chord2 = std::max(square_of_difference(wedges[at[from[0]]], wedges[at[from[1]]]),
                                   square_of_difference(wedges[at[to[0]]], wedges[at[to[1]]]));
    weight = std::max(weight, std::min(1.0, chord2 / (kCreaseChord * kCreaseChord)));
  }
  return weight;
}

// The plane through edge a-b at a right angle to the triangle (Garland 1999, boundary constraints).
inline void PatchSimplifier::add_line(Index a, Index b, Index triangle, double share) {
  const Vec3d edge = positions_[b] - positions_[a];
  const Vec3d across = cross(edge, facing_[triangle].normal);  // as long as the edge: its weight
  const double weight = share * dot(across, across);
  if (weight == 0) return;
  const Quadric plane = Quadric::of_plane(across, -dot(across, positions_[a]), share, weight);
  for (Index v : {a, b}) {
    if (line_of_vertex_[v] == kNone) {
      line_of_vertex_[v] = static_cast<Index>(line_.size());
      line_.push_back(plane);
    } else {
      line_[line_of_vertex_[v]].add(plane);
    }
  }
}

inline void PatchSimplifier::add_lines(Index v, const Edge& edge, double share) {
  if (edge.triangle_count <= 2) {
    for (Index i = 0; i < edge.triangle_count; ++i)
      add_line(v, edge.other, triangle_of(edge.corner[i]), share);
    return;
  }
  for (Index corner : corners_of(v)) {
    const Index t = triangle_of(corner);
    if (has_corner_at(t, edge.other)) add_line(v, edge.other, t, share);
  }
}

// Triangles with the same three vertices, both sides of a sheet or what somebody exported twice,
// count as one, if the other sheet at the edge has as many. Of copies that which goes on from the
// first sheet: it runs the other way.
PatchSimplifier::Edge PatchSimplifier::without_copies(Index v, const Edge& edge) const {
  Edge sheets{edge.other, {}, {}, 0};
  Index third[2] = {kNone, kNone};
  bool runs_on[2] = {};
  Index copies[2] = {};
  for (const Index corner : corners_of(v)) {
    const Index begin = 4 * triangle_of(corner);
    Index other_corner = begin;
    while (other_corner < begin + 3 && vertex_of_corner_[other_corner] != edge.other)
      ++other_corner;
    if (other_corner == begin + 3) continue;
    const Index apex = vertex_of_corner_[3 * begin + 3 - corner - other_corner];
    const bool on = other_corner == corner + 1 || other_corner + 2 == corner;
    Index place = 0;
    while (place < std::min(sheets.triangle_count, 2u) && third[place] != apex) ++place;
    const bool is_copy = place < std::min(sheets.triangle_count, 2u);
    const bool is_better = is_copy && place == 1 && runs_on[1] == runs_on[0] && on != runs_on[0];
    sheets.triangle_count += is_copy ? 0 : 1;
    if (place > 1) return edge;  // several sheets meet
    ++copies[place];
    if (is_copy && !is_better) continue;
    third[place] = apex;
    runs_on[place] = on;
    sheets.corner[place] = corner;
    sheets.other_corner[place] = other_corner;
  }
  if (sheets.triangle_count == 2 && copies[0] != copies[1]) return edge;
  return sheets;
}

// The sides of the triangles by the end that comes first, there in the order of the triangles.
void PatchSimplifier::gather_edge_sides() {
  const Index triangle_count = static_cast<Index>(global_triangle_.size());
  const auto for_sides = [&](auto visit) {
    for (Index t = 0; t < triangle_count; ++t) {
      const Index* v = &vertex_of_corner_[4 * t];
      for (Index way = 0; way < 6; way += 2) {
        const Index first = v[kEndsOfWay[way].corner], second = v[kEndsOfWay[way].other_corner];
        visit(std::min(first, second), 8 * t + way + less(second, first));
      }
    }
  };
  end_of_sides_.assign(vertices_.size(), 0);
  for_sides([&](Index lower, Index) { ++end_of_sides_[lower]; });
  Index next = 0;
  for (Index& end : end_of_sides_) next += std::exchange(end, next);  // begins, until all are there
  edge_sides_.resize(next);
  for_sides([&](Index lower, Index side) { edge_sides_[end_of_sides_[lower]++] = side; });
}

CREASE_WIDE void PatchSimplifier::load_edges() {
  line_of_vertex_.assign(vertices_.size(), kNone);
  line_.clear();
  clear_for(pairs_, global_triangle_.size() * 3 / 2);
  several_wedges_.assign(vertices_.size(), 0);
  for (std::size_t l = 0; l < layer_count(); ++l) {
    for (Index v = 0; v < vertices_.size(); ++v) several_wedges_[v] |= wedges_of(l, v).count > 1;
  }
  gather_edge_sides();
  edge_at_.assign(vertices_.size(), 0);
  Index first_edge = 1;  // of the vertex; the edges of all vertices are numbered
  for (Index v = 0; v < vertices_.size(); ++v) {
    const Index begin = v == 0 ? 0 : end_of_sides_[v - 1], end = end_of_sides_[v];
    Edge* const edges = edges_.start(end - begin + 1);
    Index edge_count = 0;
    for (Index i = begin; i != end; ++i) {
      const Index corners = 4 * (edge_sides_[i] / 8);
      const EndsOfWay& ends = kEndsOfWay[edge_sides_[i] % 8];
      const Index other_corner = corners + ends.other_corner;
      const Index other = vertex_of_corner_[other_corner];
      const Index met = edge_at_[other] - first_edge;
      const Index known = less(met, edge_count);
      const Index place = edge_count ^ ((edge_count ^ met) & -known);
      edge_at_[other] = first_edge + place;
      edge_count += 1 - known;
      Edge& edge = edges[place];
      const Index before = edge.triangle_count & -known;
      const Index which = less(0, before);
      edge.other = other;
      edge.corner[which] = corners + ends.corner;
      edge.other_corner[which] = other_corner;
      edge.triangle_count = before + 1;
    }
    first_edge += edge_count;
    edges_.finish(edges + edge_count);
    for (Edge& edge : edges_) {
      const Index w = edge.other;
      if (vertices_[v].locked && vertices_[w].locked) continue;
      if (!vertices_[v].locked && !vertices_[w].locked) pairs_.emplace_back(v, w);
      if (work_->has_copies && edge.triangle_count > 2) edge = without_copies(v, edge);
      const double weight = line_weight(v, edge);
      if (weight > 0) add_lines(v, edge, weight);
    }
  }
}

}  // namespace crease::simplification
