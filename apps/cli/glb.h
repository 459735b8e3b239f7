// Several GLBs, one per level of detail, as one GLB with the extension MSFT_lod.
#pragma once

#include "crease/result.h"

#include <cstddef>
#include <span>
#include <vector>

namespace crease::cli {

// `levels` from fine to coarse, each as export_bytes(mesh, ".glb") makes it: one buffer, one scene.
Result<std::vector<std::byte>> merge_lod_glb(std::span<const std::vector<std::byte>> levels);

}  // namespace crease::cli
