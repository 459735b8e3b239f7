// What a PLY's faces say by number: their material, texture and part, which comments name.
#pragma once

#include "io/raw_mesh.h"

#include <span>
#include <string>

namespace crease {

// `layer`: a number of each face. False where it is no such number, or one that nothing is named
// by: then it is an attribute. Where materials are told, the numbers of their textures say nothing
// new.
bool take_index(const RawLayer& layer, std::span<const std::string> comments, RawMesh& mesh);

// Where no face has a number, one texture is all faces'.
void take_only_texture(std::span<const std::string> comments, RawMesh& mesh);

}  // namespace crease
