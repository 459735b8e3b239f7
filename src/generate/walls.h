// Rectangular buildings: four walls with recessed windows and what is above them, as one closed
// body without a vertex that the shape does not need.
//
//   RingBody body(b, {0, 0, 0}, 12, 9);
//   body.walls({.floors = 3, .bays = {4, 0, 2, 0}});
//   body.ring({.inset = -0.4, .rise = 0});   // eaves, seen from below
//   body.hip(4, Coat::Slate);                // or other rings, then close(), or gable(), or
//   vault()
#pragma once

#include "generate/model_builder.h"

#include <array>
#include <vector>

namespace crease {

struct WallStyle {
  int floors = 2;
  double floor_height = 3;
  // Windows a floor: front, right, back, left.
  std::array<int, 4> bays{3, 0, 0, 0};
  double window_width = 1.1, window_height = 1.5, sill = 0.9;  // sill + height < floor height
  double depth = 0.15;      // of the windows; 0: they lie in the wall
  bool deep_all = true;     // false: only those of the front are deep
  bool door = true;         // in the middle of the front
  bool shop = false;        // the front's ground floor is all window
  int front = 0;            // the side that is the front to these two: 0 to 3, counter-clockwise
  double foundation = 0.4;  // how far the walls go on below, so that no floor lies on the ground
  Coat coat = Coat::Plaster;
};

struct RingStage {
  double inset = 0;  // inwards; negative: outwards
  double rise = 0;   // negative: downwards
  Coat coat = Coat::Slate;
};

struct Gable {
  double rise = 3;
  double overhang = 0.4;  // of the eaves
  Coat roof = Coat::RedTile, wall = Coat::Plaster;
};

// A stack of rectangles around one middle. Each has its four corners only.
class RingBody {
 public:
  // The rectangle's lower left corner and its size.
  RingBody(ModelBuilder& builder, const Vec3d& low, double width, double depth);

  void walls(const WallStyle& style);  // first of all; the floor below is closed too
  void floor(Coat coat);               // what closes the body below, where there are no walls()
  void ring(const RingStage& stage);
  // The roofs that leave nothing to close. Ridges of gables and vaults run along x.
  void hip(double rise, Coat coat);
  void gable(const Gable& gable);
  void vault(double rise, int segments, Coat roof, Coat ends);
  void close(Coat coat = Coat::Stone);  // the flat top, if any is left

  double top() const { return z_; }

 private:
  struct Opening {  // metres along the wall and above `low`
    double left, right, bottom, top;
    Coat coat;
  };
  Vec3d corner(int side, double inset, double z) const;
  void wall(int side, int bays, const WallStyle& style);
  Opening opening(int side, int bay, int bays, int floor, const WallStyle& style) const;
  double length_of(int side) const { return side % 2 == 0 ? width_ : depth_; }

  ModelBuilder& b_;
  Vec3d low_;
  double width_, depth_;
  double inset_ = 0, z_;
};

}  // namespace crease
