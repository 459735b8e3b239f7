#include "render/text.h"

#include "render/pixels.h"

#include <doctest/doctest.h>

#include <algorithm>

namespace crease {

namespace {

Image white(int width, int height) {
  Image image;
  image.width = width;
  image.height = height;
  image.rgba.assign(4 * std::size_t(width) * std::size_t(height), 255);
  return image;
}

struct Ink {
  int count = 0, left = 1 << 20, right = -1, top = 1 << 20, bottom = -1;
};

Ink ink_of(const Image& image) {
  Ink ink;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (pixel_at(image, x, y)[0] > 200) continue;
      ++ink.count;
      ink.left = std::min(ink.left, x);
      ink.right = std::max(ink.right, x);
      ink.top = std::min(ink.top, y);
      ink.bottom = std::max(ink.bottom, y);
    }
  }
  return ink;
}

}  // namespace

TEST_CASE("a title stands in the middle of its place") {
  Image image = white(400, 60);
  draw_title(image, "MMM", {100, 10, 200, 40}, 24, kTextColor);
  const Ink ink = ink_of(image);
  CHECK(ink.count > 100);
  CHECK(std::abs((ink.left + ink.right) / 2 - 200) <= 1);
  CHECK(std::abs((ink.top + ink.bottom) / 2 - 30) <= 1);
}

TEST_CASE("a long title stays inside its place") {
  for (const int width : {300, 80, 20}) {
    Image image = white(400, 60);
    draw_title(
        image,
        "a title much too long for the panel it stands above, \u00e4\u00f6\u00fc \u2264 \u00d7 2",
        {50, 10, width, 40}, 24, kTextColor);
    const Ink ink = ink_of(image);
    CAPTURE(width);
    CHECK(ink.count > 10);
    CHECK(ink.left >= 50);
    CHECK(ink.right < 50 + width);
  }
  Image image = white(40, 40);
  draw_title(image, "W", {0, 0, 3, 40}, 24, kTextColor);  // no room for one letter
  CHECK(ink_of(image).count == 0);
}

TEST_CASE("letters differ, and any bytes are drawn without harm") {
  Image a = white(40, 40), b = white(40, 40);
  draw_text(a, "a", 5, 30, 24, kTextColor);
  draw_text(b, "b", 5, 30, 24, kTextColor);
  CHECK(a.rgba != b.rgba);
  for (const char* text :
       {"\x80", "\xff\xfe", "\xc3", "\xe2\x82", "\xf0\x9f\x98\x80", "\xe2x\xac"}) {
    Image image = white(40, 40);
    draw_text(image, text, 5, 30, 24, kTextColor);
    CHECK(text_width(text, 24) > 0);
  }
  Image image = white(10, 10);
  draw_text(image, "partly outside", -30, -2, 40, kTextColor);
  draw_text(image, "outside", 100, 100, 40, kTextColor);
  fill_rect(image, {-5, -5, 3, 3}, kTextColor);
  CHECK(pixel_at(image, 0, 9) == Pixel{255, 255, 255});
}

}  // namespace crease
