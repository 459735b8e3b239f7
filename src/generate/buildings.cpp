#include "generate/buildings.h"

#include "generate/shapes.h"
#include "generate/walls.h"

#include <algorithm>
#include <cmath>

namespace crease {

namespace {

constexpr Coat kWalls[] = {Coat::Plaster, Coat::Ochre, Coat::Brick, Coat::Plaster, Coat::Sandstone};
constexpr Coat kRoofs[] = {Coat::RedTile, Coat::RedTile, Coat::Slate};

template <std::size_t N>
Coat pick(const Coat (&coats)[N], Random& random) {
  return coats[random.between(0, int(N) - 1)];
}

// Runs of roof rows are to come out even: whole multiples of 20 cm.
double even_metres(double length) {
  return std::floor(length * 5 + 0.5) / 5;
}

void add_chimney(ModelBuilder& b, const Vec3d& foot, double height) {
  b.coat(Coat::Brick);
  add_box(b, foot, foot + Vec3d{0.6, 0.8, height});
}

// A low wall around a flat roof, and what stands on it.
void add_flat_roof(ModelBuilder& b, RingBody& body, Random& random, Coat wall, const Vec3d& low,
                   double width, double depth) {
  body.ring({.inset = -0.2, .rise = 0, .coat = Coat::Stone});
  body.ring({.inset = 0, .rise = 0.8, .coat = wall});
  body.ring({.inset = 0.5, .rise = 0, .coat = Coat::Stone});
  body.ring({.inset = 0, .rise = -0.6, .coat = wall});
  body.close(Coat::Concrete);
  const double top = body.top();
  b.coat(Coat::Metal);
  const double x = on_grid(low.x + width * random.between(20, 60) / 100.0);
  const double y = on_grid(low.y + depth * random.between(30, 60) / 100.0);
  add_box(b, {x, y, top}, {x + 2.4, y + 1.8, top + 1.6}, 1);
  if (random.chance(60)) {
    add_cylinder(b, {on_grid(low.x + width * 0.75), on_grid(low.y + depth * 0.25), top}, 0.9, 1.8,
                 12);
  }
}

}  // namespace

void add_house(ModelBuilder& b, Random& random, double width, double depth) {
  width = even_metres(width);
  depth = even_metres(depth);
  const Coat wall = pick(kWalls, random), roof = pick(kRoofs, random);
  WallStyle style{.floors = random.between(1, 2), .coat = wall};
  style.bays_front = std::max(1, int(width / 4));
  style.bays_side = random.chance(35) ? std::max(1, int(depth / 5)) : 0;
  style.back_windows = random.chance(50);
  style.depth = 0.12;
  RingBody body(b, {0, 0, 0}, width, depth);
  body.walls(style);
  const double eaves = body.top(), rise = on_grid(depth * random.between(35, 55) / 100.0);
  if (random.chance(45)) {
    body.ring({.inset = -0.4, .rise = 0, .coat = Coat::Wood});
    body.hip(3, rise, roof);
  } else {
    body.close();
    add_gable_roof(b, {.low = {0, 0, eaves},
                       .width = width,
                       .depth = depth,
                       .rise = rise,
                       .rows = 3,
                       .roof = roof,
                       .gable = wall});
  }
  add_chimney(b, {on_grid(width * 0.3), on_grid(depth * 0.6), eaves}, rise + 0.6);
  if (random.chance(35)) {  // a porch
    const double middle = on_grid(width / 2);
    b.coat(Coat::Wood);
    add_box(b, {middle - 1.4, -1.6, 2.6}, {middle + 1.4, 0, 2.8});
    b.coat(Coat::Stone);
    add_column(b, {middle - 1.2, -1.4, 0}, 0.14, 2.6, 8);
    add_column(b, {middle + 1.2, -1.4, 0}, 0.14, 2.6, 8);
  } else if (random.chance(50)) {
    b.coat(Coat::Stone);
    add_box(b, {on_grid(width / 2) - 1, -0.8, 0}, {on_grid(width / 2) + 1, 0, 0.15});
  }
  if (random.chance(12)) {  // a round corner tower
    const double height = eaves + rise * 0.4;
    b.coat(wall);
    add_cylinder(b, {width, 0, 0}, 1.6, on_grid(height), 16, 3);
    b.coat(roof);
    add_cone(b, {width, 0, on_grid(height)}, 1.9, 3.2, 16, 2);
  }
}

void add_shed(ModelBuilder& b, Random& random, double width, double depth) {
  width = even_metres(width);
  depth = even_metres(depth);
  const double height = random.metres(2.2, 3.2);
  b.coat(random.chance(50) ? Coat::Wood : Coat::Brick);
  add_box(b, {0, 0, 0}, {width, depth, height}, 4);
  add_gable_roof(b, {.low = {0, 0, height},
                     .width = width,
                     .depth = depth,
                     .rise = on_grid(depth * 0.4),
                     .overhang = 0.2,
                     .rows = 1,
                     .roof = pick(kRoofs, random),
                     .gable = Coat::Wood});
}

void add_apartments(ModelBuilder& b, Random& random, double width, double depth) {
  width = even_metres(width);
  depth = even_metres(depth);
  const Coat wall = pick(kWalls, random);
  WallStyle style{.floors = random.between(3, 6), .coat = wall};
  style.floor_height = random.metres(3.0, 3.4);
  style.bays_front = std::max(2, int(width / 4.2));
  style.bays_side = random.chance(40) ? std::max(1, int(depth / 5)) : 0;
  style.back_windows = random.chance(45);
  style.window_height = random.metres(1.5, 1.8);
  style.shop = random.chance(30);
  style.depth = 0.2;
  RingBody body(b, {0, 0, 0}, width, depth);
  body.walls(style);
  body.ring({.inset = -0.3, .rise = 0, .coat = Coat::Stone});
  body.ring({.inset = 0, .rise = 0.3, .coat = Coat::Stone});
  switch (random.between(0, 3)) {
    case 0:  // mansard
      body.ring({.rows = 3, .inset = 1.2, .rise = 2.7, .coat = Coat::Slate});
      body.ring({.rows = 2, .inset = 2.0, .rise = 0.8, .coat = Coat::Slate});
      body.close(Coat::Slate);
      break;
    case 1:
      body.hip(5, on_grid(depth * 0.35), pick(kRoofs, random));
      break;
    case 2:
      body.ring({.inset = 0.3, .rise = 0, .coat = Coat::Stone});
      body.close(Coat::Concrete);
      add_barrel_roof(b, {0, 0, body.top()}, width, depth, 16, Coat::Metal, wall);
      break;
    default:
      add_flat_roof(b, body, random, wall, {0, 0, 0}, width, depth);
      break;
  }
  if (random.chance(30)) {  // balconies at every second window
    const double bay = width / style.bays_front;
    for (int floor = 1; floor < style.floors; ++floor) {
      for (int i = floor % 2; i < style.bays_front; i += 2) {
        const double x = on_grid((i + 0.5) * bay - 0.9);
        add_balcony(b, {x, 0, on_grid(floor * style.floor_height)}, 1.8, 1.1, 3);
      }
    }
  }
}

void add_office_tower(ModelBuilder& b, Random& random, double width, double depth) {
  width = even_metres(width);
  depth = even_metres(depth);
  const Coat wall = random.chance(60) ? Coat::Concrete : Coat::Sandstone;
  const int floors = random.between(7, 15);
  WallStyle style{.floors = floors, .floor_height = 3.6, .sill = 0.7, .coat = wall};
  style.bays_front = std::max(2, int(width / 5.5));
  style.bays_side = std::max(2, int(depth / 5.5));
  style.window_width = on_grid(std::min(width / style.bays_front, depth / style.bays_side) - 1.0);
  style.window_height = 2.3;
  style.depth = 0.3;
  RingBody body(b, {0, 0, 0}, width, depth);
  body.walls(style);
  add_flat_roof(b, body, random, wall, {0, 0, 0}, width, depth);
  const double setback = 2.6, top = body.top();
  style.floors = random.between(1, 4);
  style.door = false;
  style.bays_front = std::max(1, style.bays_front - 1);
  style.bays_side = std::max(1, style.bays_side - 1);
  style.window_width = 2.4;
  RingBody upper(b, {setback, setback, top}, width - 2 * setback, depth - 2 * setback);
  upper.walls(style);
  const double middle_x = on_grid(width / 2), middle_y = on_grid(depth / 2);
  if (random.chance(40)) {
    upper.hip(4, on_grid(width * 0.6), Coat::Copper);
  } else {
    upper.close(Coat::Concrete);
    b.coat(Coat::Metal);
    add_cone(b, {middle_x, middle_y, upper.top()}, 0.35, random.metres(8, 16), 8, 3);
    add_cylinder(b, {middle_x, middle_y, upper.top()}, 1.5, 2.5, 16);
  }
}

void add_round_tower(ModelBuilder& b, Random& random, double width, double depth) {
  const double radius = on_grid(std::min(width, depth) / 2 - 0.8);
  const Vec3d centre{on_grid(width / 2), on_grid(depth / 2), 0};
  const int floors = random.between(4, 8), segments = 24;
  const double ledge = 0.3, band = 3.2;
  std::vector<LatheStrip> strips{straight_strip(0, 0, radius, 0)};
  for (int floor = 0; floor < floors; ++floor) {
    const double z = floor * band;
    strips.push_back(straight_strip(radius, z, radius, z + band - 0.4, 2));
    strips.push_back(straight_strip(radius, z + band - 0.4, radius + ledge, z + band - 0.4));
    strips.push_back(straight_strip(radius + ledge, z + band - 0.4, radius + ledge, z + band));
    strips.push_back(straight_strip(radius + ledge, z + band, radius, z + band));
  }
  const double top = floors * band;
  strips.push_back(straight_strip(radius, top, 0, top));
  b.coat(random.chance(50) ? Coat::Sandstone : Coat::Plaster);
  add_lathe(b, centre, segments, strips);
  b.coat(random.chance(50) ? Coat::Copper : Coat::Slate);
  if (random.chance(60)) {
    add_dome(b, centre + Vec3d{0, 0, top}, radius * 0.95, radius * 0.8, segments);
    add_cylinder(b, centre + Vec3d{0, 0, on_grid(top + radius * 0.75)}, radius * 0.18, 2.2, 12);
    add_cone(b, centre + Vec3d{0, 0, on_grid(top + radius * 0.75 + 2.2)}, radius * 0.24, 2.4, 12);
  } else {
    add_cone(b, centre + Vec3d{0, 0, top}, radius * 1.1, radius * 1.6, segments, 4);
  }
  b.coat(Coat::Stone);
  add_stairs(b, {centre.x - 2, -0.8, 0}, 4, 4, 0.3, 0.15);
}

void add_hall(ModelBuilder& b, Random& random, double width, double depth) {
  const Coat wall = random.chance(60) ? Coat::Brick : Coat::Concrete;
  const int bays = std::max(1, int(width / 11));
  const double bay = on_grid(width / bays), height = random.metres(5, 7);
  for (int i = 0; i < bays; ++i) {
    const Site outer = b.site();
    // Each bay is a vault that runs from front to back: turned by 90 degrees.
    b.place(outer.at({on_grid((i + 1) * bay), 0.6, 0}, 1));
    b.coat(wall);
    add_box(b, {0, 0, 0}, {depth - 0.6, bay, height}, 3);
    add_barrel_roof(b, {0, 0, height}, depth - 0.6, bay, 14, Coat::Metal, wall);
    b.place(outer);
    add_arch(b, {.low = {on_grid(i * bay), 0, 0},
                 .width = bay,
                 .thickness = 0.6,
                 .height = height,
                 .opening = on_grid(bay * 0.5),
                 .spring = on_grid(height - bay * 0.25 - 0.8),
                 .segments = 12,
                 .coat = wall});
  }
  if (random.chance(40)) {
    const Site outer = b.site();
    b.place(outer.at({on_grid(width - 3), on_grid(depth - 3), 0}));
    add_factory_chimney(b, random, 3, 3);
    b.place(outer);
  }
}

void add_water_tower(ModelBuilder& b, Random& random, double width, double depth) {
  const Vec3d centre{on_grid(width / 2), on_grid(depth / 2), 0};
  const double height = random.metres(9, 14), radius = random.metres(2.4, 3.2);
  const double reach = on_grid(radius * 0.7);
  b.coat(Coat::Metal);
  for (double x : {-reach, reach}) {
    for (double y : {-reach, reach}) {
      add_box(b, centre + Vec3d{x - 0.15, y - 0.15, 0}, centre + Vec3d{x + 0.15, y + 0.15, height},
              3);
    }
  }
  for (double z : {on_grid(height / 3), on_grid(height * 2 / 3)}) {
    for (double side : {-reach, reach}) {
      add_box(b, centre + Vec3d{-reach, side - 0.08, z},
              centre + Vec3d{reach, side + 0.08, z + 0.2});
      add_box(b, centre + Vec3d{side - 0.08, -reach, z},
              centre + Vec3d{side + 0.08, reach, z + 0.2});
    }
  }
  b.coat(Coat::Wood);
  const double tank = on_grid(radius * 1.5);
  add_cylinder(b, centre + Vec3d{0, 0, height}, radius, tank, 24, 4);
  b.coat(Coat::Slate);
  add_cone(b, centre + Vec3d{0, 0, on_grid(height + tank)}, radius * 1.12, radius * 0.7, 24, 3);
}

void add_factory_chimney(ModelBuilder& b, Random& random, double width, double depth) {
  const Vec3d centre{on_grid(width / 2), on_grid(depth / 2), 0};
  const double height = random.metres(18, 30), foot = 1.3, top = 0.8;
  b.coat(Coat::Brick);
  add_lathe(b, centre, 20,
            {straight_strip(0, 0, foot, 0), straight_strip(foot, 0, top, height, 8),
             straight_strip(top, height, top + 0.2, height),
             straight_strip(top + 0.2, height, top + 0.2, height + 0.8),
             straight_strip(top + 0.2, height + 0.8, top - 0.2, height + 0.8),
             straight_strip(top - 0.2, height + 0.8, top - 0.2, height - 1),
             straight_strip(top - 0.2, height - 1, 0, height - 1)});
}

}  // namespace crease
