// What a model is painted with, read and decoded. Takes its time: for threads in the background.
#pragma once

#include "render/textures.h"
#include "view/open_model.h"

#include <cstdint>
#include <vector>

namespace crease {

struct ModelTextures {
  std::vector<Material> materials;
  Textures textures;
  std::uint64_t bytes_read = 0;
};

// Over a source of its own within `limit`. Images that are not in a file are looked for beside it.
// One that cannot be had is among the notes of the textures. Fails with Interrupted soon after the
// note says to stop.
Result<ModelTextures> load_textures(const ModelSource& model, const StreamLimit& limit,
                                    const TextureLimits& textures, Note& note);

}  // namespace crease
