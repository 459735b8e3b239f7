#include "render/legend.h"

#include "render/palette.h"
#include "render/text.h"

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace crease {

namespace {

constexpr int kScaleSteps = 256;

struct Entry {
  ColorSrgb color;
  std::string text;
};

float letter_px(const PixelRect& rect) {
  return 0.5f * float(rect.height);
}

float base_line(const PixelRect& rect) {
  return std::round(float(rect.y) + float(rect.height) / 2 + 0.31f * letter_px(rect));
}

void draw_entries(Image& image, const PixelRect& rect, const std::vector<Entry>& entries) {
  const float letter = letter_px(rect), swatch = letter, gap = 0.5f * letter, between = 2 * letter;
  float width = -between;
  for (const Entry& e : entries) width += swatch + gap + text_width(e.text, letter) + between;
  float x = float(rect.x) + (float(rect.width) - width) / 2;
  for (const Entry& e : entries) {
    const int y = rect.y + (rect.height - int(swatch)) / 2;
    fill_rect(image, {int(x), y, int(swatch), int(swatch)}, e.color);
    x += swatch + gap;
    draw_text(image, e.text, x, base_line(rect), letter, kTextColor);
    x += text_width(e.text, letter) + between;
  }
}

template <typename ColorOf>
void draw_scale(Image& image, const PixelRect& rect, const std::string& low,
                const std::string& high, ColorOf color_of) {
  const float letter = letter_px(rect), gap = 0.6f * letter;
  const int bar = rect.width / 4;
  const float width = text_width(low, letter) + gap + float(bar) + gap + text_width(high, letter);
  float x = float(rect.x) + (float(rect.width) - width) / 2;
  draw_text(image, low, x, base_line(rect), letter, kTextColor);
  x += text_width(low, letter) + gap;
  const int left = int(x), bar_height = int(0.8f * letter);
  for (int i = 0; i < kScaleSteps; ++i) {
    const int x0 = left + bar * i / kScaleSteps, x1 = left + bar * (i + 1) / kScaleSteps;
    fill_rect(image, {x0, rect.y + (rect.height - bar_height) / 2, x1 - x0, bar_height},
              color_of((float(i) + 0.5f) / kScaleSteps));
  }
  draw_text(image, high, float(left + bar) + gap, base_line(rect), letter, kTextColor);
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

}  // namespace

void draw_legend(Image& image, const PixelRect& rect, const LegendContent& content) {
  switch (content.coloring) {
    case Coloring::Shaded:
      return;
    case Coloring::Kind: {
      std::vector<Entry> entries;
      if (content.has_sn) {
        entries.push_back({kind_color(TriangleKind::SN), "SN: normals shared at its vertices"});
      }
      if (content.has_fn) entries.push_back({kind_color(TriangleKind::FN), "FN: one normal"});
      if (content.has_nsn) {
        entries.push_back({kind_color(TriangleKind::NSN), "NSN: three normals"});
      }
      return draw_entries(image, rect, entries);
    }
    case Coloring::Level:
      return draw_scale(image, rect, "full resolution", "base", level_color);
    case Coloring::Error: {
      const bool clipped = content.error_max > content.error_full * 1.0005;
      std::string high = number(content.error_full) + " " + content.error_unit;
      if (clipped) high = "\u2265 " + high;
      if (clipped && content.says_max) high += " (largest " + number(content.error_max) + ")";
      return draw_scale(image, rect, "0", high, error_color);
    }
  }
}

}  // namespace crease
