// How far the furthest point of one surface is from another: not of samples, of all its points.
//
// Branch and bound over the triangles of the one surface. A *piece* is a triangle or a part of one,
// with a bound that no point of it is further than. One query, at its middle, tightens the bound
// two ways: the distance grows no faster than one walks, and the distance to the one triangle that
// was found is convex, so no point of the piece is further from it than the furthest corner. The
// second is what ends on walls: a piece that lies over one triangle is settled at once, whatever
// its size. A piece that is not settled is halved, or cut along the border of the triangle that was
// found, so that what lies over it is.
//
//        from  -----+------+--------   the middle part lies over the triangle below it: its corners
//        to      ----======----        are its bound
#pragma once

#include "measure/surface.h"
#include "parallel/shared_progress.h"

namespace crease {

// All lengths are in frame units.
struct Furthest {
  double distance = 0;  // of the furthest point that was found, or what was known
  double bound = 0;     // no point is further
  std::size_t queries = 0;
};

struct FurthestOptions {
  double at_least = 0;       // what is known to be as far; nothing that is nearer is looked for
  double relative = 0;       // Points that are further by this share of the distance than the one
                             // found are not looked for,
  double absolute = 0;       // nor those that are further by so little.
  bool any_will_do = false;  // the first point that is further ends the search
  std::size_t max_queries = 0;  // beside those of vertices; where they do not do, `bound` is larger
};

// Depends on the surfaces and the options alone, except that with any_will_do the distance is that
// of any point which is further. Progress advances by the vertices and the triangles of `from`.
// Memory 8 bytes a vertex and a triangle of `from`, 16 a triangle of `to` and what is in work.
Furthest find_furthest(const Surface& from, const Surface& to, const FurthestOptions& options,
                       SharedProgress& progress);

}  // namespace crease
