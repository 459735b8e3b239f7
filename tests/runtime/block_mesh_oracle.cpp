#include "runtime/block_mesh_oracle.h"

#include "crease/block_view.h"
#include "runtime/draw_values.h"
#include "support/described_mesh.h"
#include "support/drawn_triangles.h"

#include <doctest/doctest.h>

#include <limits>

namespace crease {

namespace {

std::size_t used_vertex_count(const Mesh& mesh) {
  std::set<VertexId> used;
  for (const Triangle& t : mesh.triangles) used.insert(t.begin(), t.end());
  return used.size();
}

}  // namespace

void check_shown(const BlockFile& file, const BlockMesh& mesh, const BlockSet& refined) {
  const Mesh shown = mesh.extract();
  Result<DecodedModel> expected = decode_model(
      file, {.contracted_bands = 0,
             .wants = [&](const BlockEntry& entry) { return refined.contains(entry.id); }});
  REQUIRE(expected.ok());
  if (shown.parts.empty()) {  // their names have not arrived
    expected->mesh.parts.clear();
    expected->mesh.part_of_triangle.clear();
  }
  REQUIRE(check_mesh(shown).ok());
  CHECK((described(shown) == described(expected->mesh)));
  CHECK(shown.vertex_count() == used_vertex_count(expected->mesh));
  CHECK(mesh.triangle_count() == shown.triangle_count());
  CHECK(mesh.error().surface == expected->error.surface);
  TriangleBag drawn;
  for (const ShownRange& range : mesh.shown()) {
    add_drawn(range.block->draw_list(), {range.sn, range.fn, range.nsn}, drawn);
  }
  const Grid& grid = file.facts().grid;
  const auto place = [&grid](const Vec3d& p) { return draw_position(grid, grid.nearest(p)); };
  CHECK((drawn == drawn_of_mesh(shown, place)));
}

BlockSet refined_blocks(const BlockFile& file, const BlockMesh& mesh) {
  BlockSet refined;
  for (std::uint32_t b = 0; b < file.block_count(); ++b) {
    if (mesh.is_refined(BlockId{b})) refined.insert(BlockId{b});
  }
  return refined;
}

BlockSet wanted_blocks(const BlockFile& file, const ViewParameters& view) {
  BlockSet wanted;
  for (std::uint32_t p = file.page_count(); p-- > 0;) {
    const Result<DirectoryPage> page = file.read_page(p);
    REQUIRE(page.ok());
    for (std::size_t i = page->blocks.size(); i-- > 0;) {
      const BlockEntry& entry = page->blocks[i];
      const bool is_base = entry.facts.band == file.facts().bands.size();
      if (!is_base && !needs_block(entry.facts, file.facts().grid, view)) {
        if (!wanted.contains(entry.id)) continue;
      }
      wanted.insert(entry.id);
      for (const BlockId id : page->dependencies_of(entry.id)) wanted.insert(id);
    }
  }
  return wanted;
}

BlockViewParameters view_of_all() {
  BlockViewParameters parameters;
  parameters.view.camera.position = {0, 0, 3};
  parameters.view.camera.pixels = 1e-30;
  parameters.view.coarse_outside = false;
  parameters.in_levels = false;
  parameters.max_bytes = std::numeric_limits<std::size_t>::max();
  return parameters;
}

BlockViewParameters random_view(const Mesh& mesh, std::mt19937_64& random) {
  BlockViewParameters parameters = view_of_all();
  const auto vertex = [&] { return mesh.positions[random() % mesh.vertex_count()]; };
  parameters.view.camera.position = vertex() * 1.5;
  parameters.view.camera.target = vertex();
  if (!can_see(parameters.view.camera)) parameters.view.camera.target.z -= 1;
  parameters.view.camera.pixels = double(1 + random() % 64);
  parameters.view.coarse_outside = random() % 4 != 0;
  parameters.view.degrees = random() % 2 ? 0 : 5;
  parameters.view.hysteresis = 1;
  return parameters;
}

}  // namespace crease
