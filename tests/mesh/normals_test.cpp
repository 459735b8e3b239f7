#include "mesh/normals.h"

#include "crease/shading.h"
#include "support/mesh_builder.h"
#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace crease {
namespace {

Mesh without_normals(Mesh mesh) {
  mesh.layers.clear();
  return mesh;
}

Mesh with_normals(Mesh mesh, const SoftEdges& soft) {
  AttributeLayer normals = generate_normals(mesh, soft);
  mesh.layers.clear();
  mesh.layers.push_back(std::move(normals));
  return mesh;
}

// Whether any two corners at one vertex share a normal in one mesh iff they do in the other.
bool has_same_sharing(const Mesh& a, const Mesh& b) {
  std::map<std::pair<VertexId, AttributeId>, AttributeId> forth, back;
  for (std::size_t corner = 0; corner < 3 * a.triangle_count(); ++corner) {
    const VertexId v = a.triangles[corner / 3][corner % 3];
    const AttributeId in_a = a.normals()->of_corner[corner], in_b = b.normals()->of_corner[corner];
    if (forth.emplace(std::pair(v, in_a), in_b).first->second != in_b) return false;
    if (back.emplace(std::pair(v, in_b), in_a).first->second != in_a) return false;
  }
  return true;
}

Vec3d normal_of(const AttributeLayer& normals, std::size_t corner) {
  const auto v = normals.value(normals.of_corner[corner]);
  return {v[0], v[1], v[2]};
}

double angle_deg(const Vec3d& a, const Vec3d& b) {
  return degrees(std::atan2(length(cross(a, b)), dot(a, b)));
}

TEST_CASE("a box gets one normal a side from an angle of 30 degrees") {
  for (int cells : {1, 3}) {
    const Mesh box = with_normals(hard_box(cells), {});
    CHECK(box.normals()->value_count() == 6);
    CHECK(has_same_sharing(box, hard_box(cells)));
  }
}

TEST_CASE("a cylinder gets hard rims and a smooth side, and caps of one normal each") {
  const Mesh cylinder = with_normals(hard_cylinder(24, 3), {});
  CHECK(has_same_sharing(cylinder, hard_cylinder(24, 3)));
}

TEST_CASE("a sphere is smooth below the angle and faceted above it") {
  const Mesh smooth = with_normals(smooth_sphere(24, 48), {});
  CHECK(has_same_sharing(smooth, smooth_sphere(24, 48)));
  for (std::size_t corner = 0; corner < 3 * smooth.triangle_count(); ++corner) {
    const VertexId v = smooth.triangles[corner / 3][corner % 3];
    CHECK(angle_deg(normal_of(*smooth.normals(), corner), smooth.positions[index_of(v)]) < 1);
  }
  const Mesh flat = with_normals(smooth_sphere(6, 8), {.max_angle_deg = kCoplanarDeg});
  const ShadingKinds kinds = classify_shading(flat);
  CHECK(std::count(kinds.of_triangle.begin(), kinds.of_triangle.end(), TriangleKind::NSN) == 0);
  CHECK(std::count(kinds.of_vertex.begin(), kinds.of_vertex.end(), VertexKind::SN) == 0);
}

TEST_CASE("creases of a solid hardly ever end, those of a noisy surface do at once") {
  CHECK(loose_crease_share(hard_box(16), 30) == 0);
  CHECK(loose_crease_share(hard_cylinder(64, 30), 30) == 0);
  CHECK(loose_crease_share(smooth_sphere(24, 48), 30) == 0);
  Mesh noisy = smooth_sphere(48, 96);
  for (std::size_t v = 0; v < noisy.vertex_count(); v += 7) {
    noisy.positions[v] = noisy.positions[v] * 1.02;
  }
  CHECK(loose_crease_share(noisy, 30) > 0.3);
}

TEST_CASE("smoothing groups decide alone") {
  // Sides 0 and 1 of a box in one group, the others in none.
  const Mesh box = without_normals(hard_box(1));
  std::vector<std::uint32_t> group(box.triangle_count(), 0);
  for (std::size_t t = 0; t < 4; ++t) group[t] = 7;
  Mesh grouped = with_normals(box, {.smoothing_group = group});
  const AttributeLayer& normals = *grouped.normals();
  // Where the two sides meet, they share a normal, unless they are opposite sides.
  std::size_t shared = 0;
  for (std::size_t a = 0; a < 6; ++a) {
    for (std::size_t b = 6; b < 12; ++b) {
      const bool same_vertex = grouped.triangles[a / 3][a % 3] == grouped.triangles[b / 3][b % 3];
      if (same_vertex) CHECK(normals.of_corner[a] == normals.of_corner[b]);
      shared += same_vertex;
    }
  }
  // Outside the group every triangle has its own side's normal.
  for (std::size_t corner = 12; corner < normals.of_corner.size(); corner += 3) {
    CHECK(normals.of_corner[corner] == normals.of_corner[corner + 1]);
  }
  CAPTURE(shared);
}

TEST_CASE("faces of the source have no hard edge inside, and one normal where all is flat") {
  //  3---2   A bent quad: its triangles differ by 90 degrees.
  //  | / |
  //  0---1
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.5, 0.5, 0.7}};
  mesh.triangles = {{VertexId{0}, VertexId{1}, VertexId{2}},
                    {VertexId{0}, VertexId{2}, VertexId{3}}};
  const std::vector<std::uint32_t> one_face{0, 0};
  CHECK(generate_normals(mesh, {.max_angle_deg = kCoplanarDeg}).value_count() == 2);
  CHECK(generate_normals(mesh, {.max_angle_deg = kCoplanarDeg, .face_of_triangle = one_face})
            .value_count() == 1);
}

TEST_CASE("an edge that two triangles run through the same way is hard") {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{VertexId{0}, VertexId{1}, VertexId{2}},
                    {VertexId{3}, VertexId{2}, VertexId{0}}};
  const AttributeLayer normals = generate_normals(mesh, {.max_angle_deg = 180});
  CHECK(normals.value_count() == 2);
  CHECK(normal_of(normals, 0) == -normal_of(normals, 3));
}

TEST_CASE("a smooth surface that is there many times is smooth, many pages of a book are not") {
  const Mesh sphere = smooth_sphere(6, 8);
  for (const int copies : {8, 9, 30}) {  // 16 triangles an edge, and more
    CAPTURE(copies);
    Mesh mesh;
    mesh.positions = sphere.positions;
    for (int i = 0; i < copies; ++i) {
      mesh.triangles.insert(mesh.triangles.end(), sphere.triangles.begin(), sphere.triangles.end());
    }
    const AttributeLayer normals = generate_normals(mesh, {.max_angle_deg = 180});
    CHECK(normals.value_count() == sphere.vertex_count());
  }
  Mesh book;
  book.positions = {{0, 0, 0}, {0, 0, 1}};
  for (std::uint32_t page = 0; page < 17; ++page) {
    book.positions.push_back({std::cos(0.01 * page), std::sin(0.01 * page), 0.5});
    book.triangles.push_back({VertexId{page % 2}, VertexId{1 - page % 2}, VertexId{page + 2}});
  }
  CHECK(generate_normals(book, {.max_angle_deg = 180}).value_count() == 17);
}

TEST_CASE("generated normals are unit and finite on the whole zoo, whatever the rule") {
  for (const ZooMesh& z : mesh_zoo()) {
    CAPTURE(z.name);
    for (double angle : {kCoplanarDeg, 30.0, 180.0}) {
      const Mesh mesh = with_normals(z.mesh, {.max_angle_deg = angle});
      CHECK(check_mesh(mesh).ok());
      for (std::size_t corner = 0; corner < 3 * mesh.triangle_count(); ++corner) {
        CHECK(std::abs(length(normal_of(*mesh.normals(), corner)) - 1) < 1e-6);
      }
    }
  }
}

TEST_CASE("a triangle without area takes its neighbour's normal") {
  //  0---1-2-3   The needle 0 1 3 lies on the upper triangle's edge 0 3.
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {1, 0, 5}};
  mesh.triangles = {{VertexId{0}, VertexId{1}, VertexId{2}},
                    {VertexId{0}, VertexId{2}, VertexId{3}}};
  const std::vector<Vec3d> normals = face_normals(mesh, {});
  CHECK(normals[0] == normals[1]);
  CHECK(angle_deg(normals[1], {0, -1, 0}) < 1e-9);
}

TEST_CASE("noise on a box goes: six normals, one a side") {
  for (int cells : {1, 4}) {
    Mesh box = noisy_box(cells, 0.5);
    CHECK(box.normals()->value_count() > 6);
    CHECK(join_normals(*box.normals(), box, 1.0) > 0);
    CHECK(box.normals()->value_count() == 6);
    CHECK(has_same_sharing(box, hard_box(cells)));
    for (std::size_t t = 0; t < box.triangle_count(); ++t) {
      CHECK(angle_deg(normal_of(*box.normals(), 3 * t), face_normals(box, {})[t]) < 0.5);
    }
  }
}

TEST_CASE("joining leaves smooth surfaces and true hard edges as they are") {
  for (const ZooMesh& z :
       {ZooMesh{"sphere", smooth_sphere(64, 128)}, ZooMesh{"torus", torus(64, 96)},
        ZooMesh{"cylinder", hard_cylinder(256, 8)}, ZooMesh{"box", hard_box(3)},
        ZooMesh{"walls", crossing_walls(3, 2)}}) {
    CAPTURE(z.name);
    Mesh joined = z.mesh;
    CHECK(join_normals(*joined.normals(), joined, 1.0) == 0);
    CHECK(has_same_sharing(joined, z.mesh));
    for (std::size_t corner = 0; corner < 3 * joined.triangle_count(); ++corner) {
      CHECK(normal_of(*joined.normals(), corner) == normal_of(*z.mesh.normals(), corner));
    }
  }
}

TEST_CASE("no normal moves farther than the angle, and none is parted from its equals") {
  for (const ZooMesh& z : mesh_zoo()) {
    for (double angle : {0.5, 5.0, 20.0}) {
      CAPTURE(z.name);
      CAPTURE(angle);
      Mesh joined = z.mesh;
      join_normals(*joined.normals(), joined, angle);
      CHECK(check_mesh(joined).ok());
      std::map<std::pair<VertexId, AttributeId>, AttributeId> after;
      for (std::size_t corner = 0; corner < 3 * joined.triangle_count(); ++corner) {
        CHECK(angle_deg(normal_of(*joined.normals(), corner),
                        normal_of(*z.mesh.normals(), corner)) <= angle * 1.01);
        const VertexId v = joined.triangles[corner / 3][corner % 3];
        const AttributeId a = joined.normals()->of_corner[corner];
        CHECK(after.emplace(std::pair(v, z.mesh.normals()->of_corner[corner]), a).first->second ==
              a);
      }
    }
  }
}

TEST_CASE("what becomes one normal spans no more than the angle, however wide that is") {
  for (const double angle : {10.0, 30.0, 50.0}) {
    for (const double apart : {0.5 * angle, 0.99 * angle, 1.03 * angle, 1.14 * angle}) {
      CAPTURE(angle);
      CAPTURE(apart);
      // A fan around a vertex whose normals lie on a circle of that width.
      Mesh mesh;
      mesh.positions = {{0, 0, 0}};
      AttributeLayer normals{"normal", AttributeRole::Normal, Interpolation::Direction, 3, {}, {}};
      constexpr std::uint32_t kCount = 12;
      for (std::uint32_t i = 0; i < kCount; ++i) {
        const double around = 2 * std::numbers::pi * i / kCount, away = radians(apart / 2);
        mesh.positions.push_back({std::cos(around), std::sin(around), 0});
        mesh.triangles.push_back({VertexId{0}, VertexId{i + 1}, VertexId{(i + 1) % kCount + 1}});
        for (const double x : {std::sin(away) * std::cos(around), std::sin(away) * std::sin(around),
                               std::cos(away)}) {
          normals.values.push_back(float(x));
        }
        normals.of_corner.insert(normals.of_corner.end(), 3, AttributeId{i});
      }
      join_normals(normals, mesh, angle);
      CHECK((normals.value_count() == 1) == (apart < angle));
    }
  }
}

TEST_CASE("a missing normal is taken from its sector") {
  Mesh box = hard_box(1);
  const Mesh whole = box;
  std::vector<AttributeId>& of_corner = box.normals()->of_corner;
  of_corner[0] = of_corner[10] = of_corner[11] = kNoAttribute;
  CHECK(complete_normals(*box.normals(), box, {}) == 3);
  for (std::size_t corner = 0; corner < of_corner.size(); ++corner) {
    CHECK(normal_of(*box.normals(), corner) == normal_of(*whole.normals(), corner));
  }
}

}  // namespace
}  // namespace crease
