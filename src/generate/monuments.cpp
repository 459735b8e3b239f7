// Churches, rotundas and what else stands on squares.
#include "generate/buildings.h"
#include "generate/shapes.h"
#include "generate/walls.h"

#include <algorithm>
#include <cmath>

namespace crease {

void add_church(ModelBuilder& b, Random& random, double width, double depth) {
  const Coat wall = random.chance(50) ? Coat::Sandstone : Coat::Brick;
  const Coat roof = random.chance(50) ? Coat::Slate : Coat::RedTile;
  // The nave runs along x, the tower stands at its left end, the apse at its right end.
  const double side = 6, length = on_grid(std::min(width - side - 4, 26.0));
  const double span = std::floor(std::min(depth, 12.0) * 5) / 5;
  const double eaves = random.metres(8, 10);
  WallStyle style{.floors = 1, .floor_height = eaves, .door = false, .coat = wall};
  const int bays = std::max(3, int(length / 4));
  style.bays = {bays, 0, bays, 0};
  style.window_width = 1.2;
  style.window_height = on_grid(eaves * 0.5);
  style.sill = on_grid(eaves * 0.25);
  style.depth = 0.4;
  RingBody nave(b, {side - 0.5, 0, 0}, length + 0.5, span);
  nave.walls(style);
  nave.gable({.rise = on_grid(span * 0.7), .overhang = 0.4, .roof = roof, .wall = wall});
  const double bay = length / bays;
  b.coat(Coat::Stone);
  for (int i = 0; i <= bays; ++i) {  // buttresses
    const double x = on_grid(side + std::clamp(i * bay, 0.6, length - 0.6) - 0.4);
    add_box(b, {x, -0.9, -0.3}, {x + 0.8, 0.1, on_grid(eaves * 0.8)});
    add_box(b, {x, span - 0.1, -0.3}, {x + 0.8, span + 0.9, on_grid(eaves * 0.8)});
  }
  const double apse = on_grid(span * 0.38), apse_eaves = on_grid(eaves * 0.9);
  add_lathe(b, {on_grid(side + length), on_grid(span / 2), 0}, 24,
            {straight_strip(0, -0.3, apse, -0.3), straight_strip(apse, -0.3, apse, apse_eaves),
             straight_strip(apse, apse_eaves, apse + 0.3, apse_eaves),
             straight_strip(apse + 0.3, apse_eaves, 0, apse_eaves + apse)},
            {Coat::Stone, wall, Coat::Stone, roof});

  const double tower_y = on_grid(span / 2 - side / 2);
  RingBody tower(b, {0, tower_y, 0}, side, side);
  tower.walls({.floors = random.between(4, 5),
               .floor_height = 4.5,
               .bays = {1, 1, 1, 1},
               .window_width = 1.2,
               .window_height = 2.4,
               .sill = 1.2,
               .depth = 0.4,
               .front = 3,
               .foundation = 0.5,
               .coat = wall});
  tower.ring({.inset = -0.3, .rise = 0, .coat = Coat::Stone});
  tower.ring({.inset = 0, .rise = 0.4, .coat = Coat::Stone});
  if (random.chance(50)) {
    tower.hip(random.metres(10, 16), Coat::Copper);
    return;
  }
  tower.close();
  b.coat(Coat::Copper);
  const Vec3d middle{side / 2, on_grid(span / 2), tower.top() - 0.1};
  if (random.chance(50)) return add_spire(b, middle, 2.9, random.metres(11, 17), 8);
  LatheStrip onion;
  constexpr double kProfile[][2] = {{2.2, 0},   {2.7, 0.8}, {2.8, 1.6}, {2.3, 2.6},
                                    {1.4, 3.5}, {0.6, 4.3}, {0.25, 5.2}};
  for (std::size_t i = 0; i < std::size(kProfile); ++i) {
    const auto& low = kProfile[i == 0 ? 0 : i - 1];
    const auto& high = kProfile[std::min(i + 1, std::size(kProfile) - 1)];
    onion.push_back({kProfile[i][0], kProfile[i][1], high[1] - low[1], low[0] - high[0]});
  }
  add_lathe(b, middle, 24, {straight_strip(0, 0, 2.2, 0), onion, straight_strip(0.25, 5.2, 0, 7)});
}

void add_town_hall(ModelBuilder& b, Random& random, double width, double depth) {
  const Coat wall = random.chance(50) ? Coat::Sandstone : Coat::Ochre;
  const double porch = 4, body_depth = std::floor((std::min(depth, 20.0) - porch) * 5) / 5;
  width = std::floor(width * 5) / 5;
  const Site outer = b.site();
  b.place(outer.at({0, porch, 0}));
  WallStyle style{.floors = 3, .floor_height = 4, .coat = wall};
  const int bays = int(width / 3.2), side_bays = int(body_depth / 3.5);
  style.bays = {bays, side_bays, bays, side_bays};
  style.window_width = 1.3;
  style.window_height = 2.2;
  style.depth = 0.3;
  RingBody body(b, {0, 0, 0}, width, body_depth);
  body.walls(style);
  body.ring({.inset = -0.5, .rise = 0, .coat = Coat::Stone});
  body.ring({.inset = 0, .rise = 0.5, .coat = Coat::Stone});
  const double eaves = body.top(), rise = on_grid(body_depth * 0.3);
  body.hip(rise, Coat::Slate);

  const Vec3d middle{on_grid(width / 2), on_grid(body_depth / 2), 0};
  const double radius = on_grid(body_depth * 0.3), low = on_grid(eaves + 0.3);
  const double drum = on_grid(eaves + rise + 3.5), rim = radius + 0.4;
  const double lamp = on_grid(radius * 0.2);
  const LatheStrip dome = dome_strip(radius, drum + 0.5, radius * 1.08, 8, lamp);
  const double crown = dome.back().z;
  add_lathe(b, middle, 32,
            {straight_strip(0, low, radius, low), straight_strip(radius, low, radius, drum),
             straight_strip(radius, drum, rim, drum), straight_strip(rim, drum, rim, drum + 0.5),
             straight_strip(rim, drum + 0.5, radius, drum + 0.5), dome,
             straight_strip(lamp, crown, lamp, crown + 2.2),
             straight_strip(lamp, crown + 2.2, lamp + 0.3, crown + 2.2),
             straight_strip(lamp + 0.3, crown + 2.2, 0, crown + 5)},
            {wall, wall, Coat::Stone, Coat::Stone, Coat::Stone, Coat::Copper, Coat::Stone,
             Coat::Stone, Coat::Copper});
  b.coat(Coat::Plaster);
  for (int i = 0; i < 12; ++i) {  // around the drum
    const Vec3d foot = middle + on_circle(i + 0.5, 12) * (radius + 0.1);
    const double foot_z = on_grid(eaves + 0.4);
    add_cylinder(b, {on_grid(foot.x), on_grid(foot.y), foot_z}, 0.25, on_grid(drum - foot_z + 0.1),
                 8);
  }

  // The portico: six columns carry a gable that looks to the front.
  const double span = 14, from = on_grid(width / 2 - span / 2), height = 9;
  b.coat(Coat::Plaster);
  for (int i = 0; i < 6; ++i) {
    add_column(b, {on_grid(from + 1 + i * (span - 2) / 5), -3, 0.3}, 0.45, height - 0.2, 14);
  }
  b.coat(Coat::Stone);
  b.place(outer.at({on_grid(width / 2 + span / 2), 0.2, 0}, 1));
  RingBody pediment(b, {0, 0, height}, porch + 0.3, span);
  pediment.floor(Coat::Stone);
  pediment.ring({.inset = 0, .rise = 1, .coat = Coat::Stone});
  pediment.gable({.rise = 2.6, .overhang = 0.3, .roof = Coat::Slate, .wall = Coat::Plaster});
  b.place(outer.at({0, porch, 0}));
  b.coat(Coat::Stone);
  add_box(b, {from - 0.3, -porch, -0.3}, {on_grid(from + span + 0.3), 0.2, 0.45});
  b.place(outer.at({0, -1.2, 0}));
  add_stairs(b, {from, 0, -0.1}, span, 4, 0.35, 0.13);
  b.place(outer);
}

void add_rotunda(ModelBuilder& b, Random& random, double width, double depth) {
  const double radius = on_grid(std::min({width, depth, 16.0}) / 2 - 1);
  const Vec3d centre{on_grid(width / 2), on_grid(depth / 2), 0};
  const int columns = random.between(4, 6) * 2;
  const double height = on_grid(radius * 0.9);
  b.coat(Coat::Stone);
  const double step = 0.2;
  add_lathe(b, centre, 32,
            {straight_strip(0, -0.3, radius + 0.8, -0.3),
             straight_strip(radius + 0.8, -0.3, radius + 0.8, step),
             straight_strip(radius + 0.8, step, radius + 0.4, step),
             straight_strip(radius + 0.4, step, radius + 0.4, 2 * step),
             straight_strip(radius + 0.4, 2 * step, 0, 2 * step)});
  b.coat(Coat::Plaster);
  for (int i = 0; i < columns; ++i) {
    const Vec3d foot = centre + on_circle(i, columns) * (radius - 0.4);
    add_column(b, {on_grid(foot.x), on_grid(foot.y), 2 * step - 0.1}, 0.3, height + 0.2, 9);
  }
  const double top = on_grid(2 * step + height), beam = top + 0.9, rim = beam + 0.25;
  add_lathe(b, centre, 32,
            {straight_strip(0, top, radius, top), straight_strip(radius, top, radius, beam),
             straight_strip(radius, beam, radius + 0.3, beam),
             straight_strip(radius + 0.3, beam, radius + 0.3, rim),
             straight_strip(radius + 0.3, rim, radius * 0.9, rim),
             dome_strip(radius * 0.9, rim, radius * 0.7, 8)},
            {Coat::Sandstone, Coat::Sandstone, Coat::Sandstone, Coat::Sandstone, Coat::Sandstone,
             Coat::Copper});
}

void add_arcade(ModelBuilder& b, Random& random, double width, double depth) {
  const double bay = 4.2, thickness = 1.2, height = random.metres(5, 6);
  const int bays = std::max(2, int(width / bay));
  const double y = on_grid(depth / 2);
  add_arch(b, {.low = {0, y, -0.3},
               .width = bay,
               .thickness = thickness,
               .height = height + 0.3,
               .opening = 3.0,
               .spring = on_grid(height - 2),
               .bays = bays,
               .segments = 12});
  b.coat(Coat::Stone);
  add_box(b, {-0.2, y - 0.2, height - 0.1},
          {on_grid(bays * bay) + 0.2, y + thickness + 0.2, height + 0.3});
}

void add_monument(ModelBuilder& b, Random& random, double width, double depth) {
  const Vec3d centre{on_grid(width / 2), on_grid(depth / 2), 0};
  RingBody steps(b, centre - Vec3d{3, 3, 0.3}, 6, 6);
  steps.floor(Coat::Stone);
  steps.ring({.inset = 0, .rise = 0.6, .coat = Coat::Stone});
  for (int i = 0; i < 2; ++i) {
    steps.ring({.inset = 0.6, .rise = 0, .coat = Coat::Stone});
    steps.ring({.inset = 0, .rise = 0.3, .coat = Coat::Stone});
  }
  steps.close();
  const double height = random.metres(7, 12);
  b.coat(Coat::Sandstone);
  add_column(b, centre + Vec3d{0, 0, 0.8}, 0.7, height, 20);
  b.coat(Coat::Copper);
  LatheStrip globe;
  constexpr int kRows = 8;
  for (int j = 0; j <= kRows; ++j) {
    const Vec3d p = on_circle(j, 2 * kRows);
    globe.push_back({0.9 * p.y, 0.9 * (1 - p.x), p.y, -p.x});
  }
  add_lathe(b, centre + Vec3d{0, 0, on_grid(0.7 + height)}, 16, {globe});
}

void add_fountain(ModelBuilder& b, Random& random, double width, double depth) {
  const Vec3d centre{on_grid(width / 2), on_grid(depth / 2), 0};
  const double radius = random.metres(3, 5), edge = radius - 0.5, bowl = on_grid(radius * 0.45);
  const double shaft = 0.3, z = 2.2;
  add_lathe(b, centre, 32,
            {straight_strip(0, -0.3, radius, -0.3), straight_strip(radius, -0.3, radius, 0.7),
             straight_strip(radius, 0.7, edge, 0.7), straight_strip(edge, 0.7, edge, 0.4),
             straight_strip(edge, 0.4, shaft, 0.4), straight_strip(shaft, 0.4, shaft, z - 0.4),
             straight_strip(shaft, z - 0.4, bowl, z), straight_strip(bowl, z, bowl, z + 0.2),
             straight_strip(bowl, z + 0.2, shaft / 2, z + 0.1),
             straight_strip(shaft / 2, z + 0.1, 0, z + 1.2)},
            {Coat::Stone, Coat::Stone, Coat::Stone, Coat::Stone, Coat::Water, Coat::Stone,
             Coat::Stone, Coat::Stone, Coat::Water, Coat::Water});
}

void add_bridge(ModelBuilder& b, Random&, double width, double depth) {
  // A wall of arches as thick as the road is wide, its feet under water, its ends in the quays.
  constexpr double kInQuay = 0.6, kFoot = 7;
  const Site outer = b.site();
  b.place(outer.at({width, -kInQuay, -kFoot}, 1));
  const int bays = std::max(1, int(depth / 9));
  const double bay = std::floor((depth + 2 * kInQuay) / bays * 10) / 10;
  add_arch(b, {.low = {0, 0, 0},
               .width = bay,
               .thickness = width,
               .height = kFoot - 0.2,
               .opening = on_grid(bay - 1.6),
               .spring = on_grid(kFoot - 0.8 - (bay - 1.6) / 2),
               .bays = bays,
               .segments = 16,
               .coat = Coat::Sandstone});
  b.place(outer);
  b.coat(Coat::Asphalt);
  add_box(b, {-0.2, -1.5, -0.4}, {width + 0.2, depth + 1.5, 0.1});
  b.coat(Coat::Stone);
  for (double x : {-0.3, width - 0.1}) {
    add_box(b, {x, -1, -0.5}, {x + 0.4, depth + 1, 0.95});
  }
}

}  // namespace crease
