#include "mesh/clean.h"
#include "mesh/disjoint_sets.h"
#include "mesh/normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

namespace crease {

namespace {

// Edges of more triangles than this, copies counted once, are hard: pairing them up would take
// quadratic time.
constexpr std::size_t kMaxPairedTriangles = 16;
// Sheets that meet in an edge are soft across it only within this, whatever the policy says:
// the mean over crossing walls would be nonsense.
constexpr double kMaxSheetAngleDeg = 90;
// Two sides of a folded sheet are never one surface.
constexpr double kMaxFoldAngleDeg = 179;

// Half edge 3t+c runs from corner c of triangle t to corner c+1.
constexpr std::uint32_t next_corner(std::uint32_t corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}

std::size_t vertex_at(const Mesh& mesh, std::uint32_t corner) {
  return index_of(mesh.triangles[corner / 3][corner % 3]);
}

// Calls visit(span of half edges) for every edge, in an order that depends on the mesh alone.
template <typename Visit>
void for_each_edge(const Mesh& mesh, Visit visit) {
  const std::uint32_t corner_count = static_cast<std::uint32_t>(3 * mesh.triangle_count());
  const auto low_end = [&](std::uint32_t h) {
    return std::min(vertex_at(mesh, h), vertex_at(mesh, next_corner(h)));
  };
  const auto high_end = [&](std::uint32_t h) {
    return std::max(vertex_at(mesh, h), vertex_at(mesh, next_corner(h)));
  };
  std::vector<std::uint32_t> begin(mesh.vertex_count() + 1, 0);
  for (std::uint32_t h = 0; h < corner_count; ++h) ++begin[low_end(h) + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<std::uint32_t> half_edges(corner_count);
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  for (std::uint32_t h = 0; h < corner_count; ++h) half_edges[next[low_end(h)]++] = h;
  next = {};

  std::vector<std::pair<std::size_t, std::uint32_t>> sorted;  // (high end, half edge)
  std::vector<std::uint32_t> edge;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    sorted.clear();
    for (std::uint32_t i = begin[v]; i < begin[v + 1]; ++i) {
      sorted.emplace_back(high_end(half_edges[i]), half_edges[i]);
    }
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t i = 0; i < sorted.size();) {
      edge.clear();
      const std::size_t high = sorted[i].first;
      for (; i < sorted.size() && sorted[i].first == high; ++i) edge.push_back(sorted[i].second);
      visit(std::span<const std::uint32_t>(edge));
    }
  }
}

std::array<Vec3d, 3> corners_of(const Mesh& mesh, std::size_t t) {
  const auto [a, b, c] = mesh.triangles[t];
  return {mesh.positions[index_of(a)], mesh.positions[index_of(b)], mesh.positions[index_of(c)]};
}

bool is_finite(const Vec3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Twice the area times the normal; zero where there is no area to speak of.
Vec3d area_vector(const Mesh& mesh, std::size_t t) {
  const auto [a, b, c] = corners_of(mesh, t);
  if (has_no_area(a, b, c)) return {};
  const Vec3d normal = cross(b - a, c - a);
  return is_finite(normal) ? normal : Vec3d{};
}

bool is_zero(const Vec3d& v) {
  return v == Vec3d{};
}

// Gives triangles with a zero normal the normal of a neighbour, longest edges first, outwards from
// the triangles that have one.
void fill_zero_normals(const Mesh& mesh, std::vector<Vec3d>& normals) {
  struct Link {
    double length;
    std::uint32_t to, from;
  };
  std::vector<Link> links;  // from a neighbour to a triangle without normal
  for_each_edge(mesh, [&](std::span<const std::uint32_t> edge) {
    for (std::uint32_t h : edge) {
      if (!is_zero(normals[h / 3])) continue;
      const double l = length(mesh.positions[vertex_at(mesh, h)] -
                              mesh.positions[vertex_at(mesh, next_corner(h))]);
      const std::size_t some = std::min(edge.size(), kMaxPairedTriangles);
      for (std::size_t i = 0; i < some; ++i) {
        if (edge[i] != h) links.push_back({std::isfinite(l) ? l : 0, h / 3, edge[i] / 3});
      }
    }
  });
  std::stable_sort(links.begin(), links.end(), [](const Link& a, const Link& b) {
    return a.to != b.to ? a.to < b.to : a.length > b.length;
  });
  std::vector<std::uint32_t> waiting;  // triangles without normal
  for (const Link& link : links) {
    if (waiting.empty() || waiting.back() != link.to) waiting.push_back(link.to);
  }
  // Chains of such triangles are short; the bound only keeps hostile ones from being quadratic.
  for (int round = 0; round < 64 && !waiting.empty(); ++round) {
    std::vector<std::pair<std::uint32_t, Vec3d>> found;
    std::vector<std::uint32_t> still;
    auto link = links.begin();
    for (std::uint32_t t : waiting) {
      while (link != links.end() && link->to < t) ++link;
      Vec3d normal;
      for (auto l = link; l != links.end() && l->to == t && is_zero(normal); ++l) {
        normal = normals[l->from];
      }
      if (is_zero(normal)) {
        still.push_back(t);
      } else {
        found.emplace_back(t, normal);
      }
    }
    if (found.empty()) break;
    for (const auto& [t, normal] : found) normals[t] = normal;
    waiting = std::move(still);
  }
  for (Vec3d& normal : normals) {
    if (is_zero(normal)) normal = {0, 0, 1};
  }
}

double angle_at(const Vec3d& apex, const Vec3d& left, const Vec3d& right) {
  const Vec3d l = left - apex, r = right - apex;
  const double angle = std::atan2(length(cross(l, r)), dot(l, r));
  return std::isfinite(angle) ? angle : 0;
}

struct Sectors {
  std::vector<std::uint32_t> of_corner;
  std::vector<Vec3f> normals;
};

// Of sides of triangles that run the same way between the same three vertices, in one face and
// smoothing group, one each. What is soft to one is soft to all: their corners are united.
std::span<const std::uint32_t> unite_copies(const Mesh& mesh, const SoftEdges& soft,
                                            std::vector<std::uint32_t>& edge,
                                            DisjointSets& connected) {
  const auto kind = [&](std::uint32_t h) {
    const std::size_t t = h / 3;
    return std::tuple(vertex_at(mesh, h), vertex_at(mesh, next_corner(next_corner(h))),
                      soft.face_of_triangle.empty() ? 0 : soft.face_of_triangle[t],
                      soft.smoothing_group.empty() ? 0 : soft.smoothing_group[t]);
  };
  std::sort(edge.begin(), edge.end(), [&](std::uint32_t g, std::uint32_t h) {
    return std::pair(kind(g), g) < std::pair(kind(h), h);
  });
  std::size_t count = 0;
  for (const std::uint32_t h : edge) {
    if (count == 0 || kind(edge[count - 1]) != kind(h)) {
      edge[count++] = h;
    } else {
      connected.unite(edge[count - 1], h);
      connected.unite(next_corner(edge[count - 1]), next_corner(h));
    }
  }
  return std::span(edge).first(count);
}

// Corners of one vertex that soft edges connect.
DisjointSets connect_corners(const Mesh& mesh, const SoftEdges& soft,
                             const std::vector<Vec3d>& normals) {
  const auto least_cosine = [&](double at_most) {
    return std::cos(radians(std::min(soft.max_angle_deg, at_most))) - 1e-12;
  };
  const double least_cosine_of_two = least_cosine(kMaxFoldAngleDeg);
  const double least_cosine_of_sheets = least_cosine(kMaxSheetAngleDeg);

  const auto is_soft = [&](std::uint32_t g, std::uint32_t h, double limit) {
    const std::size_t s = g / 3, t = h / 3;
    if (vertex_at(mesh, g) == vertex_at(mesh, h)) return false;  // same direction
    if (!soft.face_of_triangle.empty() && soft.face_of_triangle[s] == soft.face_of_triangle[t]) {
      return true;
    }
    if (!soft.smoothing_group.empty()) {
      return soft.smoothing_group[s] != 0 && soft.smoothing_group[s] == soft.smoothing_group[t];
    }
    return dot(normals[s], normals[t]) >= limit;
  };

  DisjointSets connected(3 * mesh.triangle_count());
  std::vector<std::uint32_t> copies;
  for_each_edge(mesh, [&](std::span<const std::uint32_t> whole_edge) {
    std::span<const std::uint32_t> edge = whole_edge;
    if (edge.size() > kMaxPairedTriangles) {  // a model may be there ten times
      copies.assign(edge.begin(), edge.end());
      edge = unite_copies(mesh, soft, copies, connected);
    }
    if (edge.size() > kMaxPairedTriangles) return;
    const double limit = edge.size() == 2 ? least_cosine_of_two : least_cosine_of_sheets;
    for (std::size_t i = 0; i < edge.size(); ++i) {
      for (std::size_t j = i + 1; j < edge.size(); ++j) {
        if (!is_soft(edge[i], edge[j], limit)) continue;
        connected.unite(edge[i], next_corner(edge[j]));
        connected.unite(next_corner(edge[i]), edge[j]);
      }
    }
  });
  return connected;
}

Sectors make_sectors(const Mesh& mesh, const SoftEdges& soft) {
  const std::vector<Vec3d> normals = face_normals(mesh, soft.face_of_triangle);
  DisjointSets connected = connect_corners(mesh, soft, normals);

  Sectors sectors;
  const std::uint32_t corner_count = static_cast<std::uint32_t>(3 * mesh.triangle_count());
  sectors.of_corner.resize(corner_count);
  std::vector<Vec3d> sums;
  std::vector<std::uint32_t> first_corner;
  for (std::uint32_t corner = 0; corner < corner_count; ++corner) {
    const std::uint32_t representative = connected.find(corner);  // the smallest: seen already
    if (representative == corner) {
      sectors.of_corner[corner] = static_cast<std::uint32_t>(sums.size());
      sums.push_back({});
      first_corner.push_back(corner);
    } else {
      sectors.of_corner[corner] = sectors.of_corner[representative];
    }
    const auto p = corners_of(mesh, corner / 3);
    const std::uint32_t c = corner % 3;
    const double weight =
        has_no_area(p[0], p[1], p[2]) ? 0 : angle_at(p[c], p[(c + 1) % 3], p[(c + 2) % 3]);
    sums[sectors.of_corner[corner]] += normals[corner / 3] * weight;
  }
  sectors.normals.reserve(sums.size());
  for (std::size_t s = 0; s < sums.size(); ++s) {
    // A sum that cancels says nothing: the first triangle speaks for the sector.
    const Vec3d n = length(sums[s]) > 1e-9 ? normalized(sums[s]) : normals[first_corner[s] / 3];
    sectors.normals.push_back(
        {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)});
  }
  return sectors;
}

}  // namespace

std::vector<Vec3d> face_normals(const Mesh& mesh, std::span<const std::uint32_t> face_of_triangle) {
  std::vector<Vec3d> normals(mesh.triangle_count());
  for (std::size_t t = 0; t < normals.size(); ++t) normals[t] = area_vector(mesh, t);
  if (!face_of_triangle.empty()) {
    std::vector<Vec3d> sums(1 +
                            *std::max_element(face_of_triangle.begin(), face_of_triangle.end()));
    for (std::size_t t = 0; t < normals.size(); ++t) sums[face_of_triangle[t]] += normals[t];
    for (std::size_t t = 0; t < normals.size(); ++t) {
      if (!is_zero(normalized(sums[face_of_triangle[t]]))) normals[t] = sums[face_of_triangle[t]];
    }
  }
  bool some_missing = false;
  for (Vec3d& normal : normals) {
    const double l = length(normal);
    // Squares of very large and very small vectors leave the doubles: scale them first.
    if (!std::isfinite(l) || l < 1e-150) {
      const double largest = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
      normal = largest > 0 ? normal * (1 / largest) : normal;
    }
    normal = normalized(normal);
    if (!is_finite(normal)) normal = {};
    some_missing = some_missing || is_zero(normal);
  }
  if (some_missing) fill_zero_normals(mesh, normals);
  return normals;
}

AttributeLayer generate_normals(const Mesh& mesh, const SoftEdges& soft) {
  Sectors sectors = make_sectors(mesh, soft);
  AttributeLayer layer{"normal", AttributeRole::Normal, Interpolation::Direction, 3, {}, {}};
  layer.values.reserve(3 * sectors.normals.size());
  for (const Vec3f& n : sectors.normals) layer.values.insert(layer.values.end(), {n.x, n.y, n.z});
  layer.of_corner.reserve(sectors.of_corner.size());
  for (std::uint32_t s : sectors.of_corner) layer.of_corner.push_back(AttributeId{s});
  join_normals(layer, mesh, kCoplanarDeg);
  return layer;
}

std::size_t complete_normals(AttributeLayer& given, const Mesh& mesh, const SoftEdges& soft) {
  const auto missing = static_cast<std::size_t>(
      std::count(given.of_corner.begin(), given.of_corner.end(), kNoAttribute));
  if (missing == 0) return 0;
  const Sectors sectors = make_sectors(mesh, soft);

  std::vector<AttributeId> of_sector(sectors.normals.size(), kNoAttribute);
  std::vector<float> nearness(sectors.normals.size(), -2);
  for (std::size_t corner = 0; corner < given.of_corner.size(); ++corner) {
    if (given.of_corner[corner] == kNoAttribute) continue;
    const std::span<const float> value = given.value(given.of_corner[corner]);
    const std::uint32_t s = sectors.of_corner[corner];
    const float cosine = dot(sectors.normals[s], Vec3f{value[0], value[1], value[2]});
    if (cosine <= nearness[s]) continue;
    nearness[s] = cosine;
    of_sector[s] = given.of_corner[corner];
  }
  for (std::size_t corner = 0; corner < given.of_corner.size(); ++corner) {
    if (given.of_corner[corner] != kNoAttribute) continue;
    AttributeId& own = of_sector[sectors.of_corner[corner]];
    if (own == kNoAttribute) {
      const Vec3f& n = sectors.normals[sectors.of_corner[corner]];
      own = AttributeId{static_cast<std::uint32_t>(given.value_count())};
      given.values.insert(given.values.end(), {n.x, n.y, n.z});
    }
    given.of_corner[corner] = own;
  }
  return missing;
}

double loose_crease_share(const Mesh& mesh, double angle_deg) {
  const std::vector<Vec3d> normals = face_normals(mesh, {});
  const double cosine = std::cos(radians(angle_deg));
  std::vector<std::uint32_t> creases_at(mesh.vertex_count(), 0);
  for_each_edge(mesh, [&](std::span<const std::uint32_t> edge) {
    if (edge.size() != 2 || dot(normals[edge[0] / 3], normals[edge[1] / 3]) >= cosine) return;
    ++creases_at[vertex_at(mesh, edge[0])];
    ++creases_at[vertex_at(mesh, next_corner(edge[0]))];
  });
  std::size_t any = 0, one = 0;
  for (std::uint32_t count : creases_at) {
    any += count > 0;
    one += count == 1;
  }
  return any == 0 ? 0 : static_cast<double>(one) / static_cast<double>(any);
}

}  // namespace crease
