#include "crease/render.h"
#include "crease/write_file.h"

#include <png.h>

#include <string>

namespace crease {

// libpng's simplified interface: it reports through the image and never jumps.
namespace {

Result<png_image> described(const Image& image) {
  const std::size_t bytes = std::size_t(image.width) * std::size_t(image.height) * 4;
  if (image.width <= 0 || image.height <= 0 || image.rgba.size() != bytes) {
    return fail(Error::BadValue, "the image has no pixels or not all of them");
  }
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = png_uint_32(image.width);
  png.height = png_uint_32(image.height);
  png.format = PNG_FORMAT_RGBA;
  return png;
}

}  // namespace

Result<std::vector<std::byte>> encode_png(const Image& image) {
  Result<png_image> png = described(image);
  if (!png.ok()) return png.failure();
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(*png);
  std::vector<std::byte> encoded(size);
  const int done =
      png_image_write_to_memory(&*png, encoded.data(), &size, 0, image.rgba.data(), 0, nullptr);
  if (done == 0) {
    const std::string why = png->message;
    png_image_free(&*png);
    return fail(Error::BadValue, "the picture cannot be encoded: " + why);
  }
  encoded.resize(size);
  return encoded;
}

Status write_png(const Image& image, const std::filesystem::path& path) {
  const Result<std::vector<std::byte>> bytes = encode_png(image);
  if (!bytes.ok()) {
    return fail(bytes.failure().error, path.string() + ": " + bytes.failure().message);
  }
  return write_file(path, *bytes);
}

}  // namespace crease
