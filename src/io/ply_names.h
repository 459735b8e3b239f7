// What a PLY has no place for, in comments: the axis that is up, materials and parts, with an index
// a face, and what layers are that properties' names do not tell.
//
//   comment up z                                  or y
//   comment material 0 brick                      the name of each
//   comment material_color 0 0.5 0.25 0.125 1     where it is not white; linear RGBA
//   comment material_texture 0 brick.png          where there is one
//   comment TextureFile brick.png                 each texture once, as MeshLab writes and reads
//   comment part 0 north wall
//   property int material_index                   of each face, and so part_index
//   property int texnumber                        of each face: its TextureFile or -1, where they
//                                                 differ, as MeshLab writes and reads
//   comment layer vertex uv2_0 2 texcoord linear uv2   2 properties from uv2_0 on are that layer's
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

// The layer that some properties of an element are.
struct PlyNamedLayer {
  std::string element;   // "vertex" or "face"
  std::string property;  // the first
  std::uint32_t dimension = 1;
  AttributeRole role = AttributeRole::Other;
  Interpolation interpolation = Interpolation::Linear;
  std::string name;
};

void write_layer_comment(ByteSink& out, const PlyNamedLayer& layer);
std::vector<PlyNamedLayer> layers_in(std::span<const std::string> comments);

void write_material_comments(ByteSink& out, std::span<const Material> materials,
                             const PlyTextures& textures);
void write_part_comments(ByteSink& out, std::span<const std::string> parts);
void write_up_comment(ByteSink& out, UpAxis up);

// Out of a header's comments, as far as they count on from 0.
std::vector<Material> materials_in(std::span<const std::string> comments);
std::vector<std::string> parts_in(std::span<const std::string> comments);
UpAxis up_in(std::span<const std::string> comments);
// A material for each TextureFile.
std::vector<Material> textures_in(std::span<const std::string> comments);

}  // namespace crease
