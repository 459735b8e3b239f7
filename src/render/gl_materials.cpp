#include "render/gl_materials.h"

#include "render/palette.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace crease {

namespace {

// Colours are decoded when they are read, so that filters average light.
GlTexture make_array(const PixelSize& size, int layers) {
  GlTexture texture = GlTexture::make();
  glBindTexture(GL_TEXTURE_2D_ARRAY, texture.id());
  glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_SRGB8_ALPHA8, size.width, size.height, layers, 0, GL_RGBA,
               GL_UNSIGNED_BYTE, nullptr);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_REPEAT);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_REPEAT);
  return texture;
}

void set_layer(const GlTexture& texture, int layer, const Image& image) {
  glBindTexture(GL_TEXTURE_2D_ARRAY, texture.id());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, layer, image.width, image.height, 1, GL_RGBA,
                  GL_UNSIGNED_BYTE, image.rgba.data());
}

// The least that a material covers without its texture. Files say 0 of glass, and of everything
// where they mean its opposite; neither should be gone.
constexpr float kLeastCover = 0.15f;

bool is_translucent(const Material& material) {
  return (material.is_blended && !material.base_color_texture.empty()) ||
         material.base_color[3] < 1;
}

}  // namespace

TextureLimits texture_limits(const GlLimits& gl) {
  GLint layers = 256;
  glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &layers);
  return {.max_side = gl.max_texture_size, .max_layers = layers};
}

void GlMaterials::fill(std::span<const Material> materials, const Textures& textures) {
  is_filled_ = true;
  texture_bytes_ = 0;
  arrays_ = {};
  for (std::size_t a = 0; a < textures.size_of_array.size(); ++a) {
    const PixelSize& size = textures.size_of_array[a];
    arrays_[a] = make_array(size, textures.layers_of_array[a]);
    const std::size_t bytes = 4 * std::size_t(size.width) * std::size_t(size.height) *
                              std::size_t(textures.layers_of_array[a]);
    texture_bytes_ += bytes + bytes / 3;
  }
  for (std::size_t i = 0; i < textures.images.size(); ++i) {
    const TexturePlace& place = textures.place_of_image[i];
    set_layer(arrays_[std::size_t(place.array)], place.layer, textures.images[i]);
  }
  for (const GlTexture& array : arrays_) {
    if (!array) continue;
    glBindTexture(GL_TEXTURE_2D_ARRAY, array.id());
    glGenerateMipmap(GL_TEXTURE_2D_ARRAY);
  }
  has_colors_of_names_ = have_names_only(materials);
  has_translucent_ = std::ranges::any_of(materials, is_translucent);
  std::vector<std::array<float, 4>> texels;
  const std::vector<std::array<float, 4>> colors = material_colors(materials);
  for (std::size_t m = 0; m < colors.size(); ++m) {
    const TexturePlace place =
        m < textures.place_of_material.size() ? textures.place_of_material[m] : TexturePlace{};
    const Material& material = materials[m];
    const auto& [red, green, blue, alpha] = colors[m];
    texels.push_back({red, green, blue, std::max(alpha, kLeastCover)});
    texels.push_back({float(place.array), float(place.layer), material.alpha_cutoff,
                      is_translucent(material) ? 1.0f : 0.0f});
  }
  texels_ = upload(std::span<const std::array<float, 4>>(texels), GL_RGBA32F);
}

void GlMaterials::bind_textures(int first_unit) const {
  for (std::size_t a = 0; a < arrays_.size(); ++a) {
    glActiveTexture(GLenum(GL_TEXTURE0 + first_unit + int(a)));
    glBindTexture(GL_TEXTURE_2D_ARRAY, arrays_[a].id());
  }
}

}  // namespace crease
