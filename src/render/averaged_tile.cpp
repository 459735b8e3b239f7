#include "render/averaged_tile.h"

#include "base/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace crease {

namespace {

// From encoded bytes to linear light, so that averages are of light.
struct SrgbTable {
  std::array<float, 256> linear{};
  SrgbTable() {
    for (std::size_t i = 0; i < linear.size(); ++i) linear[i] = linear_from_srgb(float(i) / 255);
  }
};

const SrgbTable& srgb() {
  static const SrgbTable table;
  return table;
}

std::uint8_t encode(float linear) {
  return std::uint8_t(std::lround(255 * srgb_from_linear(std::clamp(linear, 0.0f, 1.0f))));
}

}  // namespace

void AveragedTile::add(std::span<const std::uint8_t> rgba) {
  constexpr int s = kSupersampling;
  const SrgbTable& table = srgb();
  const std::size_t stride = std::size_t(width_) * s;
  ++drawings_;
  std::size_t at = 0;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x, ++at) {
      Sum& sum = sums_[at];
      for (int j = 0; j < s; ++j) {
        const std::size_t row = std::size_t((height_ - 1 - y) * s + j);  // bottom row first
        const std::uint8_t* from = &rgba[4 * (row * stride + std::size_t(x) * s)];
        for (int i = 0; i < s; ++i, from += 4) {
          for (int c = 0; c < 3; ++c) sum.light[c] += table.linear[from[c]] / (s * s);
          sum.cover += float(from[3]) / (255 * s * s);
        }
      }
    }
  }
}

void AveragedTile::lay_over(Image& image, int left, int top) const {
  const SrgbTable& table = srgb();
  std::size_t at = 0;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x, ++at) {
      const Sum& sum = sums_[at];
      if (sum.cover == 0) continue;
      std::uint8_t* pixel =
          &image
               .rgba[4 * (std::size_t(top + y) * std::size_t(image.width) + std::size_t(left + x))];
      const float share = 1 / float(drawings_), cover = sum.cover * share;
      for (std::size_t c = 0; c < 3; ++c) {
        pixel[c] = encode(sum.light[c] * share + (1 - cover) * table.linear[pixel[c]]);
      }
    }
  }
}

}  // namespace crease
