// Hard edges and borders.
#include "render/crease_lines.h"

#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <set>
#include <tuple>

namespace crease {

namespace {

std::size_t edge_count_of_box(int n) {
  return std::size_t(12 * n);
}

}  // namespace

TEST_CASE("a box has hard edges along its twelve edges and no border") {
  for (const int n : {1, 2, 5}) {
    const MeshDrawArrays arrays(hard_box(n));
    const CreaseLines lines = crease_lines(arrays.draw_list());
    CHECK(lines.hard.size() == edge_count_of_box(n));
    CHECK(lines.borders.empty());
    for (const Line3f& line : lines.hard) {
      int changed = 0;
      for (int i = 0; i < 3; ++i) changed += line.from[i] != line.to[i];
      CHECK(changed == 1);  // along an axis: no diagonal of a side
    }
  }
}

TEST_CASE("a smooth sphere has no line at all") {
  const MeshDrawArrays arrays(smooth_sphere(12, 24));
  const CreaseLines lines = crease_lines(arrays.draw_list());
  CHECK(lines.hard.empty());
  CHECK(lines.borders.empty());
}

// All normals of an edge's triangles compared, edge by edge.
TEST_CASE("of every mesh the lines are those that comparing all pairs of triangles finds") {
  for (const ZooMesh& z : mesh_zoo()) {
    CAPTURE(z.name);
    if (z.mesh.triangles.empty()) continue;
    const MeshDrawArrays arrays(z.mesh);
    const DrawList list = arrays.draw_list();
    using Ends = std::pair<std::uint32_t, std::uint32_t>;
    std::map<Ends, std::vector<std::array<Vec3f, 2>>> sides;
    for (const DrawPart* part : {&list.sn, &list.fn, &list.nsn}) {
      for (std::size_t c = 0; c < part->indices.size(); ++c) {
        const std::size_t d = c % 3 == 2 ? c - 2 : c + 1;
        const auto normal = [&](std::size_t at) {
          if (part == &list.sn) return list.vertex_normals[part->indices[at]];
          return part == &list.fn ? part->normals[at / 3] : part->normals[at];
        };
        const std::uint32_t a = part->indices[c], b = part->indices[d];
        if (a < b) sides[{a, b}].push_back({normal(c), normal(d)});
        if (b < a) sides[{b, a}].push_back({normal(d), normal(c)});
      }
    }
    const float same = std::cos(kSameNormalDeg * 3.14159265f / 180);
    std::size_t hard = 0, borders = 0;
    for (const auto& [ends, all] : sides) {
      bool is_hard = false;
      for (const auto& side : all) {
        is_hard |= dot(side[0], all[0][0]) < same || dot(side[1], all[0][1]) < same;
      }
      hard += is_hard && all.size() > 1;
      borders += all.size() == 1;
    }
    const CreaseLines lines = crease_lines(list);
    CHECK(lines.hard.size() == hard);
    CHECK(lines.borders.size() == borders);
  }
}

//   0---1---2   Two groups with the edge 1-4 between them: each sees a rim there, together they see
//   | A | B |   what the whole sees.
//   3---4---5
TEST_CASE("groups that are joined have the lines of the whole") {
  for (const ZooMesh& z : mesh_zoo()) {
    CAPTURE(z.name);
    if (z.mesh.triangles.empty()) continue;
    const MeshDrawArrays arrays(z.mesh);
    const DrawList list = arrays.draw_list();
    const DrawRanges all = all_of(list);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> triangles_of_edge;
    for (const DrawPart* part : {&list.sn, &list.fn, &list.nsn}) {
      for (std::size_t c = 0; c < part->indices.size(); ++c) {
        const std::size_t d = c % 3 == 2 ? c - 2 : c + 1;
        ++triangles_of_edge[std::minmax(part->indices[c], part->indices[d])];
      }
    }
    bool is_manifold = true;  // two places in one would join as well
    std::set<std::tuple<float, float, float>> places;
    for (const auto& [edge, count] : triangles_of_edge) is_manifold &= count <= 2;
    for (const Vec3f& p : list.positions) is_manifold &= places.insert({p.x, p.y, p.z}).second;
    if (!is_manifold) continue;
    const auto half = [](const Range& r, bool second) {
      return second ? Range{r.first + r.count / 2, r.count - r.count / 2}
                    : Range{r.first, r.count / 2};
    };
    std::size_t hard = 0;
    std::vector<GroupLines> groups;
    for (const bool second : {false, true}) {
      groups.push_back(
          lines_of(list, {half(all.sn, second), half(all.fn, second), half(all.nsn, second)}));
      hard += groups.back().hard.size();
    }
    const std::span<const RimEdge> rims[] = {groups[0].rim, groups[1].rim};
    const CreaseLines between = join_rims(rims);
    const CreaseLines whole = crease_lines(list);
    CHECK(hard + between.hard.size() == whole.hard.size());
    CHECK(between.borders.size() == whole.borders.size());
  }
}

}  // namespace crease
