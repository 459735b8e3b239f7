// Which part of the model a drawn triangle belongs to, against the mesh that is extracted.
#include "crease/adaptive_mesh.h"
#include "crease/build_hierarchy.h"
#include "crease/build_progressive_arrays.h"
#include "crease/progressive_mesh.h"
#include "runtime/block_mesh_oracle.h"
#include "runtime/random_camera.h"
#include "support/drawn_triangles.h"
#include "support/mesh_zoo.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <random>

namespace crease {
namespace {

// Places of the corners, in no order, and the part.
using PartBag = std::map<std::pair<std::array<FloatKey, 3>, std::uint32_t>, int>;

void add(std::array<FloatKey, 3> corners, PartId part, PartBag& bag) {
  std::sort(corners.begin(), corners.end());
  ++bag[{corners, std::uint32_t(index_of(part))}];
}

// `part_of`: (kind, triangle) to PartId. Ranges of the three kinds.
template <typename PartOf>
void add_drawn(const DrawList& list, const std::array<Range, 3>& ranges, PartOf part_of,
               PartBag& bag) {
  const std::array<const DrawPart*, 3> parts{&list.sn, &list.fn, &list.nsn};
  for (std::size_t p = 0; p < 3; ++p) {
    for (std::size_t t = ranges[p].first; t < std::size_t(ranges[p].first) + ranges[p].count; ++t) {
      std::array<FloatKey, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = key(list.positions[parts[p]->indices[3 * t + k]]);
      }
      add(corners, part_of(TriangleKind(p), t), bag);
    }
  }
}

template <typename PartOf>
void add_all(const DrawList& list, PartOf part_of, PartBag& bag) {
  const auto all = [](const DrawPart& part) {
    return Range{0, std::uint32_t(part.triangle_count())};
  };
  add_drawn(list, {all(list.sn), all(list.fn), all(list.nsn)}, part_of, bag);
}

PartBag extracted(const Mesh& mesh, const Vec3d& origin) {
  PartBag bag;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    std::array<FloatKey, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d p = mesh.positions[index_of(mesh.triangles[t][k])] - origin;
      corners[k] = {float(p.x), float(p.y), float(p.z)};
    }
    add(corners, mesh.part_of_triangle.empty() ? PartId{0} : mesh.part_of_triangle[t], bag);
  }
  return bag;
}

// In five parts, or none.
Mesh with_parts(Mesh mesh, std::size_t count) {
  mesh.parts.clear();
  mesh.part_of_triangle.clear();
  for (std::size_t p = 0; p < count; ++p) mesh.parts.push_back("part " + std::to_string(p));
  for (std::size_t t = 0; t < mesh.triangle_count() && count > 0; ++t) {
    mesh.part_of_triangle.push_back(PartId{std::uint32_t(t / 3 % count)});
  }
  return mesh;
}

std::vector<EncodedCase> cases_of_parts() {
  std::vector<EncodedCase> all;
  for (const std::size_t parts : {5, 1, 0}) {
    for (const Mesh& mesh : {smooth_sphere(16, 20), hard_cylinder(24, 6)}) {
      all.push_back(simplified_case(with_parts(mesh, parts), 100, 14, kCoarsePrecision));
    }
  }
  return all;
}

TEST_CASE("triangles of levels and of views know their part of the model") {
  std::mt19937_64 random(3);
  for (const EncodedCase& c : cases_of_parts()) {
    const ProgressiveArraysPtr arrays = build_progressive_arrays(c.mesh, c.sequence);
    ProgressiveMesh level(arrays);
    for (const double share : {1.0, 0.6, 0.2, 0.0, 0.8}) {
      level.set_triangle_count(std::size_t(share * double(c.mesh.triangle_count())));
      const DrawList list = level.draw_list();
      PartBag bag;
      add_all(
          list, [&level](TriangleKind kind, std::size_t t) { return level.part_of(kind, t); }, bag);
      CHECK(bag == extracted(level.extract(), list.origin));
    }
    Result<MeshHierarchy> hierarchy = build_hierarchy(c.mesh, c.sequence, {});
    REQUIRE(hierarchy.ok());
    AdaptiveMesh view(std::make_shared<const MeshHierarchy>(*hierarchy));
    for (int i = 0; i < 6; ++i) {
      view.update({.camera = random_camera(*hierarchy, random)});
      const DrawList list = view.draw_list();
      PartBag bag;
      add_all(
          list, [&view](TriangleKind kind, std::size_t t) { return view.part_of(kind, t); }, bag);
      CHECK(bag == extracted(view.extract(), list.origin));
    }
  }
}

// By block, at levels of blocks, and by vertex.
TEST_CASE("triangles of blocks know their part of the model") {
  std::mt19937_64 random(4);
  std::size_t ranges = 0, levels = 0, cuts = 0;
  for (const EncodedCase& c : cases_of_parts()) {
    const BlockFile file = opened(c.bytes);
    BlockMesh mesh = mesh_of(file);
    for (const ResidentBlockPtr& block : insert_all_blocks(file, mesh)) {
      CHECK(block->bytes() <= mesh.bytes_of(block->facts()));
    }
    for (int i = 0; i < (kSanitized ? 6 : 24); ++i) {
      BlockViewParameters parameters = random_view(c.mesh, random);
      parameters.by_vertex = i % 2 == 1;
      parameters.in_levels = true;
      for (int k = 0; k < 3; ++k) {
        mesh.update(parameters);
        const auto missing_levels = mesh.missing_levels();
        for (const BlockId id : std::vector<BlockId>(missing_levels.begin(), missing_levels.end()))
          mesh.insert(mesh.levels_job(id)->run());
        const auto missing = mesh.missing_hierarchies();
        for (const BlockId id : std::vector<BlockId>(missing.begin(), missing.end()))
          mesh.insert(mesh.hierarchy_job(id)->run());
      }
      mesh.update(parameters);
      PartBag bag;
      for (const ShownRange& shown : mesh.shown()) {
        add_drawn(
            shown.block->draw_list(), {shown.sn, shown.fn, shown.nsn},
            [&shown](TriangleKind kind, std::size_t t) { return shown.block->part_of(kind, t); },
            bag);
        ++ranges;
      }
      for (const ShownCut& cut : mesh.shown_cuts()) {
        add_all(
            cut.list, [&](TriangleKind kind, std::size_t t) { return mesh.part_of(cut, kind, t); },
            bag);
        ++(cut.groups.empty() ? cuts : levels);
      }
      CHECK(bag == extracted(mesh.extract(), mesh.facts().grid.origin));
    }
  }
  CHECK(ranges > 0);
  CHECK(levels > 0);
  CHECK(cuts > 0);
}

}  // namespace
}  // namespace crease
