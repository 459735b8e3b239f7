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

void add_nave(ModelBuilder& b, double width, double depth, int bays) {
  WallStyle style{.floors = 2,
                  .floor_height = kNaveHeight / 2,
                  .bays_front = bays,
                  .bays_side = 2,
                  .window_width = 1.6,
                  .window_height = 5.5,
                  .sill = 1.8,
                  .depth = 0.5,
                  .door = false,
                  .coat = Coat::Sandstone};
  RingBody body(b, {0, 0, 0}, width, depth);
  body.walls(style);
  body.close();
  add_gable_roof(b, {.low = {0, 0, kNaveHeight},
                     .width = width,
                     .depth = depth,
                     .rise = on_grid(depth * 0.65),
                     .overhang = 0.6,
                     .rows = 8,
                     .roof = Coat::Slate,
                     .gable = Coat::Sandstone});
}

void add_aisle(ModelBuilder& b, double length, double depth, int bays) {
  WallStyle style{.floors = 1,
                  .floor_height = kAisleHeight,
                  .bays_front = bays,
                  .bays_side = 0,
                  .window_width = 1.4,
                  .window_height = 4.5,
                  .sill = 2.2,
                  .depth = 0.5,
                  .door = false,
                  .back_windows = false,
                  .coat = Coat::Sandstone};
  RingBody body(b, {0, 0, 0}, length, depth);
  body.walls(style);
  body.ring({.inset = -0.3, .rise = 0, .coat = Coat::Stone});
  body.ring({.inset = 0, .rise = 0.4, .coat = Coat::Stone});
  body.hip(3, 1.8, Coat::Slate);
  // A pier between any two windows, and from it an arch that carries the nave's wall.
  const double bay = length / bays;
  for (int i = 0; i <= bays; ++i) {
    const double x = on_grid(i * bay);
    b.coat(Coat::Sandstone);
    add_box(b, {x - 0.5, -1.8, 0}, {x + 0.5, 0, kAisleHeight + 4}, 4);
    b.coat(Coat::Stone);
    add_spire(b, {x, -0.9, kAisleHeight + 4}, 0.7, 3, 4);
    at_site(b, {x + 0.4, -1.8, kAisleHeight}, 1, [&] {
      add_arch(b, {.low = {0, 0, 0},
                   .width = depth + 1.8,
                   .thickness = 0.8,
                   .height = 5,
                   .opening = depth - 0.4,
                   .spring = 1.2,
                   .segments = 16});
    });
  }
}

void add_west_tower(ModelBuilder& b, double side) {
  WallStyle style{.floors = 6,
                  .floor_height = 6,
                  .bays_front = 2,
                  .bays_side = 2,
                  .window_width = 1.4,
                  .window_height = 3.8,
                  .sill = 1.2,
                  .depth = 0.5,
                  .door = false,
                  .coat = Coat::Sandstone};
  RingBody body(b, {0, 0, 0}, side, side);
  body.walls(style);
  body.ring({.inset = -0.4, .rise = 0, .coat = Coat::Stone});
  body.ring({.inset = 0, .rise = 0.8, .coat = Coat::Stone});
  body.ring({.inset = 0.6, .rise = 0, .coat = Coat::Stone});
  body.close();
  const double top = body.top(), middle = side / 2;
  b.coat(Coat::Sandstone);
  add_cylinder(b, {middle, middle, top}, side * 0.42, 5, 32, 2);
  b.coat(Coat::Copper);
  add_spire(b, {middle, middle, top + 5}, side * 0.44, 20, 8);
  b.coat(Coat::Stone);
  for (double x : {0.5, side - 0.5}) {
    for (double y : {0.5, side - 0.5}) add_spire(b, {x, y, top}, 0.7, 5, 8);
  }
}

void add_crossing_dome(ModelBuilder& b) {
  const double radius = 8;
  const Vec3d foot{0, 0, kNaveHeight + 4};
  b.coat(Coat::Sandstone);
  add_lathe(
      b, foot, 48,
      {straight_strip(0, 0, radius, 0), straight_strip(radius, 0, radius, 2),
       straight_strip(radius, 2, radius - 1.2, 2),
       straight_strip(radius - 1.2, 2, radius - 1.2, 9, 3),
       straight_strip(radius - 1.2, 9, radius + 0.3, 9),
       straight_strip(radius + 0.3, 9, radius + 0.3, 10), straight_strip(radius + 0.3, 10, 0, 10)});
  b.coat(Coat::Plaster);
  constexpr int kColumns = 20;
  for (int i = 0; i < kColumns; ++i) {
    const Vec3d p = on_circle(i, kColumns) * (radius - 0.6);
    add_column(b, foot + Vec3d{on_grid(p.x), on_grid(p.y), 2}, 0.35, 7, 12);
  }
  b.coat(Coat::Copper);
  add_dome(b, foot + Vec3d{0, 0, 10}, radius - 0.2, 8.5, 48);
  b.coat(Coat::Stone);
  add_cylinder(b, foot + Vec3d{0, 0, 18}, 1.3, 3, 16, 2);
  b.coat(Coat::Copper);
  add_dome(b, foot + Vec3d{0, 0, 21}, 1.5, 1.3, 16);
  add_cone(b, foot + Vec3d{0, 0, 22.2}, 0.2, 3, 8, 2);
}

void add_cathedral(ModelBuilder& b) {
  at_site(b, {-30, -7, 0}, 0, [&] { add_nave(b, 58, 14, 12); });
  at_site(b, {15, -21, 0}, 1, [&] { add_nave(b, 42, 14, 8); });
  at_site(b, {-28, -13, 0}, 0, [&] { add_aisle(b, 28, 6, 7); });
  at_site(b, {0, 13, 0}, 2, [&] { add_aisle(b, 28, 6, 7); });
  at_site(b, {8, 0, 0}, 0, [&] { add_crossing_dome(b); });
  for (double y : {-13.0, 4.0}) {
    at_site(b, {-38, y, 0}, 0, [&] { add_west_tower(b, 9); });
  }
  // The choir's round end.
  b.coat(Coat::Sandstone);
  add_cylinder(b, {28, 0, 0}, 6.5, 15, 40, 4);
  b.coat(Coat::Slate);
  add_cone(b, {28, 0, 15}, 7, 6, 40, 4);
  // Three doors to the west, and the steps.
  at_site(b, {-38, 13, 0}, 3, [&] {
    for (int i = 0; i < 3; ++i) {
      const double width = i == 1 ? 8 : 9;
      add_arch(b, {.low = {i == 0   ? 0.0
                           : i == 1 ? 9.0
                                    : 17.0,
                           -1.4, 0},
                   .width = width,
                   .thickness = 1.4,
                   .height = i == 1 ? 11.0 : 9.0,
                   .opening = i == 1 ? 5.0 : 4.0,
                   .spring = i == 1 ? 6.0 : 5.0,
                   .segments = 20});
    }
    add_stairs(b, {3, -4.4, -0.15}, 20, 6, 0.5, 0.1);
  });
}

void add_wall_tower(ModelBuilder& b, const Vec3d& foot, double radius, double height) {
  b.coat(Coat::Stone);
  add_lathe(b, foot, 32,
            {straight_strip(0, 0, radius + 0.6, 0), straight_strip(radius + 0.6, 0, radius, 3, 2),
             straight_strip(radius, 3, radius, height - 2, 4),
             straight_strip(radius, height - 2, radius + 0.6, height - 1),
             straight_strip(radius + 0.6, height - 1, radius + 0.6, height),
             straight_strip(radius + 0.6, height, 0, height)});
  const Vec3d top = foot + Vec3d{0, 0, height};
  add_crenels(b, top, radius + 0.6, radius, 1.2, 14);
  b.coat(Coat::RedTile);
  add_cone(b, top, radius - 0.4, radius * 1.6, 32, 4);
}

// Along x, from the site's origin.
void add_city_wall(ModelBuilder& b, double length) {
  constexpr double kHeight = 7, kThickness = 2;
  b.coat(Coat::Stone);
  add_box(b, {0, 0, 0}, {length, kThickness, kHeight}, 3);
  for (double x = 0.5; x + 1.5 < length; x += 2.5) {
    add_box(b, {x, 0, kHeight}, {x + 1.5, 0.5, kHeight + 1.2});
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
      add_city_wall(b, part);
      at_site(b, {length - part, 0, 0}, 0, [&] { add_city_wall(b, part); });
      add_arch(b, {.low = {part, -0.5, 0},
                   .width = 2 * kGate,
                   .thickness = 3,
                   .height = 10,
                   .opening = 6,
                   .spring = 4,
                   .segments = 24,
                   .coat = Coat::Stone});
      for (double x : {part, length - part}) add_wall_tower(b, {x, 1, 0}, 2.8, 12);
      add_wall_tower(b, {0, 0, 0}, 5, 15);
    });
  }
  for (int i = 0; i < 40; ++i) {
    const double x = random.metres(-58, 56), y = random.metres(26, 44);
    const double height = random.metres(5, 9);
    add_tree(b, {x, i % 2 == 0 ? y : -y, 0}, height, random.chance(30));
  }
}

}  // namespace crease
