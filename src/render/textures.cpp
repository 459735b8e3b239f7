#include "render/textures.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <utility>

#define STB_IMAGE_RESIZE_STATIC
#define STB_IMAGE_RESIZE_IMPLEMENTATION
#include <stb_image_resize.h>

namespace crease {

namespace {

constexpr std::size_t kMostSizes = 64;

// Images of one array.
struct SizeClass {
  PixelSize size;
  std::vector<std::size_t> images;

  std::size_t bytes() const {
    return 4 * std::size_t(size.width) * std::size_t(size.height) * images.size();
  }
};

SizeClass merged(const SizeClass& a, const SizeClass& b) {
  SizeClass both{{std::max(a.size.width, b.size.width), std::max(a.size.height, b.size.height)},
                 a.images};
  both.images.insert(both.images.end(), b.images.begin(), b.images.end());
  return both;
}

std::vector<SizeClass> classes_of(std::span<const PixelSize> images) {
  std::vector<SizeClass> classes;
  for (std::size_t i = 0; i < images.size(); ++i) {
    const auto same = std::ranges::find(classes, images[i], &SizeClass::size);
    if (same != classes.end()) {
      same->images.push_back(i);
    } else {
      classes.push_back({images[i], {i}});
    }
  }
  return classes;
}

void merge_cheapest(std::vector<SizeClass>& classes) {
  std::size_t first = 0, second = 1;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (std::size_t a = 0; a < classes.size(); ++a) {
    for (std::size_t b = a + 1; b < classes.size(); ++b) {
      const PixelSize size = {std::max(classes[a].size.width, classes[b].size.width),
                              std::max(classes[a].size.height, classes[b].size.height)};
      const std::size_t together = 4 * std::size_t(size.width) * std::size_t(size.height) *
                                   (classes[a].images.size() + classes[b].images.size());
      const std::size_t more = together - classes[a].bytes() - classes[b].bytes();
      if (more >= least) continue;
      least = more;
      first = a;
      second = b;
    }
  }
  classes[first] = merged(classes[first], classes[second]);
  classes.erase(classes.begin() + std::ptrdiff_t(second));
}

void halve_until_they_fit(std::vector<SizeClass>& classes, std::size_t max_bytes) {
  while (true) {
    std::size_t bytes = 0;
    for (const SizeClass& one : classes) bytes += one.bytes();
    const auto largest = std::ranges::max_element(classes, {}, &SizeClass::bytes);
    if (bytes <= max_bytes || largest->size == PixelSize{1, 1}) return;
    largest->size = {std::max(1, largest->size.width / 2), std::max(1, largest->size.height / 2)};
  }
}

// In light, not in encoded values, and round the edges, since textures repeat.
Image resized(Image image, const PixelSize& size) {
  if (image.width == size.width && image.height == size.height) return image;
  Image result;
  result.width = size.width;
  result.height = size.height;
  constexpr int kAlpha = 3;  // is no light; and colours count whatever it is, as in mipmaps
  result.rgba.resize(4 * std::size_t(size.width) * std::size_t(size.height));
  stbir_resize_uint8_srgb_edgemode(image.rgba.data(), image.width, image.height, 0,
                                   result.rgba.data(), size.width, size.height, 0, 4, kAlpha,
                                   STBIR_FLAG_ALPHA_PREMULTIPLIED, STBIR_EDGE_WRAP);
  return result;
}

// Those that materials name, once each.
std::vector<const ImageFile*> used_images(std::span<const Material> materials,
                                          std::span<const ImageFile> images) {
  std::vector<const ImageFile*> used;
  for (const Material& material : materials) {
    const ImageFile* image = find_image(images, material.base_color_texture);
    if (image != nullptr && std::ranges::find(used, image) == used.end()) used.push_back(image);
  }
  return used;
}

}  // namespace

TexturePlan plan_textures(std::span<const PixelSize> images, const TextureLimits& limits) {
  std::vector<PixelSize> sizes(images.begin(), images.end());
  for (PixelSize& size : sizes) {
    size = {std::min(size.width, limits.max_side), std::min(size.height, limits.max_side)};
  }
  std::vector<SizeClass> classes = classes_of(sizes);
  if (classes.size() > kMostSizes) {
    for (PixelSize& size : sizes) {
      const auto power = [&](int side) {
        return std::min(int(std::bit_ceil(std::uint32_t(side))), limits.max_side);
      };
      size = {power(size.width), power(size.height)};
    }
    classes = classes_of(sizes);
  }
  while (classes.size() > kTextureArrays) merge_cheapest(classes);
  if (!classes.empty()) halve_until_they_fit(classes, limits.max_bytes);

  TexturePlan plan;
  plan.place_of_image.resize(images.size());
  for (const SizeClass& one : classes) {
    const auto array = int(plan.size_of_array.size());
    const std::size_t layers = std::min(one.images.size(), std::size_t(limits.max_layers));
    for (std::size_t i = 0; i < layers; ++i) plan.place_of_image[one.images[i]] = {array, int(i)};
    plan.size_of_array.push_back(one.size);
    plan.layers_of_array.push_back(int(layers));
  }
  return plan;
}

Textures decode_textures(std::span<const Material> materials, std::span<const ImageFile> images,
                         const TextureLimits& limits, const std::function<bool()>& stopped) {
  Textures textures;
  const auto leave_out = [&](const ImageFile& image, const std::string& why) {
    textures.notes.push_back("texture '" + image.name + "' is not drawn: " + why);
  };
  std::vector<const ImageFile*> used;
  std::vector<PixelSize> sizes;
  for (const ImageFile* image : used_images(materials, images)) {
    const Result<PixelSize> size = image_size(*image->bytes);
    if (size.ok()) {
      used.push_back(image);
      sizes.push_back(*size);
    } else {
      leave_out(*image, size.failure().message);
    }
  }
  TexturePlan plan = plan_textures(sizes, limits);
  std::vector<TexturePlace> place_of_used(used.size());
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (stopped && stopped()) return {};
    const TexturePlace place = plan.place_of_image[i];
    if (place.array < 0) {
      leave_out(*used[i], "more of its size than this device takes");
      continue;
    }
    Result<Image> image = decode_image(*used[i]->bytes);
    if (!image.ok()) {
      leave_out(*used[i], image.failure().message);
      continue;
    }
    textures.images.push_back(
        resized(*std::move(image), plan.size_of_array[std::size_t(place.array)]));
    textures.place_of_image.push_back(place);
    place_of_used[i] = place;
  }
  textures.size_of_array = std::move(plan.size_of_array);
  textures.layers_of_array = std::move(plan.layers_of_array);
  for (const Material& material : materials) {
    const ImageFile* image = find_image(images, material.base_color_texture);
    const auto at = std::ranges::find(used, image);
    textures.place_of_material.push_back(
        image == nullptr || at == used.end() ? TexturePlace{} : place_of_used[at - used.begin()]);
  }
  return textures;
}

}  // namespace crease
