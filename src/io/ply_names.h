// Materials and parts in a PLY, which has no place for them: an index a face, and comments.
//
//   comment material 0 brick                      the name of each
//   comment material_color 0 0.5 0.25 0.125 1     where it is not white; linear RGBA
//   comment material_texture 0 brick.png          where there is one
//   comment TextureFile brick.png                 each texture once, as MeshLab writes and reads
//   comment part 0 north wall
//   property int material_index                   of each face, and so part_index
//   property int texnumber                        of each face: its TextureFile or -1, where they
//                                                 differ, as MeshLab writes and reads
#pragma once

#include "crease/mesh.h"
#include "io/byte_sink.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace crease {

inline constexpr std::string_view kMaterialIndex = "material_index", kTextureIndex = "texnumber",
                                  kPartIndex = "part_index";

// The textures that materials name, each once.
struct PlyTextures {
  std::vector<std::string_view> names;
  std::vector<std::int32_t> of_material;  // -1: none

  explicit PlyTextures(std::span<const Material> materials);
  // One texture for all is found by its comment alone.
  bool need_numbers() const;
};

void write_material_comments(ByteSink& out, std::span<const Material> materials,
                             const PlyTextures& textures);
void write_part_comments(ByteSink& out, std::span<const std::string> parts);

// Out of a header's comments, as far as they count on from 0.
std::vector<Material> materials_in(std::span<const std::string> comments);
std::vector<std::string> parts_in(std::span<const std::string> comments);
// A material for each TextureFile.
std::vector<Material> textures_in(std::span<const std::string> comments);

}  // namespace crease
