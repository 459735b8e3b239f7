// Looking at pictures.
#pragma once

#include "crease/render.h"
#include "render/palette.h"

#include <array>

namespace crease {

using Pixel = std::array<int, 3>;

Pixel pixel_at(const Image& image, int x, int y);

// The largest difference of two pixels in a component.
int difference(const Pixel& a, const Pixel& b);

// 0: grey, 1: one of the components is zero. The background has less than 0.08.
double saturation(const Pixel& pixel);

// Whether the brightness may differ but not the colour: components in the same proportion.
bool same_hue(const Pixel& pixel, const ColorSrgb& color);

// One panel without a title, which fills the picture. The test fails when there is no picture.
Image draw(const DrawList& list, const RenderOptions& options);

// Where a point lies in a picture of that camera, in pixels from the upper left.
std::array<double, 2> project(const Camera& camera, const Vec3d& p);

}  // namespace crease
