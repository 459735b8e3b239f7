// What is in a mesh or a .crease file, as the fields of `info --json` (docs/cli.md).
#pragma once

#include "cli/command.h"
#include "cli/model.h"
#include "crease/decode_model.h"
#include "crease/progressive_arrays.h"

#include <cstddef>
#include <span>
#include <utility>

namespace crease::cli {

// The corners of the box of a mesh that has vertices: low, high.
std::pair<Vec3d, Vec3d> bounds_of(const Mesh& mesh);
// Triangles and vertices by kind, attributes, materials, parts, bounds.
Json mesh_facts(const Mesh& mesh);
// The same of a whole file, decoded with DecodeOptions::count_bits, and what is of files alone.
// `arrays` are those of `model`.
Json file_facts(const ModelFile& file, const DecodedModel& model, const ProgressiveArrays& arrays);
// "images", with the bytes of each: of a mesh, or of a file's list.
Json images_json(std::span<const ImageFile> images);
Json images_json(std::span<const ImageEntry> images);
// What the head says, decoding nothing.
Json head_facts(const ModelFile& file);

struct BitsPerVertex {
  double total = 0, connectivity = 0, positions = 0, attributes = 0;
};
BitsPerVertex per_vertex(const StreamBits& bits, std::size_t vertices);
// Of all blocks; the total has head, directory and checksums besides, but no images.
BitsPerVertex whole_file_per_vertex(const ModelFile& file, const DecodedModel& model);

}  // namespace crease::cli
