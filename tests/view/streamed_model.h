// A mesh as a .crease of many small blocks in memory, and streams of it.
#pragma once

#include "crease/block_streamer.h"
#include "crease/mesh.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crease {

struct StreamedModel {
  std::vector<std::byte> bytes;
  Vec3d low, high;

  BlockStreamer stream() const;  // valid while this lives and stays where it is
};

StreamedModel streamed_model(const Mesh& mesh, std::uint32_t patch_triangles);

// Until the view is complete.
void finish(BlockStreamer& streamer, const BlockViewParameters& parameters);

}  // namespace crease
