// What a model's materials are drawn in, on the GPU: base colours, and textures once they are
// there. Everything that shows the model shares it.
//
//   auto materials = std::make_shared<GlMaterials>();
//   materials->fill(list.materials);                 // base colours
//   materials->fill(list.materials, textures);       // later, with textures
#pragma once

#include "crease/mesh.h"
#include "render/gl_context.h"
#include "render/gl_objects.h"
#include "render/textures.h"

#include <array>
#include <memory>
#include <span>

namespace crease {

TextureLimits texture_limits(const GlLimits& gl);

class GlMaterials {
 public:
  void fill(std::span<const Material> materials, const Textures& textures = {});
  bool is_filled() const { return is_filled_; }

  // Two texels a material: its base colour and how much it covers; array and layer of its texture,
  // its cutoff, and whether the texture's alpha is how much it covers, too.
  const GlArray& texels() const { return texels_; }
  bool has_textures() const { return texture_bytes_ > 0; }
  bool has_translucent() const { return has_translucent_; }
  // The base colours are ours, by names, for what has no colours of its own.
  bool has_colors_of_names() const { return has_colors_of_names_; }
  // Binds the arrays to as many units from `first_unit` on.
  void bind_textures(int first_unit) const;
  std::size_t bytes() const { return texels_.bytes + texture_bytes_; }  // mipmaps among it

 private:
  GlArray texels_;
  std::array<GlTexture, kTextureArrays> arrays_;
  std::size_t texture_bytes_ = 0;
  bool has_colors_of_names_ = false, has_translucent_ = false;
  bool is_filled_ = false;
};

using GlMaterialsPtr = std::shared_ptr<GlMaterials>;

}  // namespace crease
