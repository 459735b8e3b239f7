#include "render/decode_image.h"

#include <png.h>
#include <turbojpeg.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>

namespace crease {

namespace {

Result<PixelSize> allowed(std::size_t width, std::size_t height) {
  if (width == 0 || height == 0) return fail(Error::BadFormat, "a picture without pixels");
  if (width > std::size_t(kMaxImageSide) || height > std::size_t(kMaxImageSide) ||
      width * height > kMaxImagePixels) {
    return fail(Error::OverLimit, "a picture of " + std::to_string(width) + " x " +
                                      std::to_string(height) + " pixels; at most " +
                                      std::to_string(kMaxImagePixels) + " are drawn");
  }
  return PixelSize{int(width), int(height)};
}

// libpng's simplified interface, which never jumps.
class PngReader {
 public:
  explicit PngReader(std::span<const std::byte> file) {
    png_.version = PNG_IMAGE_VERSION;
    is_open_ = png_image_begin_read_from_memory(&png_, file.data(), file.size()) != 0;
  }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_image_free(&png_); }

  Result<PixelSize> size() const {
    if (!is_open_) return failed();
    return allowed(png_.width, png_.height);
  }
  Status read(std::span<std::uint8_t> rgba) {
    png_.format = PNG_FORMAT_RGBA;
    if (png_image_finish_read(&png_, nullptr, rgba.data(), 0, nullptr) == 0) return failed();
    return Done{};
  }

 private:
  Failure failed() const { return fail(Error::BadFormat, std::string("PNG: ") + png_.message); }

  png_image png_{};
  bool is_open_ = false;
};

class JpegReader {
 public:
  explicit JpegReader(std::span<const std::byte> file)
      : file_(file), decoder_(tjInitDecompress(), &tjDestroy) {}

  Result<PixelSize> size() const {
    int width = 0, height = 0, subsampling = 0, colors = 0;
    if (!decoder_ || tjDecompressHeader3(decoder_.get(), bytes(), length(), &width, &height,
                                         &subsampling, &colors) != 0) {
      return failed();
    }
    return allowed(std::size_t(std::max(width, 0)), std::size_t(std::max(height, 0)));
  }
  // What is merely odd is drawn. A file of very many scans, each of which costs a pass, is not.
  Status read(std::span<std::uint8_t> rgba, const PixelSize& size) {
    const int done = tjDecompress2(decoder_.get(), bytes(), length(), rgba.data(), size.width, 0,
                                   size.height, TJPF_RGBA, TJFLAG_LIMITSCANS);
    if (done != 0 && tjGetErrorCode(decoder_.get()) != TJERR_WARNING) return failed();
    return Done{};
  }

 private:
  const unsigned char* bytes() const {
    return reinterpret_cast<const unsigned char*>(file_.data());
  }
  unsigned long length() const { return static_cast<unsigned long>(file_.size()); }
  Failure failed() const {
    return fail(Error::BadFormat, std::string("JPEG: ") + tjGetErrorStr2(decoder_.get()));
  }

  std::span<const std::byte> file_;
  std::unique_ptr<void, int (*)(tjhandle)> decoder_;
};

enum class ImageKind { Png, Jpeg, Other };

ImageKind kind_of(std::span<const std::byte> file) {
  constexpr std::array kPng{std::byte{0x89}, std::byte{'P'}, std::byte{'N'}, std::byte{'G'}};
  constexpr std::array kJpeg{std::byte{0xff}, std::byte{0xd8}, std::byte{0xff}};
  const auto starts = [&](std::span<const std::byte> with) {
    return file.size() >= with.size() && std::equal(with.begin(), with.end(), file.begin());
  };
  return starts(kPng) ? ImageKind::Png : starts(kJpeg) ? ImageKind::Jpeg : ImageKind::Other;
}

Failure neither() {
  return fail(Error::NotSupported, "neither a PNG nor a JPEG");
}

Image blank(const PixelSize& size) {
  Image image;
  image.width = size.width;
  image.height = size.height;
  image.rgba.resize(4 * std::size_t(size.width) * std::size_t(size.height));
  return image;
}

}  // namespace

Result<PixelSize> image_size(std::span<const std::byte> file) {
  switch (kind_of(file)) {
    case ImageKind::Png:
      return PngReader(file).size();
    case ImageKind::Jpeg:
      return JpegReader(file).size();
    case ImageKind::Other:
      break;
  }
  return neither();
}

Result<Image> decode_image(std::span<const std::byte> file) {
  const ImageKind kind = kind_of(file);
  if (kind == ImageKind::Other) return neither();
  if (kind == ImageKind::Png) {
    PngReader png(file);
    const Result<PixelSize> size = png.size();
    if (!size.ok()) return size.failure();
    Image image = blank(*size);
    if (const Status read = png.read(image.rgba); !read.ok()) return read.failure();
    return image;
  }
  JpegReader jpeg(file);
  const Result<PixelSize> size = jpeg.size();
  if (!size.ok()) return size.failure();
  Image image = blank(*size);
  if (const Status read = jpeg.read(image.rgba, *size); !read.ok()) return read.failure();
  return image;
}

}  // namespace crease
