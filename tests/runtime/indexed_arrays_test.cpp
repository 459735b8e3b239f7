// Vertices and indices against the list that they were made of, corner by corner.
#include "crease/indexed_arrays.h"
#include "crease/build_progressive_arrays.h"
#include "crease/progressive_mesh.h"
#include "runtime/block_mesh_oracle.h"
#include "support/drawn_triangles.h"
#include "support/mesh_zoo.h"
#include "support/painted_sheet.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

namespace crease {
namespace {

// All that makes a vertex of a corner: position, normal, colour, texture coordinates, material.
using CornerKey = std::array<float, 13>;
using Triangles = std::map<std::array<CornerKey, 3>, int>;

CornerKey key_of(const Vec3f& p, const Vec3f& n, const std::array<float, 4>& color,
                 const std::array<float, 2>& uv, std::uint32_t material) {
  return {p.x,
          p.y,
          p.z,
          n.x,
          n.y,
          n.z,
          color[0],
          color[1],
          color[2],
          color[3],
          uv[0],
          uv[1],
          float(material)};
}

void add_listed(const DrawList& list, const std::array<Range, 3>& ranges, Triangles& bag) {
  const std::array<const DrawPart*, 3> parts{&list.sn, &list.fn, &list.nsn};
  for (std::size_t i = 0; i < 3; ++i) {
    const DrawPart& part = *parts[i];
    for (std::size_t t = ranges[i].first; t < std::size_t(ranges[i].first) + ranges[i].count; ++t) {
      std::array<CornerKey, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t at = 3 * t + k;
        const std::uint32_t v = part.indices[at];
        const Vec3f& normal = i == 0   ? list.vertex_normals[v]
                              : i == 1 ? part.normals[t]
                                       : part.normals[at];
        corners[k] = key_of(list.positions[v], normal,
                            part.colors.empty() ? std::array<float, 4>{} : part.colors[at],
                            part.texcoords.empty() ? std::array<float, 2>{} : part.texcoords[at],
                            part.materials.empty() ? 0 : part.materials[t]);
      }
      ++bag[corners];
    }
  }
}

Triangles listed(const DrawList& list) {
  const auto all = [](const DrawPart& part) {
    return Range{0, std::uint32_t(part.triangle_count())};
  };
  Triangles bag;
  add_listed(list, {all(list.sn), all(list.fn), all(list.nsn)}, bag);
  return bag;
}

CornerKey vertex_key(const IndexedArrays& arrays, std::size_t v) {
  return key_of(arrays.positions[v], arrays.normals[v],
                arrays.colors.empty() ? std::array<float, 4>{} : arrays.colors[v],
                arrays.texcoords.empty() ? std::array<float, 2>{} : arrays.texcoords[v],
                arrays.materials.empty() ? 0 : arrays.materials[v]);
}

Triangles indexed(const IndexedArrays& arrays, const Range& triangles) {
  Triangles bag;
  for (std::size_t t = triangles.first; t < std::size_t(triangles.first) + triangles.count; ++t) {
    std::array<CornerKey, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = vertex_key(arrays, arrays.indices[3 * t + k]);
    }
    ++bag[corners];
  }
  return bag;
}

Triangles indexed(const IndexedArrays& arrays) {
  return indexed(arrays, {0, std::uint32_t(arrays.triangle_count())});
}

// `positions`: of the list; the zoo has meshes with several at one place.
void check_sound(const IndexedArrays& arrays, std::span<const Vec3f> positions) {
  const std::size_t count = arrays.vertex_count();
  CHECK(arrays.normals.size() == count);
  CHECK((arrays.colors.empty() || arrays.colors.size() == count));
  CHECK((arrays.texcoords.empty() || arrays.texcoords.size() == count));
  CHECK((arrays.materials.empty() || arrays.materials.size() == count));
  std::set<CornerKey> different;
  for (std::size_t v = 0; v < count; ++v) different.insert(vertex_key(arrays, v));
  std::set<FloatKey> places;
  for (const Vec3f& p : positions) places.insert(key(p));
  CHECK(different.size() <= count);
  CHECK(count - different.size() <= positions.size() - places.size());
  // In the order of triangles, so none is without.
  std::uint32_t next = 0;
  for (const std::uint32_t v : arrays.indices) {
    REQUIRE(v <= next);
    next += v == next;
  }
  CHECK(next == count);
  std::uint32_t first = 0;
  for (const MaterialRun& run : arrays.runs) {
    CHECK(run.triangles.first == first);
    CHECK(run.triangles.count > 0);
    first += run.triangles.count;
    if (arrays.materials.empty()) CHECK(run.material == 0);
    for (std::uint32_t c = 3 * run.triangles.first; c < 3 * first; ++c) {
      if (!arrays.materials.empty()) REQUIRE(arrays.materials[arrays.indices[c]] == run.material);
    }
  }
  CHECK(first == arrays.triangle_count());
}

// That each triangle is the one of the list that it says.
bool tells_sources(const IndexedArrays& arrays, const DrawList& list) {
  const std::array<const DrawPart*, 3> parts{&list.sn, &list.fn, &list.nsn};
  bool same = arrays.listed.size() == arrays.triangle_count();
  for (std::size_t c = 0; same && c < arrays.indices.size(); ++c) {
    const ListedTriangle& from = arrays.listed[c / 3];
    const std::uint32_t v =
        parts[std::size_t(from.kind)]->indices[3 * std::size_t(from.number) + c % 3];
    same = list.positions[v] == arrays.positions[arrays.indices[c]];
  }
  return same;
}

void check_list(const DrawList& list) {
  const IndexedArrays arrays = indexed_arrays(list);
  check_sound(arrays, list.positions);
  CHECK(arrays.origin == list.origin);
  CHECK(indexed(arrays) == listed(list));
  CHECK(tells_sources(arrays, list));
  // One run a material.
  std::set<std::uint32_t> materials;
  for (const MaterialRun& run : arrays.runs) CHECK(materials.insert(run.material).second);
}

// With texture coordinates, colours that change in the middle, and three materials in turns.
Mesh sheet_of_everything() {
  Mesh mesh = painted_sheet(9);
  mesh.materials.assign(3, mesh.materials[0]);
  for (std::uint32_t m = 0; m < 3; ++m) mesh.materials[m].name = "material " + std::to_string(m);
  AttributeLayer colors{"color", AttributeRole::Color, Interpolation::Linear, 3, {}, {}};
  colors.values = {1, 0, 0, 0, 1, 0};
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    mesh.material_of_triangle[t] = MaterialId{std::uint32_t(t / 7 % 3)};
    const AttributeId color{2 * t < mesh.triangle_count() ? 0u : 1u};
    colors.of_corner.insert(colors.of_corner.end(), 3, color);
  }
  mesh.layers.push_back(std::move(colors));
  return mesh;
}

TEST_CASE("vertices and indices have the corners of the list, and no vertex twice") {
  std::vector<ZooMesh> meshes = mesh_zoo();
  meshes.push_back({"painted", painted_sheet(9)});
  meshes.push_back({"everything", sheet_of_everything()});
  for (const ZooMesh& z : meshes) {
    CAPTURE(z.name);
    check_list(MeshDrawArrays(z.mesh).draw_list());
  }
  CHECK(indexed_arrays(MeshDrawArrays(sheet_of_everything()).draw_list()).runs.size() == 3);
  check_list(DrawList{});
}

TEST_CASE("a smooth level has a vertex for each position, a box four for each side") {
  const Mesh sphere = smooth_sphere(8, 16);
  CHECK(indexed_arrays(MeshDrawArrays(sphere).draw_list()).vertex_count() == sphere.vertex_count());
  const IndexedArrays box = indexed_arrays(MeshDrawArrays(hard_box(1)).draw_list());
  CHECK(box.vertex_count() == 24);
  CHECK(box.triangle_count() == 12);
}

// Returns how often a block was shown in part.
std::size_t check_blocks(const EncodedCase& c, std::uint64_t seed) {
  const BlockFile file = opened(c.bytes);
  BlockMesh mesh = mesh_of(file);
  std::map<BlockId, IndexedArrays> arrays_of;
  for (const ResidentBlockPtr& block : insert_all_blocks(file, mesh)) {
    const IndexedArrays& arrays = arrays_of[block->id()] = indexed_arrays(*block);
    check_sound(arrays, block->draw_list().positions);
    CHECK(indexed(arrays) == listed(block->draw_list()));
    CHECK(tells_sources(arrays, block->draw_list()));
  }
  std::mt19937_64 random(seed);
  std::size_t shown_parts = 0;
  for (int i = 0; i < (kSanitized ? 3 : 12); ++i) {
    mesh.update(i == 0 ? view_of_all() : random_view(c.mesh, random));
    for (const ShownRange& shown : mesh.shown()) {
      Triangles bag;
      add_listed(shown.block->draw_list(), {shown.sn, shown.fn, shown.nsn}, bag);
      const IndexedArrays& arrays = arrays_of.at(shown.block->id());
      CHECK(indexed(arrays, triangles_of(shown)) == bag);
      shown_parts += shown.triangle_count() < arrays.triangle_count();
    }
    for (const ShownCut& cut : mesh.shown_cuts()) check_list(cut.list);
  }
  return shown_parts;
}

TEST_CASE("what a view shows of a block are consecutive triangles of its vertices and indices") {
  std::size_t shown_parts = 0;
  for (const Mesh& mesh : {sheet_of_everything(), smooth_sphere(20, 40), hard_cylinder(40, 9)}) {
    shown_parts += check_blocks(simplified_case(mesh, 100, 14, kCoarsePrecision), 1);
  }
  CHECK(shown_parts > 0);
}

}  // namespace
}  // namespace crease
