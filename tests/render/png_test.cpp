#include "crease/render.h"

#include <doctest/doctest.h>
#include <png.h>

#include <cstdlib>
#include <filesystem>
#include <vector>

namespace crease {

namespace {

struct TemporaryFolder {
  std::filesystem::path path;
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "crease_png_XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    path = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
};

}  // namespace

TEST_CASE("a picture written as PNG is read back pixel for pixel") {
  const TemporaryFolder folder;
  Image image;
  image.width = 37;
  image.height = 21;
  for (int i = 0; i < 4 * 37 * 21; ++i) {
    image.rgba.push_back(i % 4 == 3 ? 255 : std::uint8_t(i * 7919 >> 3));
  }
  REQUIRE(write_png(image, folder.path / "a.png").ok());
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path), {}) == 1);

  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  REQUIRE(png_image_begin_read_from_file(&png, (folder.path / "a.png").c_str()) != 0);
  CHECK(png.width == 37);
  CHECK(png.height == 21);
  png.format = PNG_FORMAT_RGBA;
  std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(png));
  REQUIRE(png_image_finish_read(&png, nullptr, pixels.data(), 0, nullptr) != 0);
  CHECK(pixels == image.rgba);
}

TEST_CASE("a picture that cannot be written says why and leaves nothing behind") {
  const TemporaryFolder folder;
  Image image;
  image.width = image.height = 1;
  image.rgba = {1, 2, 3, 255};
  const Status status = write_png(image, folder.path / "no" / "such" / "folder.png");
  REQUIRE(!status.ok());
  CHECK(status.failure().error == Error::WriteFailed);
  CHECK(status.failure().message.find("No such file") != std::string::npos);
  CHECK(std::filesystem::is_empty(folder.path));

  image.rgba.pop_back();
  CHECK(write_png(image, folder.path / "b.png").failure().error == Error::BadValue);
}

}  // namespace crease
