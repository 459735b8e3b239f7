// EXT_mesh_gpu_instancing: a node's mesh stands at many places.
#pragma once

#include "crease/result.h"
#include "io/gltf_document.h"
#include "io/gltf_scene.h"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace crease {

// Where the instances stand, relative to the node: TRANSLATION, ROTATION and SCALE of the
// extension, in doubles. At most `most`. Counts in `ignored` what else instances have, by its name.
Result<std::vector<Transform>> read_instancing(const Source& source, const Json& extension,
                                               GltfReader& reader, std::size_t most,
                                               const std::string& place,
                                               std::map<std::string, std::size_t>& ignored);

}  // namespace crease
