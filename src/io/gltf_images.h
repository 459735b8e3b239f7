// What a glTF's materials are painted with: the images inside the file, which texture coordinates
// they go by, and how those are transformed.
#pragma once

#include "crease/mesh.h"
#include "io/gltf_document.h"
#include "io/json.h"

#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace crease {

// How a primitive is painted: by TEXCOORD_set after KHR_texture_transform.
struct TextureUse {
  std::size_t set = 0;
  // u' = matrix[0] * u + matrix[1] * v + offset[0], v' = matrix[2] * u + ..., v down.
  std::array<float, 4> matrix{1, 0, 0, 1};
  std::array<float, 2> offset{};
};
TextureUse texture_use(const Json& texture_info);

// Whether a material is black but for the light that it gives off, which is what one sees of it.
bool shows_emission(const Json& material);

// The textureInfo of a material's base colour, or of its emission if it shows that; or null.
const Json& base_color_texture(const Json& material);

class GltfImages {
 public:
  GltfImages(const Source& source, const Json& json, GltfReader& reader)
      : source_(source), json_(json), reader_(reader) {}

  // The name of the image that `texture_info` refers to, or empty. One inside the file is taken the
  // first time; others have their uri for a name. One inside that is broken is a note and has no
  // name: there is nowhere else to look for it.
  std::string take(const Json& texture_info);

  std::vector<ImageFile> images;
  std::vector<std::string> notes;

 private:
  bool is_file(const std::string& name) const;
  std::string take_image(std::size_t index);
  Result<std::vector<std::byte>> bytes_of(const Json& image, const std::string& place);

  const Source& source_;
  const Json& json_;
  GltfReader& reader_;
  std::map<std::size_t, std::string> name_of_image_;
  std::set<std::size_t> without_image_;  // textures that were told
  std::size_t taken_bytes_ = 0;
};

}  // namespace crease
