// Pixels of image files.
#pragma once

#include "crease/render.h"

#include <cstddef>
#include <span>

namespace crease {

struct PixelSize {
  int width = 0, height = 0;
  bool operator==(const PixelSize&) const = default;
};

// A picture of more is refused, whatever its file says and however small it is: 64 Mi pixels, as
// 8192 x 8192, are 256 MB.
inline constexpr int kMaxImageSide = 32'768;
inline constexpr std::size_t kMaxImagePixels = std::size_t(1) << 26;

// Of a PNG or JPEG, by its first bytes; reads the file's head. Fails with BadFormat, saying what
// the decoder does, with NotSupported for other files and OverLimit.
Result<PixelSize> image_size(std::span<const std::byte> file);

// All pixels, sRGB; no memory is taken before the size is known to be allowed.
Result<Image> decode_image(std::span<const std::byte> file);

}  // namespace crease
