#include "generate/buildings.h"

#include "generate/shapes.h"
#include "generate/walls.h"

#include <algorithm>
#include <cmath>

namespace crease {

namespace {

constexpr Coat kWalls[] = {Coat::Plaster, Coat::Ochre, Coat::Brick,     Coat::Cream,
                           Coat::Rose,    Coat::Cream, Coat::Sandstone, Coat::Plaster};
constexpr Coat kRoofs[] = {Coat::RedTile, Coat::BrownTile, Coat::RedTile, Coat::Slate};

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
  const double foot = body.top() - 0.1;
  b.coat(Coat::Metal);
  const double x = on_grid(low.x + width * random.between(20, 60) / 100.0);
  const double y = on_grid(low.y + depth * random.between(30, 60) / 100.0);
  add_box(b, {x, y, foot}, {x + 2.4, y + 1.8, foot + 1.7});
  if (random.chance(60)) {
    add_cylinder(b, {on_grid(low.x + width * 0.75), on_grid(low.y + depth * 0.25), foot - 0.05},
                 0.9, 1.9, 12);
  }
}

// A window under a gable of its own, in the front slope of a roof.
void add_dormer(ModelBuilder& b, const Vec3d& foot, double depth, Coat wall, Coat roof) {
  const Site outer = b.site();
  // Its ridge runs from front to back.
  b.place(outer.at(foot, 1));
  RingBody body(b, {0, -0.9, 0}, depth, 1.8);
  body.walls({.floors = 1,
              .floor_height = 1.5,
              .bays = {},
              .window_width = 1,
              .window_height = 1,
              .sill = 0.3,
              .depth = 0,
              .door = false,
              .foundation = 0.4,
              .coat = wall});
  body.gable({.rise = 0.8, .overhang = 0.15, .roof = roof, .wall = wall});
  b.place(outer);
  b.coat(Coat::Glass);
  add_box(b, foot + Vec3d{-0.5, -0.04, 0.3}, foot + Vec3d{0.5, 0.3, 1.3});
}

// What stands at a house's door.
void add_porch(ModelBuilder& b, Random& random, double middle) {
  if (random.chance(30)) {
    b.coat(Coat::Wood);
    add_box(b, {middle - 1.4, -1.6, 2.6}, {middle + 1.4, 0.1, 2.8});
    b.coat(Coat::Plaster);
    for (double x : {middle - 1.2, middle + 1.2}) {
      add_cylinder(b, {x, -1.4, -0.3}, 0.13, 3.0, 8);
    }
  } else if (random.chance(60)) {
    b.coat(Coat::Stone);
    add_box(b, {middle - 1, -0.8, -0.3}, {middle + 1, 0.1, 0.12});
  }
}

// At the corner of a house, to a point.
void add_turret(ModelBuilder& b, const Vec3d& foot, double height, Coat wall, Coat roof) {
  const double radius = 1.6;
  add_lathe(b, foot, 14,
            {straight_strip(0, -0.6, radius, -0.6), straight_strip(radius, -0.6, radius, height),
             straight_strip(radius, height, radius + 0.3, height),
             straight_strip(radius + 0.3, height, 0, height + 3.6)},
            {Coat::Stone, wall, Coat::Wood, roof});
}

void add_balconies(ModelBuilder& b, const WallStyle& style, double width, int lowest, Coat coat) {
  const int bays = style.bays[0];
  const double bay = width / bays;
  for (int floor = lowest; floor < style.floors; ++floor) {
    for (int i = floor % 2; i < bays; i += 2) {
      const double x = on_grid((i + 0.5) * bay - 0.9);
      add_balcony(b, {x, 0, on_grid(floor * style.floor_height + 0.1)}, 1.8, 1.1, coat);
    }
  }
}

void add_flats(ModelBuilder& b, Random& random, double width, double depth, int lowest_balcony) {
  width = even_metres(width);
  depth = even_metres(depth);
  const Coat wall = pick(kWalls, random), roof = pick(kRoofs, random);
  WallStyle style{.floors = random.between(3, 5), .coat = wall};
  style.floor_height = random.metres(3.0, 3.4);
  const int bays = std::max(2, int(width / 3.6));
  style.bays = {bays, 0, bays / 2, 0};
  style.bays[1] = style.bays[3] = random.chance(20) ? 1 : 0;
  style.deep_all = false;
  style.window_height = random.metres(1.5, 1.8);
  style.shop = random.chance(35);
  style.depth = random.chance(70) ? 0.2 : 0;
  RingBody body(b, {0, 0, 0}, width, depth);
  body.walls(style);
  body.ring({.inset = -0.3, .rise = 0, .coat = Coat::Stone});
  body.ring({.inset = 0, .rise = 0.3, .coat = Coat::Stone});
  const double eaves = body.top();
  switch (random.between(0, 4)) {
    case 0:
    case 1:  // mansard
      body.ring({.inset = 1.2, .rise = 2.7, .coat = roof});
      body.hip(on_grid(depth * 0.12), Coat::Slate);
      for (int i = 0; i < bays; i += 2) {
        const double x = on_grid((i + 0.5) * width / bays);
        add_dormer(b, {x, 0, eaves + 0.6}, 2, wall, roof);
      }
      break;
    case 2:
      body.hip(on_grid(depth * 0.38), roof);
      add_chimney(b, {on_grid(width * 0.4), on_grid(depth * 0.55), eaves + 0.2},
                  on_grid(depth * 0.38) + 0.6);
      break;
    case 3:
      body.vault(on_grid(depth * 0.32), 10, random.chance(50) ? Coat::Copper : Coat::Metal, wall);
      break;
    default:
      add_flat_roof(b, body, random, wall, {0, 0, 0}, width, depth);
      break;
  }
  if (random.chance(35)) {
    add_balconies(b, style, width, lowest_balcony, random.chance(50) ? Coat::Stone : Coat::Metal);
  }
}

}  // namespace

void add_house(ModelBuilder& b, Random& random, double width, double depth) {
  width = even_metres(width);
  depth = even_metres(depth);
  const Coat wall = pick(kWalls, random), roof = pick(kRoofs, random);
  WallStyle style{.floors = random.between(1, 2), .coat = wall};
  const int bays = style.floors == 1 ? 3 : 2;
  style.bays = {bays, 0, random.between(0, 1), 0};
  style.bays[1] = random.chance(25) ? 1 : 0;
  style.depth = random.chance(75) ? 0.12 : 0;
  style.deep_all = false;
  RingBody body(b, {0, 0, 0}, width, depth);
  body.walls(style);
  const double eaves = body.top(), rise = on_grid(depth * random.between(36, 56) / 100.0);
  const bool hip = random.chance(40);
  if (hip) {
    body.ring({.inset = -0.4, .rise = 0, .coat = Coat::Wood});
    body.hip(rise, roof);
  } else {
    body.gable({.rise = rise, .overhang = 0.4, .roof = roof, .wall = wall});
  }
  add_chimney(b, {on_grid(width * 0.3), on_grid(depth * 0.58), eaves + 0.2}, rise);
  if (!hip && rise > 3.2 && random.chance(45)) {
    const double y = on_grid(depth * 0.1);
    const double z = on_grid(eaves + rise * (y + 0.4) / (depth / 2 + 0.4) - 0.1);
    add_dormer(b, {on_grid(width / 2), y, z}, on_grid(depth * 0.35), wall, roof);
  }
  const double door = on_grid(width / bays * (bays / 2 + 0.5));
  add_porch(b, random, door);
  if (random.chance(6)) add_turret(b, {width, 0, 0}, on_grid(eaves + rise * 0.3), wall, roof);
  if (random.chance(22)) {  // a lean-to at the side
    const double low = on_grid(depth * 0.15), high = on_grid(depth * 0.75);
    RingBody garage(b, {width - 0.2, low, 0}, 2.8, high - low);
    garage.walls({.floors = 1, .floor_height = 2.4, .bays = {}, .foundation = 0.3, .coat = wall});
    garage.ring({.inset = -0.2, .rise = 0, .coat = Coat::Wood});
    garage.ring({.inset = 0, .rise = 0.2, .coat = Coat::Stone});
    garage.close(Coat::Concrete);
  }
}

void add_shed(ModelBuilder& b, Random& random, double width, double depth) {
  width = even_metres(width);
  depth = even_metres(depth);
  const Coat wall = random.chance(50) ? Coat::Wood : Coat::Brick;
  RingBody body(b, {0, 0, 0}, width, depth);
  body.walls({.floors = 1, .floor_height = random.metres(2.2, 3.2), .bays = {}, .coat = wall});
  body.gable(
      {.rise = on_grid(depth * 0.4), .overhang = 0.2, .roof = pick(kRoofs, random), .wall = wall});
}

void add_town_house(ModelBuilder& b, Random& random, double width, double depth) {
  width = even_metres(width);
  depth = even_metres(depth);
  const Coat wall = pick(kWalls, random), roof = pick(kRoofs, random);
  const int floors = random.chance(60) ? 2 : random.between(2, 4);
  const Site outer = b.site();
  // The ridge runs from front to back: the right side of the body is the front of the house.
  b.place(outer.at({0, depth, 0}, 3));
  WallStyle style{.floors = floors, .bays = {}, .front = 1, .coat = wall};
  style.bays = {0, std::max(2, int(width / 3.4)), 0, random.chance(45) ? 1 : 0};
  style.deep_all = false;
  style.floor_height = random.metres(2.8, 3.2);
  style.depth = random.chance(80) ? 0.15 : 0;
  style.shop = random.chance(25);
  RingBody body(b, {0, 0, 0}, depth, width);
  body.walls(style);
  const double eaves = body.top(), rise = on_grid(width * random.between(50, 75) / 100.0);
  body.gable({.rise = rise, .overhang = 0.3, .roof = roof, .wall = wall});
  add_chimney(b, {on_grid(depth * 0.4), on_grid(width * 0.55), eaves + 0.2}, rise);
  b.place(outer);
  if (random.chance(30)) {  // a bay window
    const double middle = on_grid(width / 2), low = on_grid(style.floor_height + 0.2);
    add_lathe(b, {middle, 0, 0}, 12,
              {straight_strip(0, low - 1, 1.1, low), straight_strip(1.1, low, 1.1, low + 2.4),
               straight_strip(1.1, low + 2.4, 1.3, low + 2.4),
               straight_strip(1.3, low + 2.4, 0, low + 3.4)},
              {Coat::Stone, wall, Coat::Stone, Coat::Copper});
  }
}

void add_apartments(ModelBuilder& b, Random& random, double width, double depth) {
  add_flats(b, random, width, depth, 1);
}

void add_arcade_house(ModelBuilder& b, Random& random, double width, double depth) {
  constexpr double kWalk = 2.6, kArcadeHeight = 3.7;
  const Coat stone = random.chance(60) ? Coat::Sandstone : Coat::Plaster;
  const int bays = std::max(2, int(width / 3.6));
  const double bay = std::floor(width / bays * 10) / 10;
  add_arch(b, {.low = {0, 0, -0.3},
               .width = bay,
               .thickness = 0.5,
               .height = kArcadeHeight + 0.3,
               .opening = on_grid(bay - 0.9),
               .spring = on_grid(kArcadeHeight - bay / 2),
               .bays = bays,
               .segments = 6,
               .coat = stone});
  b.coat(Coat::Stone);
  add_box(b, {-0.15, -0.15, kArcadeHeight - 0.1},
          {on_grid(bays * bay + 0.15), kWalk + 0.15, kArcadeHeight + 0.25});
  const Site outer = b.site();
  b.place(outer.at({0, kWalk, 0}));
  add_flats(b, random, bays * bay, depth - kWalk, 2);
  b.place(outer);
}

void add_office_tower(ModelBuilder& b, Random& random, double width, double depth) {
  width = even_metres(width);
  depth = even_metres(depth);
  const Coat wall = random.chance(60) ? Coat::Concrete : Coat::Sandstone;
  const int floors = random.between(7, 16);
  WallStyle style{.floors = floors, .floor_height = 3.6, .sill = 0.7, .coat = wall};
  int bays = std::max(2, int(width / 5)), side_bays = std::max(2, int(depth / 5));
  style.bays = {bays, side_bays, bays, side_bays};
  style.window_width = on_grid(std::min(width / bays, depth / side_bays) - 1.0);
  style.window_height = 2.3;
  style.depth = random.chance(35) ? 0.3 : 0;
  RingBody body(b, {0, 0, 0}, width, depth);
  body.walls(style);
  add_flat_roof(b, body, random, wall, {0, 0, 0}, width, depth);
  const double setback = 2.6, top = body.top();
  style.floors = random.between(1, 4);
  style.door = false;
  bays = std::max(1, bays - 1);
  side_bays = std::max(1, side_bays - 1);
  style.bays = {bays, side_bays, bays, side_bays};
  style.window_width = 2.4;
  RingBody upper(b, {setback, setback, top}, width - 2 * setback, depth - 2 * setback);
  upper.walls(style);
  const double middle_x = on_grid(width / 2), middle_y = on_grid(depth / 2);
  if (random.chance(40)) {
    upper.hip(on_grid(width * 0.6), Coat::Copper);
  } else {
    upper.close(Coat::Concrete);
    const double z = upper.top() - 0.2;
    b.coat(Coat::Metal);
    add_lathe(
        b, {middle_x, middle_y, z}, 16,
        {straight_strip(0, 0, 1.5, 0), straight_strip(1.5, 0, 1.5, 2.7),
         straight_strip(1.5, 2.7, 0.35, 2.7), straight_strip(0.35, 2.7, 0, random.metres(10, 18))});
  }
}

void add_round_tower(ModelBuilder& b, Random& random, double width, double depth) {
  const double radius = on_grid(std::min(width, depth) / 2 - 0.8);
  const Vec3d centre{on_grid(width / 2), on_grid(depth / 2), 0};
  const int floors = random.between(2, 5), segments = 20;
  const double ledge = 0.3, band = 3.6;
  const Coat wall = random.chance(50) ? Coat::Sandstone : Coat::Plaster;
  const Coat roof = random.chance(50) ? Coat::Copper : Coat::Slate;
  std::vector<LatheStrip> strips;
  std::vector<Coat> coats;
  const auto add = [&](Coat coat, LatheStrip strip) {
    strips.push_back(std::move(strip));
    coats.push_back(coat);
  };
  add(Coat::Stone, straight_strip(0, -0.4, radius, -0.4));
  for (int floor = 0; floor < floors; ++floor) {
    const double z = floor * band, low = floor == 0 ? -0.4 : z, rim = z + band - 0.4;
    add(wall, straight_strip(radius, low, radius, rim));
    add(Coat::Stone, straight_strip(radius, rim, radius + ledge, rim));
    add(Coat::Stone, straight_strip(radius + ledge, rim, radius + ledge, z + band));
    if (floor + 1 < floors) {
      add(Coat::Stone, straight_strip(radius + ledge, z + band, radius, z + band));
    }
  }
  const double top = floors * band;
  if (random.chance(60)) {  // a dome with a lantern
    const double dome = radius * 0.95, lamp = radius * 0.18;
    add(Coat::Stone, straight_strip(radius + ledge, top, dome, top));
    const LatheStrip strip = dome_strip(dome, top, radius * 0.8, 6, lamp);
    const double crown = strip.back().z;
    add(roof, strip);
    add(Coat::Stone, straight_strip(lamp, crown, lamp, crown + 2));
    add(Coat::Stone, straight_strip(lamp, crown + 2, lamp * 1.4, crown + 2));
    add(roof, straight_strip(lamp * 1.4, crown + 2, 0, crown + 4.4));
  } else {
    add(roof, straight_strip(radius + ledge, top, 0, top + radius * 1.6));
  }
  add_lathe(b, centre, segments, strips, coats);
  b.coat(Coat::Stone);
  add_stairs(b, {centre.x - 2, on_grid(centre.y - radius - 0.9), -0.1}, 4, 4, 0.3, 0.15);
  b.coat(Coat::Wood);
  add_box(b, {centre.x - 0.8, on_grid(centre.y - radius - 0.1), 0.3},
          {centre.x + 0.8, centre.y, 2.7});
}

void add_hall(ModelBuilder& b, Random& random, double width, double depth) {
  const Coat wall = random.chance(60) ? Coat::Brick : Coat::Concrete;
  const int bays = std::max(1, int(width / 11));
  const double bay = std::floor(width / bays * 10) / 10, height = random.metres(5, 7);
  const Site outer = b.site();
  for (int i = 0; i < bays; ++i) {
    // Each bay is a vault that runs from front to back, and each second one a little lower, so that
    // walls meet and do not lie in one plane.
    const double lower = i % 2 == 0 ? 0 : 0.3, reach = i % 2 == 0 ? -0.05 : 0.2;
    b.place(outer.at({on_grid(i * bay + bay + reach), 0.5 + lower, 0}, 1));
    RingBody body(b, {0, 0, 0}, on_grid(depth - 0.6 - 2 * lower), bay + 2 * reach);
    body.walls({.floors = 1,
                .floor_height = height - lower,
                .bays = {},
                .foundation = 0.4 + lower,
                .coat = wall});
    body.vault(on_grid(bay * 0.38), 12, Coat::Metal, wall);
    b.place(outer);
  }
  add_arch(b, {.low = {0, 0, -0.35},
               .width = bay,
               .thickness = 1,
               .height = height + 0.6,
               .opening = on_grid(bay * 0.55),
               .spring = on_grid(height - bay * 0.275 - 0.5),
               .bays = bays,
               .segments = 12,
               .coat = wall});
  if (random.chance(40)) {
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
      add_box(b, centre + Vec3d{x - 0.15, y - 0.15, -0.3},
              centre + Vec3d{x + 0.15, y + 0.15, height + 0.1});
    }
  }
  for (double z : {on_grid(height / 3), on_grid(height * 2 / 3)}) {
    for (double side : {-reach, reach}) {
      add_box(b, centre + Vec3d{-reach, side - 0.08, z},
              centre + Vec3d{reach, side + 0.08, z + 0.2});
      add_box(b, centre + Vec3d{side - 0.1, -reach, z + 0.4},
              centre + Vec3d{side + 0.1, reach, z + 0.6});
    }
  }
  const double tank = on_grid(radius * 1.5), eaves = on_grid(radius * 1.12);
  add_lathe(b, centre + Vec3d{0, 0, height}, 20,
            {straight_strip(0, 0, radius, 0), straight_strip(radius, 0, radius, tank),
             straight_strip(radius, tank, eaves, tank),
             straight_strip(eaves, tank, 0, tank + radius * 0.7)},
            {Coat::Wood, Coat::Wood, Coat::Wood, Coat::Slate});
}

void add_factory_chimney(ModelBuilder& b, Random& random, double width, double depth) {
  const Vec3d centre{on_grid(width / 2), on_grid(depth / 2), 0};
  const double height = random.metres(18, 30), foot = 1.3, top = 0.8;
  b.coat(Coat::Brick);
  add_lathe(b, centre, 20,
            {straight_strip(0, -0.5, foot, -0.5), straight_strip(foot, -0.5, top, height, 2),
             straight_strip(top, height, top + 0.2, height),
             straight_strip(top + 0.2, height, top + 0.2, height + 0.8),
             straight_strip(top + 0.2, height + 0.8, top - 0.2, height + 0.8),
             straight_strip(top - 0.2, height + 0.8, top - 0.2, height - 1),
             straight_strip(top - 0.2, height - 1, 0, height - 1)});
}

}  // namespace crease
