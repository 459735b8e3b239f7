#include "mesh/clean.h"

#include "mesh/corners_around.h"
#include "mesh/weld.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

namespace crease {

std::vector<bool> proper_triangles(const Mesh& mesh) {
  std::vector<bool> proper(mesh.triangle_count());
  for (std::size_t t = 0; t < proper.size(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    proper[t] = a != b && b != c && c != a;
  }
  return proper;
}

std::vector<std::uint32_t> kept_rows(const std::vector<bool>& keep) {
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < keep.size(); ++i) {
    if (keep[i]) kept.push_back(static_cast<std::uint32_t>(i));
  }
  return kept;
}

void keep_triangles(Mesh& mesh, const std::vector<bool>& keep) {
  const std::vector<std::uint32_t> kept = kept_rows(keep);
  keep_rows(mesh.triangles, kept);
  for (AttributeLayer& layer : mesh.layers) keep_rows(layer.of_corner, kept, 3);
  if (!mesh.material_of_triangle.empty()) keep_rows(mesh.material_of_triangle, kept);
  if (!mesh.part_of_triangle.empty()) keep_rows(mesh.part_of_triangle, kept);
}

std::size_t drop_isolated_vertices(Mesh& mesh) {
  std::vector<std::uint32_t> new_of_old(mesh.vertex_count(), kNone);
  for (const Triangle& triangle : mesh.triangles) {
    for (VertexId v : triangle) new_of_old[index_of(v)] = 0;
  }
  std::vector<std::uint32_t> kept;
  for (std::size_t v = 0; v < new_of_old.size(); ++v) {
    if (new_of_old[v] == kNone) continue;
    new_of_old[v] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(static_cast<std::uint32_t>(v));
  }
  const std::size_t dropped = mesh.vertex_count() - kept.size();
  if (dropped == 0) return 0;
  keep_rows(mesh.positions, kept);
  for (Triangle& triangle : mesh.triangles) {
    for (VertexId& v : triangle) v = VertexId{new_of_old[index_of(v)]};
  }
  return dropped;
}

void weld_layer(AttributeLayer& layer) {
  const Weld weld = weld_values(layer.values, layer.dimension);
  std::vector<std::uint32_t> new_of_welded(weld.first_old.size(), kNone);
  std::vector<std::uint32_t> kept;  // old index of each value in use, in order of first use
  for (AttributeId& a : layer.of_corner) {
    const std::uint32_t welded = weld.new_of_old[index_of(a)];
    if (new_of_welded[welded] == kNone) {
      new_of_welded[welded] = static_cast<std::uint32_t>(kept.size());
      kept.push_back(weld.first_old[welded]);
    }
    a = AttributeId{new_of_welded[welded]};
  }
  std::vector<float> values;
  values.reserve(kept.size() * layer.dimension);
  for (std::uint32_t old : kept) {
    for (std::size_t k = 0; k < layer.dimension; ++k) {
      values.push_back(layer.values[old * layer.dimension + k] + 0.0f);  // -0 becomes +0
    }
  }
  layer.values = std::move(values);
}

std::size_t count_duplicate_triangles(const Mesh& mesh) {
  using Key = std::array<VertexId, 3>;
  const auto key_of = [&](std::size_t t) {
    Key key = mesh.triangles[t];
    std::sort(key.begin(), key.end());
    return key;
  };
  // Buckets by the smallest vertex: a counting sort, then short sorts.
  std::vector<std::uint32_t> begin(mesh.vertex_count() + 1, 0);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) ++begin[index_of(key_of(t)[0]) + 1];
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) begin[v + 1] += begin[v];
  std::vector<std::array<VertexId, 2>> rest(mesh.triangle_count());
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Key key = key_of(t);
    rest[next[index_of(key[0])]++] = {key[1], key[2]};
  }
  std::size_t duplicates = 0;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const auto first = rest.begin() + begin[v], last = rest.begin() + begin[v + 1];
    std::sort(first, last);
    duplicates += static_cast<std::size_t>((last - first) - (std::unique(first, last) - first));
  }
  return duplicates;
}

namespace {

// An edge of a triangle, seen from its lower vertex.
struct EdgeSide {
  VertexId higher{}, opposite{};
  bool goes_up = false;  // the triangle runs from the lower vertex to the higher one
};

bool is_misoriented(std::span<const EdgeSide> sides) {
  return sides.size() == 2 && sides[0].goes_up == sides[1].goes_up &&
         sides[0].opposite != sides[1].opposite;
}

}  // namespace

std::size_t count_misoriented_edges(const Mesh& mesh) {
  const CornersAround around(mesh);
  std::vector<EdgeSide> sides;  // of the edges that go up from one vertex
  std::size_t count = 0;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    sides.clear();
    for (std::uint32_t corner : around.of(v)) {
      const Triangle& triangle = mesh.triangles[corner / 3];
      const VertexId next = triangle[(corner + 1) % 3], last = triangle[(corner + 2) % 3];
      if (next > VertexId{v}) sides.push_back({next, last, true});
      if (last > VertexId{v}) sides.push_back({last, next, false});
    }
    std::sort(sides.begin(), sides.end(),
              [](const EdgeSide& a, const EdgeSide& b) { return a.higher < b.higher; });
    for (auto first = sides.begin(); first != sides.end();) {
      const auto last = std::find_if(
          first, sides.end(), [&](const EdgeSide& side) { return side.higher != first->higher; });
      count += is_misoriented({first, last});
      first = last;
    }
  }
  return count;
}

bool has_reversed_normals(const Mesh& mesh, const AttributeLayer& normals, std::size_t triangle) {
  const auto [a, b, c] = mesh.triangles[triangle];
  const Vec3d p = mesh.positions[index_of(a)], q = mesh.positions[index_of(b)],
              r = mesh.positions[index_of(c)];
  const Vec3d outside = cross(q - p, r - p);
  for (std::size_t k = 0; k < 3; ++k) {
    const AttributeId id = normals.of_corner[3 * triangle + k];
    if (id == kNoAttribute) return false;
    const std::span<const float> n = normals.value(id);
    if (dot(outside, Vec3d{n[0], n[1], n[2]}) >= 0) return false;
  }
  return !has_no_area(p, q, r);
}

std::size_t count_reversed_normals(const Mesh& mesh, const AttributeLayer& normals) {
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    count += has_reversed_normals(mesh, normals, t);
  }
  return count;
}

bool has_no_area(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d ab = b - a, ac = c - a, bc = c - b;
  const double longest = std::sqrt(std::max({dot(ab, ab), dot(ac, ac), dot(bc, bc)}));
  double largest = 0;
  for (int i = 0; i < 3; ++i) {
    largest = std::max({largest, std::abs(a[i]), std::abs(b[i]), std::abs(c[i])});
  }
  const double height_noise = 4 * std::numeric_limits<double>::epsilon() * largest;
  return length(cross(ab, ac)) <= longest * height_noise;
}

std::size_t count_zero_area_triangles(const Mesh& mesh) {
  std::size_t count = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    count += has_no_area(mesh.positions[index_of(a)], mesh.positions[index_of(b)],
                         mesh.positions[index_of(c)]);
  }
  return count;
}

}  // namespace crease
