// From model units to clip space, in doubles until the last step, so that city coordinates of
// 10^6 m reach the float pipeline as small numbers.
//
//   View view = make_view(camera, aspect);
//   upload(clip_from_list(view, list.origin, near_far, Window{}, false));
#pragma once

#include "crease/render.h"

#include <array>
#include <span>

namespace crease {

// Column-major, as OpenGL takes it.
using Matrix4f = std::array<float, 16>;

// Right-handed frame at the eye: x right, y above, z back towards the viewer.
struct View {
  Vec3d eye, right, above, back;
  double tan_half_width = 1, tan_half_height = 1;
};

struct DepthRange {
  double near = 0.1, far = 100;
};

// The part of the picture that a tile shows, each 0..1 from the lower left.
struct Window {
  double left = 0, right = 1, bottom = 0, top = 1;
};

// `aspect` is width over height of the picture. A picture narrower or wider than the camera's
// viewport shows at least what the viewport shows. An `up` along the line of sight is replaced by
// another axis.
View make_view(const Camera& camera, double aspect);

// What make_view() shows of the camera in a picture of so many pixels, as a camera of that shape.
Camera camera_for_shape(const Camera& camera, int width_px, int height_px);

// The distances between which all points lie, the near one never closer than 1/20,000 of the far
// one: inside a scene that costs the first 5 cm of a kilometre.
DepthRange depth_range(const View& view, const Vec3d& low, const Vec3d& high);

// The power of two that brings what lies within the range to lengths of 1 or so: floats of shaders
// then hold squares and cubes of them, of a grain of 1e-20 as of a galaxy.
double unit_of(const DepthRange& depth);

// Clip coordinates are in those units. Depth from -1 at the near plane to 1, or reversed from 1 to
// 0.
Matrix4f clip_from_list(const View& view, const Vec3d& origin, const DepthRange& depth,
                        const Window& window, bool reversed_depth);

struct Box {
  Vec3d low, high;
  bool empty = true;
  void add(const Vec3d& p);
};

// Its eight corners: bit 0 of `i` is the high end along x, bit 1 along y, bit 2 along z.
Vec3d corner_of(const Box& box, int i);

// Whether the box lies beyond one of the four sides of the view, or behind the eye.
bool is_beside(const View& view, const Box& box);

}  // namespace crease
