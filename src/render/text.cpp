#include "render/text.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

// assert() is left to debug builds, and the functions that are not used to the compiler.
#define STBTT_STATIC
#define STB_TRUETYPE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_truetype.h>
#pragma GCC diagnostic pop

namespace crease {

namespace {

// A subset of DejaVu Sans: printable ASCII, a few signs and umlauts (title_font.LICENSE).
constexpr unsigned char kFontBytes[] = {
#include "render/title_font.inc"
};

const stbtt_fontinfo& font() {
  static const stbtt_fontinfo info = [] {
    stbtt_fontinfo made{};
    stbtt_InitFont(&made, kFontBytes, 0);
    return made;
  }();
  return info;
}

// The next code point of UTF-8; malformed bytes count one each, as U+FFFD.
char32_t next_code_point(std::string_view& text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  const std::size_t count = first < 0x80    ? 1
                            : first >= 0xf0 ? 4
                            : first >= 0xe0 ? 3
                            : first >= 0xc0 ? 2
                                            : 0;
  if (count == 0 || count > text.size()) {
    text.remove_prefix(1);
    return 0xfffd;
  }
  char32_t code = count == 1 ? first : first & (0x7fu >> count);
  for (std::size_t i = 1; i < count; ++i) {
    if ((byte(i) & 0xc0) != 0x80) {
      text.remove_prefix(1);
      return 0xfffd;
    }
    code = code << 6 | (byte(i) & 0x3fu);
  }
  text.remove_prefix(count);
  return code;
}

float scale_for(float size_px) {
  return stbtt_ScaleForPixelHeight(&font(), size_px);
}

void blend(std::uint8_t& under, std::uint8_t over, float cover) {
  under = std::uint8_t(std::lround(float(under) + cover * (float(over) - float(under))));
}

}  // namespace

std::span<const unsigned char> font_bytes() {
  return kFontBytes;
}

void fill_rect(Image& image, const PixelRect& rect, const ColorSrgb& color) {
  const int x0 = std::max(0, rect.x), x1 = std::min(image.width, rect.x + rect.width);
  for (int y = std::max(0, rect.y); y < std::min(image.height, rect.y + rect.height); ++y) {
    for (int x = x0; x < x1; ++x) {
      std::uint8_t* pixel =
          &image.rgba[4 * (std::size_t(y) * std::size_t(image.width) + std::size_t(x))];
      std::copy(color.begin(), color.end(), pixel);
      pixel[3] = 255;
    }
  }
}

float text_width(std::string_view text, float size_px) {
  float width = 0;
  while (!text.empty()) {
    int advance = 0, bearing = 0;
    stbtt_GetCodepointHMetrics(&font(), int(next_code_point(text)), &advance, &bearing);
    width += float(advance) * scale_for(size_px);
  }
  return width;
}

void draw_text(Image& image, std::string_view text, float x, float y, float size_px,
               const ColorSrgb& color) {
  const float scale = scale_for(size_px);
  std::vector<unsigned char> cover;
  while (!text.empty()) {
    const int code = int(next_code_point(text));
    const float floor_x = std::floor(x), floor_y = std::floor(y);
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    stbtt_GetCodepointBitmapBoxSubpixel(&font(), code, scale, scale, x - floor_x, y - floor_y, &x0,
                                        &y0, &x1, &y1);
    const int width = x1 - x0, height = y1 - y0;
    if (width > 0 && height > 0) {
      cover.assign(std::size_t(width) * std::size_t(height), 0);
      stbtt_MakeCodepointBitmapSubpixel(&font(), cover.data(), width, height, width, scale, scale,
                                        x - floor_x, y - floor_y, code);
    }
    for (int j = 0; j < height; ++j) {
      for (int i = 0; i < width; ++i) {
        const int px = int(floor_x) + x0 + i, py = int(floor_y) + y0 + j;
        if (px < 0 || py < 0 || px >= image.width || py >= image.height) continue;
        const float share =
            float(cover[std::size_t(j) * std::size_t(width) + std::size_t(i)]) / 255;
        std::uint8_t* pixel =
            &image.rgba[4 * (std::size_t(py) * std::size_t(image.width) + std::size_t(px))];
        for (std::size_t c = 0; c < 3; ++c) blend(pixel[c], color[c], share);
      }
    }
    int advance = 0, bearing = 0;
    stbtt_GetCodepointHMetrics(&font(), code, &advance, &bearing);
    x += float(advance) * scale;
  }
}

void draw_title(Image& image, std::string_view text, const PixelRect& rect, int size_px,
                const ColorSrgb& color) {
  const float room = 0.96f * float(rect.width);
  float size = float(size_px);
  const float wanted = text_width(text, size);
  if (wanted > room) size = std::max(size * room / wanted, std::min(size, 10.0f));
  std::string shown(text);
  while (!shown.empty() && text_width(shown, size) > room) {
    std::string_view rest = text;
    std::size_t kept = 0;  // all characters but the last of what is shown now
    const std::size_t shown_bytes = shown.size() - (shown.ends_with("\u2026") ? 3 : 0);
    while (text.size() - rest.size() < shown_bytes) {
      kept = text.size() - rest.size();
      next_code_point(rest);
    }
    if (kept == 0) return;  // not even one letter
    shown = std::string(text.substr(0, kept)) + "\u2026";
  }
  const float x = float(rect.x) + (float(rect.width) - text_width(shown, size)) / 2;
  // Capitals are 0.63 of DejaVu's line height; they stand in the middle.
  const float y = std::round(float(rect.y) + float(rect.height) / 2 + 0.31f * size);
  draw_text(image, shown, x, y, size, color);
}

}  // namespace crease
