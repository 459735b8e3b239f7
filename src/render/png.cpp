#include "crease/render.h"

#include <png.h>

#include <cerrno>
#include <cstring>
#include <system_error>

namespace crease {

// libpng's simplified interface: it reports through the image and never jumps. The file appears
// under its name only when it is complete.
namespace {

// `where`: put before what is wrong.
Result<png_image> described(const Image& image, const std::string& where) {
  const std::size_t bytes = std::size_t(image.width) * std::size_t(image.height) * 4;
  if (image.width <= 0 || image.height <= 0 || image.rgba.size() != bytes) {
    return fail(Error::BadValue, where + "the image has no pixels or not all of them");
  }
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = png_uint_32(image.width);
  png.height = png_uint_32(image.height);
  png.format = PNG_FORMAT_RGBA;
  return png;
}

}  // namespace

Status write_png(const Image& image, const std::filesystem::path& path) {
  Result<png_image> png = described(image, path.string() + ": ");
  if (!png.ok()) return png.failure();
  std::filesystem::path part = path;
  part += ".part";
  if (png_image_write_to_file(&*png, part.c_str(), 0, image.rgba.data(), 0, nullptr) == 0) {
    const std::string why = errno != 0 ? std::strerror(errno) : png->message;
    png_image_free(&*png);
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    return fail(Error::WriteFailed, path.string() + ": cannot write the picture: " + why);
  }
  std::error_code error;
  std::filesystem::rename(part, path, error);
  if (error) return fail(Error::WriteFailed, path.string() + ": " + error.message());
  return Done{};
}

Result<std::vector<std::byte>> encode_png(const Image& image) {
  Result<png_image> png = described(image, "");
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

}  // namespace crease
