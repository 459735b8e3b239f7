// The other closed bodies that buildings are made of.
#pragma once

#include "generate/model_builder.h"

#include <vector>

namespace crease {

void add_box(ModelBuilder& b, const Vec3d& low, const Vec3d& high);

// One piece of a lathe's profile: smooth within, hard against its neighbours.
struct LathePoint {
  double radius, z;
  double out, up;  // the normal's direction
};
using LatheStrip = std::vector<LathePoint>;

// Straight pieces, cut into rows.
LatheStrip straight_strip(double radius0, double z0, double radius1, double z1, int rows = 1);
// A quarter of an ellipse, from the rim at z0 to the pole at z0 + height, or to where the radius is
// that of a lantern.
LatheStrip dome_strip(double radius, double z0, double height, int rows, double lantern = 0);

// Turns the strips, from the bottom up, around the z axis through `centre`. The profile starts and
// ends on the axis. Without coats the builder's own is taken; else there is one for each strip.
void add_lathe(ModelBuilder& b, const Vec3d& centre, int segments,
               const std::vector<LatheStrip>& strips, const std::vector<Coat>& coats = {});
void add_cylinder(ModelBuilder& b, const Vec3d& centre, double radius, double height, int segments,
                  int rows = 1);
void add_dome(ModelBuilder& b, const Vec3d& centre, double radius, double height, int segments);
void add_cone(ModelBuilder& b, const Vec3d& centre, double radius, double height, int segments,
              int rows = 1);
// A pyramid over a regular polygon, flat sides.
void add_spire(ModelBuilder& b, const Vec3d& centre, double radius, double height, int sides);
void add_column(ModelBuilder& b, const Vec3d& foot, double radius, double height, int segments);

// A wall of bays x width by thickness by height, on x, with an arched opening in each bay's middle.
struct Arch {
  Vec3d low;
  double width, thickness, height;
  double opening, spring;  // width of the opening, height where the arch begins
  int bays = 1;
  int segments = 12;
  Coat coat = Coat::Sandstone;
};
void add_arch(ModelBuilder& b, const Arch& arch);

// Steps that rise along y.
void add_stairs(ModelBuilder& b, const Vec3d& low, double width, int steps, double tread,
                double rise);
// A slab with a parapet on a wall that faces -y; `low` is on the wall.
void add_balcony(ModelBuilder& b, const Vec3d& low, double width, double depth, Coat coat);
// A round tower's battlements.
void add_crenels(ModelBuilder& b, const Vec3d& centre, double outer, double inner, double height,
                 int merlons);
void add_tree(ModelBuilder& b, const Vec3d& foot, double height, bool conifer);

}  // namespace crease
