// The images of a model as textures, ready for a GPU: decoded, and in as few sizes as one draw call
// can have.
//
//   Textures textures = decode_textures(list.materials, list.images, limits);   // on any thread
//   materials->fill(list.materials, textures);                                  // gl_materials.h
//
// A shader cannot choose among any number of textures, and triangles of a draw list are in an order
// that is not their materials'. So images are layers of a few texture arrays, which are all there
// in each draw call. All layers of an array have one size: images of up to four sizes stay as they
// are, beyond that some are stretched to the size of others that are not much larger. Repeating and
// mipmaps stay what they are, as they would not in an atlas.
#pragma once

#include "crease/mesh.h"
#include "crease/render.h"
#include "render/decode_image.h"

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace crease {

inline constexpr std::size_t kTextureArrays = 4;

struct TextureLimits {
  int max_side = 16'384, max_layers = 2048;
  std::size_t max_bytes = std::size_t(1) << 30;  // of all layers together, without mipmaps
};

struct TexturePlace {
  int array = -1, layer = 0;  // no array: no texture
  bool operator==(const TexturePlace&) const = default;
};

struct TexturePlan {
  std::vector<PixelSize> size_of_array;  // kTextureArrays at most
  std::vector<int> layers_of_array;
  std::vector<TexturePlace> place_of_image;
};

// Merges the sizes that cost the fewest bytes until there are kTextureArrays of them, then halves
// the array that takes most until all fit. What there is no layer for has no place.
// Time O(sizes^3), of at most 64 sizes; if there are more they are powers of two.
TexturePlan plan_textures(std::span<const PixelSize> images, const TextureLimits& limits);

struct Textures {
  std::vector<PixelSize> size_of_array;
  std::vector<int> layers_of_array;
  std::vector<TexturePlace> place_of_material;
  std::vector<Image> images;  // each in its array's size
  std::vector<TexturePlace> place_of_image;
  std::vector<std::string> notes;  // what could not be decoded, or found no place

  bool empty() const { return images.empty(); }
};

// `stopped`: asked before each image; what it stops has no textures. Memory: what the arrays take,
// and one image.
Textures decode_textures(std::span<const Material> materials, std::span<const ImageFile> images,
                         const TextureLimits& limits, const std::function<bool()>& stopped = {});

}  // namespace crease
