// The smallest picture that holds a set of points, seen from a three-quarter view.
#pragma once

#include "render/transform.h"

#include <cstdint>
#include <span>
#include <vector>

namespace crease {

// Points of a scene: floats less an origin, as draw lists have them.
struct PointSet {
  Vec3d origin;
  std::span<const Vec3f> points;
};
using Scene = std::span<const PointSet>;

// As fit_camera, but as close as the points themselves allow, and not their box. Where nearly all
// of them lie within an eighth of the whole, such as a town on a wide ground, these and what is
// around. Time and memory linear in points.
Camera fit_camera_to(Scene scene, const Vec3d& up, int width_px, int height_px);

// The same from behind and to the right of someone who looks along `forward`; where that is up or
// down, from the three-quarter view.
Camera fit_camera_beside(Scene scene, const Vec3d& forward, const Vec3d& up, int width_px,
                         int height_px);

// Width over height of the scene in the picture that fit_camera_to would make: what the layout of
// panels goes by.
double projected_aspect(Scene scene, const Vec3d& up);

// Of each set the first that lies at its place, where one camera shows both: they are of one model,
// or the middle of the smaller model's box is in the other's, and they differ in size by no more
// than twice. `models`: one a set.
std::vector<std::size_t> places_of(Scene scene, std::span<const std::uint32_t> models);

}  // namespace crease
