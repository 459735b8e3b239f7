// What a BlockMesh should show, by decode_model() and needs_block() over all blocks.
#pragma once

#include "codec/encoded_model.h"
#include "crease/block_mesh.h"

#include <doctest/doctest.h>

#include <optional>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace crease {

using BlockSet = std::set<BlockId>;

// What is shown is the model of these blocks, as a mesh and as triangles to draw.
void check_shown(const BlockFile& file, const BlockMesh& mesh, const BlockSet& refined);

// Those that the cut goes through.
BlockSet refined_blocks(const BlockFile& file, const BlockMesh& mesh);

// What is seen to be wrong, and what that needs.
BlockSet wanted_blocks(const BlockFile& file, const ViewParameters& view);

// Whatever is off at all is wrong, wherever the camera is; no budget; blocks whole.
BlockViewParameters view_of_all();

// Some camera near the mesh, which has vertices.
BlockViewParameters random_view(const Mesh& mesh, std::mt19937_64& random);

// With all pages and names, and no block.
inline BlockMesh mesh_of(const BlockFile& file) {
  Result<BlockMesh> mesh = BlockMesh::open(file);
  REQUIRE(mesh.ok());
  while (const std::optional<std::uint32_t> page = mesh->next_page()) {
    REQUIRE(mesh->add_page(*file.read_page(*page)).ok());
  }
  mesh->set_part_names(*file.read_parts());
  return *std::move(mesh);
}

// Decodes all blocks into the mesh, coarse ones first.
inline std::vector<ResidentBlockPtr> insert_all_blocks(const BlockFile& file, BlockMesh& mesh) {
  std::vector<ResidentBlockPtr> blocks;
  for (std::uint32_t p = 0; p < file.page_count(); ++p) {
    const Result<DirectoryPage> page = file.read_page(p);
    REQUIRE(page.ok());
    for (const BlockEntry& entry : page->blocks) {
      const std::optional<BlockDecodeJob> job = mesh.decode_job(entry.id);
      REQUIRE(job.has_value());
      const Result<ResidentBlockPtr> block = job->run(*file.read_block(entry));
      REQUIRE(block.ok());
      mesh.insert(*block);
      blocks.push_back(*block);
    }
  }
  return blocks;
}

}  // namespace crease
