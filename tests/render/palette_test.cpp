#include "render/palette.h"

#include <doctest/doctest.h>

namespace crease {

TEST_CASE("sRGB encodes and decodes to the same byte") {
  for (int i = 0; i < 256; ++i) {
    CHECK(std::lround(255 * srgb_from_linear(linear_from_srgb(float(i) / 255))) == i);
  }
}

TEST_CASE("materials keep their colours, unless all have a name and nothing else") {
  Material brick;
  brick.name = "ROOF_01";
  brick.base_color = {0.5f, 0.25f, 0.125f, 1};
  Material plain;
  plain.name = "wall";
  const std::vector<Material> colored{brick, plain};
  CHECK(material_colors(colored)[0] == brick.base_color);
  CHECK(material_colors(colored)[1] == plain.base_color);

  brick.base_color = plain.base_color;
  const std::vector<Material> named{brick, plain};
  const auto colors = material_colors(named);
  CHECK(colors[0][0] > 1.5f * colors[0][2]);  // roofs are red
  CHECK(colors[0] != colors[1]);
}

TEST_CASE("the error scale goes from blue to red") {
  CHECK(error_color(0) == kErrorStops.front());
  CHECK(error_color(1) == kErrorStops.back());
  CHECK(error_color(0)[2] > error_color(0)[0]);
  CHECK(error_color(1)[0] > error_color(1)[2]);
}

}  // namespace crease
