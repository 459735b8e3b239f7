// Images of materials: which bytes are one, and what a mesh keeps of those that were found.
#pragma once

#include "crease/mesh.h"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace crease {

inline constexpr std::size_t kMaxImageBytes = std::size_t(256) << 20;
inline constexpr std::size_t kMaxImages = 4096;  // of a model; names are looked for one by one

// "image/png", "image/jpeg" by the first bytes, or empty: neither.
std::string_view image_type(std::span<const std::byte> bytes);

// For what has none: "is neither a PNG nor a JPEG, but WebP", as far as its first bytes tell.
std::string why_no_image(std::span<const std::byte> bytes);

// `name`, or with a number behind it, so that no image has it.
std::string unused_name(std::span<const ImageFile> images, const std::string& name);

// Images with the same bytes become the first of them, and those that no material names go.
void settle_images(std::span<Material> materials, std::vector<ImageFile>& images);

// Adds another mesh's images and makes its materials name them: what has the name of another image
// here gets a new one.
void append_images(std::span<const ImageFile> from, std::span<Material> materials_of_from,
                   std::vector<ImageFile>& to);

}  // namespace crease
