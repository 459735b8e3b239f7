// Materials of a GLB, with their images inside the file.
//
//   GlbMaterials materials;
//   std::vector<std::size_t> index_of_material = materials.add(mesh);     // for each mesh
//   materials.write(json, views, length);                                 // once
//   for (const ImageFile& image : materials.images()) ...                 // behind what was there
#pragma once

#include "crease/mesh.h"

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <unordered_map>
#include <vector>

namespace crease {

class GlbMaterials {
 public:
  // Where in the file each of the mesh's materials is. Equal ones are one. A texture needs
  // texture coordinates: images are for meshes that have some.
  std::vector<std::size_t> add(const Mesh& mesh);

  // "materials", "textures" and "images", a bufferView for each image from `length` on.
  void write(nlohmann::ordered_json& json, nlohmann::ordered_json& views,
             std::size_t& length) const;
  const std::vector<ImageFile>& images() const { return images_; }

 private:
  nlohmann::ordered_json material_json(const Material& material) const;

  std::vector<Material> materials_;
  std::unordered_multimap<std::string, std::size_t> by_name_;  // of those
  std::vector<ImageFile> images_;
};

}  // namespace crease
