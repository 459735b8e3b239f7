#include "render/pixels.h"

#include "render/transform.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

namespace crease {

Pixel pixel_at(const Image& image, int x, int y) {
  const std::size_t at = 4 * (std::size_t(y) * std::size_t(image.width) + std::size_t(x));
  return {image.rgba[at], image.rgba[at + 1], image.rgba[at + 2]};
}

int difference(const Pixel& a, const Pixel& b) {
  int largest = 0;
  for (std::size_t c = 0; c < 3; ++c) largest = std::max(largest, std::abs(a[c] - b[c]));
  return largest;
}

double saturation(const Pixel& pixel) {
  const auto [low, high] = std::ranges::minmax(pixel);
  return high == 0 ? 0 : double(high - low) / high;
}

bool same_hue(const Pixel& pixel, const ColorSrgb& color) {
  const auto hue = [](float r, float g, float b) {
    return std::atan2(std::sqrt(3.0f) * (g - b), 2 * r - g - b);
  };
  const Color wanted = linear_from_srgb(color);
  const Color got = linear_from_srgb(
      ColorSrgb{std::uint8_t(pixel[0]), std::uint8_t(pixel[1]), std::uint8_t(pixel[2])});
  const float apart = std::abs(hue(wanted[0], wanted[1], wanted[2]) - hue(got[0], got[1], got[2]));
  return std::min(apart, 2 * float(kPi) - apart) < 0.12f && saturation(pixel) > 0.3;
}

Image draw(const DrawList& list, const RenderOptions& options) {
  const Panel panel{.list = list, .title = ""};
  Result<Image> image = render_panels(std::span(&panel, 1), options);
  if (!image.ok()) FAIL(image.failure().message);
  return *std::move(image);
}

std::array<double, 2> project(const Camera& camera, const Vec3d& p) {
  const View view = make_view(camera, double(camera.width_px) / camera.height_px);
  const Vec3d offset = p - view.eye;
  const double ahead = -dot(offset, view.back);
  const double x = dot(offset, view.right) / (ahead * view.tan_half_width);
  const double y = dot(offset, view.above) / (ahead * view.tan_half_height);
  return {(x + 1) / 2 * camera.width_px, (1 - y) / 2 * camera.height_px};
}

}  // namespace crease
