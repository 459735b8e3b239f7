// Positions in a format of floats, relative to an origin.
//
//   const Vec3d origin = round_origin(mesh);
//   out.f32(float(p.x - origin.x));          // off by float_rounding(mesh, origin) at most
#pragma once

#include "crease/mesh.h"

namespace crease {

// How far from its place a position is, at most, that is written as floats less the origin.
double float_rounding(const Mesh& mesh, const Vec3d& origin);

// For a format that has a place for the origin. Zero where floats hold every position exactly, else
// the middle of the bounding box.
Vec3d middle_origin(const Mesh& mesh);

// For a format that has none, so that whoever reads it sees the model elsewhere. Zero unless floats
// would be off by more than a millionth of the longest side; else a number that can be said: a
// multiple of the power of ten that is no less than that side, next to the middle.
Vec3d round_origin(const Mesh& mesh);

}  // namespace crease
