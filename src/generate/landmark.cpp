// The middle of the city: a cathedral inside a ring of walls.
#include "generate/buildings.h"
#include "generate/shapes.h"
#include "generate/walls.h"

namespace crease {

namespace {

constexpr double kNaveHeight = 18, kAisleHeight = 9;

// Does `add` at a site within the builder's.
template <typename Add>
void at_site(ModelBuilder& b, const Vec3d& offset, int quarter_turns, const Add& add) {
  const Site outer = b.site();
  b.place(outer.at(offset, quarter_turns));
  add();
  b.place(outer);
}

// `lower`: two naves that cross have no plane in common.
void add_nave(ModelBuilder& b, double width, double depth, int bays, double lower) {
  RingBody body(b, {0, 0, 0}, width, depth);
  body.walls({.floors = 2,
              .floor_height = on_grid(kNaveHeight / 2 - lower / 2),
              .bays = {bays, 2, bays, 2},
              .window_width = 1.6,
              .window_height = 5.5,
              .sill = 1.8,
              .depth = 0.5,
              .door = false,
              .foundation = 0.3 + lower / 4,
              .coat = Coat::Sandstone});
  body.gable({.rise = on_grid(depth * 0.65),
              .overhang = 0.6,
              .roof = Coat::Slate,
              .wall = Coat::Sandstone});
}

void add_aisle(ModelBuilder& b, double length, double depth, int bays) {
  RingBody body(b, {0, 0, 0}, length, depth);
  body.walls({.floors = 1,
              .floor_height = kAisleHeight,
              .bays = {bays, 0, 0, 0},
              .window_width = 1.4,
              .window_height = 4.5,
              .sill = 2.2,
              .depth = 0.5,
              .door = false,
              .foundation = 0.2,
              .coat = Coat::Sandstone});
  body.ring({.inset = -0.3, .rise = 0, .coat = Coat::Stone});
  body.ring({.inset = 0, .rise = 0.4, .coat = Coat::Stone});
  body.hip(1.8, Coat::Slate);
  // A pier between any two windows, and from it an arch that carries the nave's wall.
  const double bay = length / bays;
  for (int i = 0; i <= bays; ++i) {
    const double x = on_grid(i * bay);
    b.coat(Coat::Sandstone);
    add_box(b, {x - 0.5, -1.8, -0.25}, {x + 0.5, 0.3, kAisleHeight + 4});
    b.coat(Coat::Stone);
    add_spire(b, {x, -0.75, kAisleHeight + 3.9}, 0.7, 3.1, 4);
    at_site(b, {x + 0.4, -1.6, kAisleHeight - 0.2}, 1, [&] {
      add_arch(b, {.low = {0, 0, 0},
                   .width = depth + 1.8,
                   .thickness = 0.8,
                   .height = 5.2,
                   .opening = depth - 0.4,
                   .spring = 1.4,
                   .segments = 12});
    });
  }
}

void add_west_tower(ModelBuilder& b, double side) {
  RingBody body(b, {0, 0, 0}, side, side);
  body.walls({.floors = 6,
              .floor_height = 6,
              .bays = {2, 2, 2, 2},
              .window_width = 1.4,
              .window_height = 3.8,
              .sill = 1.2,
              .depth = 0.5,
              .door = false,
              .foundation = 0.35,
              .coat = Coat::Sandstone});
  body.ring({.inset = -0.4, .rise = 0, .coat = Coat::Stone});
  body.ring({.inset = 0, .rise = 0.8, .coat = Coat::Stone});
  body.ring({.inset = 0.6, .rise = 0, .coat = Coat::Stone});
  body.close();
  const double top = body.top(), middle = side / 2;
  b.coat(Coat::Sandstone);
  add_cylinder(b, {middle, middle, top - 0.2}, side * 0.42, 5.4, 32);
  b.coat(Coat::Copper);
  add_spire(b, {middle, middle, top + 5}, side * 0.46, 20, 8);
  b.coat(Coat::Stone);
  for (double x : {0.8, side - 0.8}) {
    for (double y : {0.8, side - 0.8}) add_spire(b, {x, y, top - 0.1}, 0.7, 5, 8);
  }
}

void add_crossing_dome(ModelBuilder& b) {
  const double radius = 8, drum = radius - 1.2, rim = radius + 0.3;
  const Vec3d foot{0, 0, kNaveHeight + 4};
  const LatheStrip dome = dome_strip(radius - 0.2, 10, 8.5, 12, 1.3);
  const double crown = dome.back().z;
  const Coat stone = Coat::Sandstone, copper = Coat::Copper;
  add_lathe(
      b, foot, 48,
      {straight_strip(0, -1, radius, -1), straight_strip(radius, -1, radius, 2),
       straight_strip(radius, 2, drum, 2), straight_strip(drum, 2, drum, 9),
       straight_strip(drum, 9, rim, 9), straight_strip(rim, 9, rim, 10),
       straight_strip(rim, 10, radius - 0.2, 10), dome, straight_strip(1.3, crown, 1.3, crown + 3),
       straight_strip(1.3, crown + 3, 1.7, crown + 3),
       straight_strip(1.7, crown + 3, 0, crown + 7.5)},
      {stone, stone, stone, stone, stone, stone, stone, copper, stone, stone, copper});
  b.coat(Coat::Plaster);
  constexpr int kColumns = 20;
  for (int i = 0; i < kColumns; ++i) {
    const Vec3d p = on_circle(i, kColumns) * (radius - 0.6);
    add_column(b, foot + Vec3d{on_grid(p.x), on_grid(p.y), 1.9}, 0.35, 7.2, 12);
  }
}

void add_cathedral(ModelBuilder& b) {
  at_site(b, {-30, -7, 0}, 0, [&] { add_nave(b, 58, 14, 12, 0); });
  at_site(b, {15, -21, 0}, 1, [&] { add_nave(b, 42, 14, 8, 0.4); });
  at_site(b, {-28, -13, 0}, 0, [&] { add_aisle(b, 28, 6.2, 7); });
  at_site(b, {0, 13, 0}, 2, [&] { add_aisle(b, 28, 6.2, 7); });
  at_site(b, {8, 0, 0}, 0, [&] { add_crossing_dome(b); });
  for (double y : {-13.0, 4.0}) {
    at_site(b, {-38, y, 0}, 0, [&] { add_west_tower(b, 9); });
  }
  // The choir's round end.
  add_lathe(b, {28, 0, 0}, 40,
            {straight_strip(0, -0.5, 6.5, -0.5), straight_strip(6.5, -0.5, 6.5, 15),
             straight_strip(6.5, 15, 7, 15), straight_strip(7, 15, 0, 21)},
            {Coat::Stone, Coat::Sandstone, Coat::Stone, Coat::Slate});
  // Three doors to the west, and the steps.
  at_site(b, {-38, 13, 0}, 3, [&] {
    constexpr double kFrom[] = {0.2, 8.65, 17.2};
    for (int i = 0; i < 3; ++i) {
      add_arch(b, {.low = {kFrom[i], i == 1 ? -1.6 : -1.4, i == 1 ? -0.3 : -0.25},
                   .width = i == 1 ? 8.7 : 8.6,
                   .thickness = i == 1 ? 1.8 : 1.7,
                   .height = i == 1 ? 11.3 : 9.25,
                   .opening = i == 1 ? 5.0 : 4.0,
                   .spring = i == 1 ? 6.3 : 5.25,
                   .segments = 16,
                   .coat = Coat::Sandstone});
    }
    add_stairs(b, {3, -4.3, -0.12}, 20, 6, 0.5, 0.1);
  });
}

void add_wall_tower(ModelBuilder& b, const Vec3d& foot, double radius, double height) {
  b.coat(Coat::Stone);
  add_lathe(b, foot, 28,
            {straight_strip(0, -0.35, radius + 0.6, -0.35),
             straight_strip(radius + 0.6, -0.35, radius, 3),
             straight_strip(radius, 3, radius, height - 2),
             straight_strip(radius, height - 2, radius + 0.6, height - 1),
             straight_strip(radius + 0.6, height - 1, radius + 0.6, height),
             straight_strip(radius + 0.6, height, 0, height)});
  const Vec3d top = foot + Vec3d{0, 0, height - 0.1};
  add_crenels(b, top, radius + 0.5, radius, 1.3, 14);
  b.coat(Coat::RedTile);
  add_cone(b, top, radius - 0.4, radius * 1.6, 28);
}

// Along x, from the site's origin.
void add_city_wall(ModelBuilder& b, double length) {
  constexpr double kHeight = 7, kThickness = 2;
  b.coat(Coat::Stone);
  add_box(b, {0, 0, -0.2}, {length, kThickness, kHeight});
  for (double x = 0.5; x + 1.5 < length; x += 2.5) {
    add_box(b, {x, 0.1, kHeight - 0.1}, {x + 1.5, 0.6, kHeight + 1.2});
  }
}

}  // namespace

void add_landmark(ModelBuilder& b, Random& random) {
  constexpr double kX = 66, kY = 50, kGate = 7;
  at_site(b, {4, 0, 0}, 0, [&] { add_cathedral(b); });
  const Vec3d corners[] = {{-kX, -kY, 0}, {kX, -kY, 0}, {kX, kY, 0}, {-kX, kY, 0}};
  for (int side = 0; side < 4; ++side) {
    const double length = side % 2 == 0 ? 2 * kX : 2 * kY;
    at_site(b, corners[side], side, [&] {
      const double part = length / 2 - kGate;
      // Walls end inside the towers at the corners.
      constexpr double kInTower = 2.5;
      at_site(b, {kInTower, 0, 0}, 0, [&] { add_city_wall(b, part - kInTower); });
      at_site(b, {length - part, 0, 0}, 0, [&] { add_city_wall(b, part - kInTower); });
      add_arch(b, {.low = {part - 0.2, -0.5, -0.3},
                   .width = 2 * kGate + 0.4,
                   .thickness = 3,
                   .height = 10.3,
                   .opening = 6,
                   .spring = 4.3,
                   .segments = 20,
                   .coat = Coat::Stone});
      for (double x : {part, length - part}) add_wall_tower(b, {x, 1, 0}, 2.8, 12);
      add_wall_tower(b, {0, 0, 0}, 5, 15);
    });
  }
  for (int i = 0; i < 40; ++i) {
    // Each in a strip of its own, so that no two grow in one place.
    const double x = -58 + 5.8 * (i / 2) + random.metres(0, 1.6), y = random.metres(26, 44);
    const double height = random.metres(5, 9);
    add_tree(b, {on_grid(x), i % 2 == 0 ? y : -y, 0}, height, random.chance(30));
  }
}

}  // namespace crease
