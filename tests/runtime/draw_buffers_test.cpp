#include "crease/progressive_mesh.h"
#include "runtime/draw_values.h"
#include "support/level_equality.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <random>

namespace crease {
namespace {

struct PartCopy {
  std::vector<std::uint32_t> indices;
  std::vector<Vec3f> normals;
  std::vector<std::array<float, 4>> colors;
  std::vector<std::array<float, 2>> texcoords;
};

template <typename T>
std::vector<T> copy_of(std::span<const T> all) {
  return {all.begin(), all.end()};
}

// What a renderer holds.
struct Copies {
  std::vector<Vec3f> positions, vertex_normals;
  PartCopy sn, fn, nsn;

  explicit Copies(const DrawList& list)
      : positions(copy_of(list.positions)), vertex_normals(copy_of(list.vertex_normals)) {
    for (auto [part, from] : {std::pair{&sn, &list.sn}, {&fn, &list.fn}, {&nsn, &list.nsn}}) {
      *part = {copy_of(from->indices), copy_of(from->normals), copy_of(from->colors),
               copy_of(from->texcoords)};
    }
  }

  template <typename T>
  static void fetch(std::vector<T>& to, std::span<const T> from, const std::vector<Range>& ranges,
                    std::size_t per_element) {
    if (from.empty()) return;  // ranges of colours are those of texture coordinates, and back
    std::size_t end = 0;
    for (const Range& r : ranges) {
      REQUIRE(r.count > 0);
      REQUIRE(r.first >= end);  // sorted and disjoint
      end = std::size_t(r.first) + r.count;
      REQUIRE(end * per_element <= from.size());
      std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(r.first * per_element),
                  r.count * per_element,
                  to.begin() + static_cast<std::ptrdiff_t>(r.first * per_element));
    }
  }

  void patch(const DrawList& list, const DrawChanges& changes) {
    fetch(positions, list.positions, changes.positions, 1);
    fetch(vertex_normals, list.vertex_normals, changes.vertex_normals, 1);
    fetch(sn.indices, list.sn.indices, changes.sn_indices, 3);
    fetch(fn.indices, list.fn.indices, changes.fn_indices, 3);
    fetch(nsn.indices, list.nsn.indices, changes.nsn_indices, 3);
    fetch(fn.normals, list.fn.normals, changes.fn_normals, 1);
    fetch(nsn.normals, list.nsn.normals, changes.nsn_normals, 3);
    fetch(sn.colors, list.sn.colors, changes.sn_colors, 3);
    fetch(fn.colors, list.fn.colors, changes.fn_colors, 3);
    fetch(nsn.colors, list.nsn.colors, changes.nsn_colors, 3);
    fetch(sn.texcoords, list.sn.texcoords, changes.sn_colors, 3);
    fetch(fn.texcoords, list.fn.texcoords, changes.fn_colors, 3);
    fetch(nsn.texcoords, list.nsn.texcoords, changes.nsn_colors, 3);
  }
};

template <typename T>
bool begins_with(const std::vector<T>& copy, std::span<const T> active) {
  return copy.size() >= active.size() &&
         (active.empty() || std::memcmp(copy.data(), active.data(), active.size_bytes()) == 0);
}

bool same_part(const PartCopy& copy, const DrawPart& part) {
  return begins_with(copy.indices, part.indices) && begins_with(copy.normals, part.normals) &&
         begins_with(copy.colors, part.colors) && begins_with(copy.texcoords, part.texcoords);
}

// Positions of inactive slots are of no consequence.
bool same_vertices(const Copies& copies, const DrawList& list) {
  for (const DrawPart* part : {&list.sn, &list.fn, &list.nsn}) {
    for (std::uint32_t slot : part->indices) {
      if (!(copies.positions[slot] == list.positions[slot])) return false;
    }
  }
  for (std::uint32_t slot : list.sn.indices) {
    if (!(copies.vertex_normals[slot] == list.vertex_normals[slot])) return false;
  }
  return true;
}

void check_copies(const Case& c, std::uint64_t seed, bool one_by_one) {
  ProgressiveMesh pm(c.arrays);
  Copies copies(pm.draw_list());
  std::mt19937_64 random(seed);
  const std::size_t count = pm.contraction_count();
  for (int jump = 0; jump < 60; ++jump) {
    const std::size_t step = 1 + random() % 3;
    const std::size_t n = !one_by_one            ? random() % (count + 1)
                          : (jump / 20) % 2 == 0 ? std::min(count, pm.applied() + step)
                          : pm.applied() > step  ? pm.applied() - step
                                                 : 0;
    pm.set_applied(n);
    copies.patch(pm.draw_list(), pm.changes());
    ProgressiveMesh fresh(c.arrays);
    fresh.set_applied(n);
    const DrawList list = fresh.draw_list();
    REQUIRE(same_vertices(copies, list));
    REQUIRE(same_part(copies.sn, list.sn));
    REQUIRE(same_part(copies.fn, list.fn));
    REQUIRE(same_part(copies.nsn, list.nsn));
  }
}

TEST_CASE("copies that fetch only the reported ranges equal buffers made afresh") {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    CAPTURE(seed);
    const Case c = make_case(
        random_complex(seed, 24, 80),
        {.seed = seed, .placement = seed % 2 == 0 ? Placement::Endpoint : Placement::Optimal});
    check_copies(c, seed, false);
    check_copies(c, seed, true);
  }
  for (const ZooMesh& z : mesh_zoo()) {
    CAPTURE(z.name);
    check_copies(make_case(z.mesh, {.seed = 4}), 4, false);
    check_copies(make_case(z.mesh, {.seed = 4, .placement = Placement::Endpoint}), 4, true);
  }
}

// The draw list and the extracted mesh tell the same, corner by corner.
void check_draw_list(const ProgressiveMesh& pm) {
  const DrawList list = pm.draw_list();
  const Mesh mesh = pm.extract();
  const AttributeLayer* color = nullptr;
  for (const AttributeLayer& layer : mesh.layers) {
    if (color == nullptr && layer.role == AttributeRole::Color) color = &layer;
  }
  const std::uint32_t painted = drawn_texcoords(mesh.layers);
  const AttributeLayer* uv = painted == kNone ? nullptr : &mesh.layers[painted];
  std::size_t t = 0;
  for (const DrawPart* part : {&list.sn, &list.fn, &list.nsn}) {
    REQUIRE(part->texcoords.size() == (uv == nullptr ? 0 : part->indices.size()));
    REQUIRE(part->materials.size() ==
            (mesh.material_of_triangle.empty() ? 0 : part->triangle_count()));
    REQUIRE(part->colors.size() == (color == nullptr ? 0 : part->indices.size()));
    const std::size_t normals_per_triangle = part == &list.sn ? 0 : part == &list.fn ? 1 : 3;
    REQUIRE(part->normals.size() == normals_per_triangle * part->triangle_count());
    for (std::size_t i = 0; i < part->triangle_count(); ++i, ++t) {
      if (!part->materials.empty()) {
        REQUIRE(part->materials[i] == index_of(mesh.material_of_triangle[t]));
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t slot = part->indices[3 * i + k];
        const Vec3f& p = list.positions[slot];
        const Vec3d q = mesh.positions[index_of(mesh.triangles[t][k])] - list.origin;
        REQUIRE(length(Vec3d{p.x, p.y, p.z} - q) <= 1e-6 * (1 + length(q)));
        const auto value = mesh.normals()->value(mesh.normals()->of_corner[3 * t + k]);
        const Vec3f& n = part == &list.sn   ? list.vertex_normals[slot]
                         : part == &list.fn ? part->normals[i]
                                            : part->normals[3 * i + k];
        REQUIRE(n == Vec3f{value[0], value[1], value[2]});
        if (uv != nullptr) {
          const auto at = uv->value(uv->of_corner[3 * t + k]);
          REQUIRE(part->texcoords[3 * i + k] == std::array<float, 2>{at[0], at[1]});
        }
        if (color == nullptr) continue;
        REQUIRE(part->colors[3 * i + k] == draw_color(color->value(color->of_corner[3 * t + k])));
      }
    }
  }
  REQUIRE(t == mesh.triangle_count());
}

TEST_CASE("the draw list shows what extract() returns") {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const Case c = make_case(random_complex(seed, 20, 60), {.seed = seed});
    ProgressiveMesh pm(c.arrays);
    for (std::size_t n = 0; n <= pm.contraction_count(); ++n) {
      pm.set_applied(n);
      check_draw_list(pm);
    }
  }
  for (const ZooMesh& z : mesh_zoo()) {
    CAPTURE(z.name);
    const Case c = make_case(z.mesh, {.seed = 9});
    ProgressiveMesh pm(c.arrays);
    for (std::size_t n = 0; n <= pm.contraction_count(); n += 1 + n / 4) {
      pm.set_applied(n);
      check_draw_list(pm);
    }
  }
}

TEST_CASE("a small switch reports little") {
  const Case c = make_case(smooth_sphere(24, 32), {.seed = 1, .virtual_share = 0});
  ProgressiveMesh pm(c.arrays);
  const auto reported = [&pm] {
    std::size_t sum = 0;
    const DrawChanges& changes = pm.changes();
    for (const auto* ranges :
         {&changes.positions, &changes.vertex_normals, &changes.sn_indices, &changes.fn_indices,
          &changes.nsn_indices, &changes.fn_normals, &changes.nsn_normals}) {
      for (const Range& r : *ranges) sum += r.count;
    }
    return sum;
  };
  for (std::size_t n = 1; n < 100; ++n) {
    pm.set_applied(n);
    CHECK(reported() > 0);
    CHECK(reported() < 100);
  }
  pm.set_applied(99);
  CHECK(reported() == 0);
}

}  // namespace
}  // namespace crease
