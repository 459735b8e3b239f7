// Drawing on finished pictures: boxes and letters, in the font that is built in.
#pragma once

#include "crease/render.h"
#include "render/layout.h"
#include "render/palette.h"

#include <span>
#include <string_view>

namespace crease {

// The bytes of the font, a TrueType file.
std::span<const unsigned char> font_bytes();

void fill_rect(Image& image, const PixelRect& rect, const ColorSrgb& color);

// Width of one line of UTF-8 in letters `size_px` high.
float text_width(std::string_view text, float size_px);

// One line of UTF-8, its left end at x, its base line at y, both may be fractions of a pixel.
// What lies outside the picture is cut off. Characters the font does not have are drawn as boxes.
void draw_text(Image& image, std::string_view text, float x, float y, float size_px,
               const ColorSrgb& color);

// In the middle of `rect`; made smaller, then cut with an ellipsis, until it fits.
void draw_title(Image& image, std::string_view text, const PixelRect& rect, int size_px,
                const ColorSrgb& color);

}  // namespace crease
