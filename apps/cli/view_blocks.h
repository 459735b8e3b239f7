// Which blocks of a file a camera's cut depends on.
//
//   options.wants = blocks_for_view(file.facts(), view);
//   Result<BlockDirectory> directory = BlockDirectory::read(file);
//   directory->triangles_at_most(view);    // of any cut that is made of those
#pragma once

#include "crease/adaptive_mesh.h"
#include "crease/block_file.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace crease::cli {

// More of them than are seen to be wrong, since the errors inside of a block that was not read are
// unknown. `facts` must outlive what is returned.
std::function<bool(const BlockEntry&)> blocks_for_view(const ModelFacts& facts,
                                                       const ViewParameters& view);

// What all blocks of a file say of themselves. Memory: some 150 bytes a block.
class BlockDirectory {
 public:
  static Result<BlockDirectory> read(const BlockFile& file);

  // Of the finest mesh that the blocks for the view make, with those that they need.
  std::uint64_t triangles_at_most(const ViewParameters& view) const;

 private:
  ModelFacts facts_;
  std::vector<DirectoryPage> pages_;
};

}  // namespace crease::cli
