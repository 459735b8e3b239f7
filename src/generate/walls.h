// Rectangular houses: four walls with recessed windows and what is above them, as one closed body.
//
//   RingBody body(b, {0, 0, 0}, 12, 9);
//   body.walls({.floors = 3, .bays_front = 4});
//   body.ring({.rows = 1, .inset = -0.4, .rise = 0});   // eaves, seen from below
//   body.hip(5, 4, Coat::Slate);                        // or other rings, then close()
#pragma once

#include "generate/model_builder.h"

#include <array>
#include <vector>

namespace crease {

struct WallStyle {
  int floors = 2;
  double floor_height = 3;
  int bays_front = 3, bays_side = 2;  // windows a floor; 0: none on those walls
  double window_width = 1.1, window_height = 1.5, sill = 0.9;  // sill + height < floor height
  double depth = 0.15;                                         // of the windows
  bool door = true;                                            // in the middle of the front
  bool back_windows = true;
  bool shop = false;  // the front's ground floor is all window
  Coat coat = Coat::Plaster;
};

struct RingStage {
  int rows = 1;
  double inset = 0;  // in all, inwards; negative: outwards
  double rise = 0;   // in all; negative: downwards
  Coat coat = Coat::Slate;
};

// A stack of rectangular rings around one middle. All rings have the same points a side, so that
// the body is closed without further care.
class RingBody {
 public:
  // The rectangle's lower left corner and its size.
  RingBody(ModelBuilder& builder, const Vec3d& low, double width, double depth);

  void subdivide(double cell);         // without walls(): how long the columns are
  void walls(const WallStyle& style);  // first of all; the floor below is closed too
  void floor(Coat coat);               // what closes the body below, where there are no walls()
  // Rows are rounded to the grid, so that slopes stay flat.
  void ring(const RingStage& stage);
  // The four slopes that end in a ridge, about `rows` rows; there is nothing left to close.
  void hip(int rows, double rise, Coat coat);
  void close(Coat coat = Coat::Stone);  // the flat top, if any is left

  double top() const { return z_; }

 private:
  Vec3d corner(int side, double inset) const;
  int column_count(int side) const { return int(columns_[std::size_t(side % 2)].size()) - 1; }
  Vec3d point(int side, int column, double inset, double z) const;
  std::vector<Vec3d> loop(double inset, double z) const;
  void wall(int side, const WallStyle& style);

  ModelBuilder& b_;
  Vec3d low_;
  double width_, depth_;
  double inset_ = 0, z_;
  // Where the columns of the front and of the right side are, 0..1. The sides opposite have the
  // same, mirrored.
  std::array<std::vector<double>, 2> columns_;
};

}  // namespace crease
