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
  style.bays_front = std::max(3, int(length / 4));
  style.bays_side = 0;
  style.window_width = 1.2;
  style.window_height = on_grid(eaves * 0.5);
  style.sill = on_grid(eaves * 0.25);
  style.depth = 0.4;
  RingBody nave(b, {side, 0, 0}, length, span);
  nave.walls(style);
  nave.close();
  add_gable_roof(b, {.low = {side, 0, eaves},
                     .width = length,
                     .depth = span,
                     .rise = on_grid(span * 0.7),
                     .overhang = 0.4,
                     .rows = 5,
                     .roof = roof,
                     .gable = wall});
  const double bay = length / style.bays_front;
  b.coat(Coat::Stone);
  for (int i = 0; i <= style.bays_front; ++i) {  // buttresses
    const double x = on_grid(side + std::clamp(i * bay, 0.4, length - 0.4) - 0.4);
    add_box(b, {x, -0.9, 0}, {x + 0.8, 0, on_grid(eaves * 0.8)}, 4);
    add_box(b, {x, span, 0}, {x + 0.8, span + 0.9, on_grid(eaves * 0.8)}, 4);
  }
  const Vec3d apse{on_grid(side + length), on_grid(span / 2), 0};
  b.coat(wall);
  add_cylinder(b, apse, on_grid(span * 0.38), on_grid(eaves * 0.9), 24, 3);
  b.coat(roof);
  add_cone(b, apse + Vec3d{0, 0, on_grid(eaves * 0.9)}, span * 0.41, span * 0.4, 24, 3);

  const double tower_y = on_grid(span / 2 - side / 2);
  const double floor_height = 4.5;
  WallStyle tower_style{.floors = random.between(4, 5),
                        .floor_height = floor_height,
                        .bays_front = 1,
                        .bays_side = 1,
                        .window_width = 1.2,
                        .window_height = 2.4,
                        .sill = 1.2,
                        .depth = 0.4,
                        .coat = wall};
  RingBody tower(b, {0, tower_y, 0}, side, side);
  tower.walls(tower_style);
  tower.ring({.inset = -0.3, .rise = 0, .coat = Coat::Stone});
  tower.ring({.inset = 0, .rise = 0.4, .coat = Coat::Stone});
  if (random.chance(50)) {
    tower.hip(6, random.metres(10, 16), Coat::Copper);
  } else {
    tower.close();
    b.coat(Coat::Copper);
    const Vec3d middle{side / 2, on_grid(span / 2), tower.top()};
    if (random.chance(50)) {
      add_spire(b, middle, 2.9, random.metres(11, 17), 8);
    } else {  // an onion
      LatheStrip onion;
      constexpr double kProfile[][2] = {{2.2, 0},   {2.7, 0.8}, {2.8, 1.6}, {2.3, 2.6},
                                        {1.4, 3.5}, {0.6, 4.3}, {0.25, 5.2}};
      for (std::size_t i = 0; i < std::size(kProfile); ++i) {
        const auto& low = kProfile[i == 0 ? 0 : i - 1];
        const auto& high = kProfile[std::min(i + 1, std::size(kProfile) - 1)];
        onion.push_back({kProfile[i][0], kProfile[i][1], high[1] - low[1], low[0] - high[0]});
      }
      add_lathe(b, middle, 24,
                {straight_strip(0, 0, 2.2, 0), onion, straight_strip(0.25, 5.2, 0, 7)});
    }
  }
}

void add_rotunda(ModelBuilder& b, Random& random, double width, double depth) {
  const double radius = on_grid(std::min({width, depth, 16.0}) / 2 - 1);
  const Vec3d centre{on_grid(width / 2), on_grid(depth / 2), 0};
  const int columns = random.between(5, 8) * 2;
  const double height = on_grid(radius * 0.9);
  b.coat(Coat::Stone);
  const double step = 0.2;
  add_lathe(
      b, centre, 32,
      {straight_strip(0, 0, radius + 0.8, 0), straight_strip(radius + 0.8, 0, radius + 0.8, step),
       straight_strip(radius + 0.8, step, radius + 0.4, step),
       straight_strip(radius + 0.4, step, radius + 0.4, 2 * step),
       straight_strip(radius + 0.4, 2 * step, 0, 2 * step)});
  b.coat(Coat::Plaster);
  for (int i = 0; i < columns; ++i) {
    const Vec3d foot = centre + on_circle(i, columns) * (radius - 0.4);
    add_column(b, {on_grid(foot.x), on_grid(foot.y), 2 * step}, 0.3, height, 10);
  }
  const double top = on_grid(2 * step + height), beam = 0.9;
  b.coat(Coat::Sandstone);
  add_lathe(b, centre + Vec3d{0, 0, top}, 32,
            {straight_strip(0, 0, radius, 0), straight_strip(radius, 0, radius, beam),
             straight_strip(radius, beam, radius + 0.3, beam),
             straight_strip(radius + 0.3, beam, radius + 0.3, beam + 0.25),
             straight_strip(radius + 0.3, beam + 0.25, 0, beam + 0.25)});
  b.coat(Coat::Copper);
  add_dome(b, centre + Vec3d{0, 0, on_grid(top + beam + 0.25)}, radius * 0.9, radius * 0.7, 32);
}

void add_arcade(ModelBuilder& b, Random& random, double width, double depth) {
  const double bay = 4.2, thickness = 1.2, height = random.metres(5, 6);
  const int bays = std::max(2, int(width / bay));
  const double y = on_grid(depth / 2);
  for (int i = 0; i < bays; ++i) {
    add_arch(b, {.low = {on_grid(i * bay), y, 0},
                 .width = bay,
                 .thickness = thickness,
                 .height = height,
                 .opening = 3.0,
                 .spring = on_grid(height - 2.3),
                 .segments = 14});
  }
  b.coat(Coat::Stone);
  add_box(b, {0, y - 0.2, height}, {on_grid(bays * bay), y + thickness + 0.2, height + 0.3}, 3);
}

void add_monument(ModelBuilder& b, Random& random, double width, double depth) {
  const Vec3d centre{on_grid(width / 2), on_grid(depth / 2), 0};
  b.coat(Coat::Stone);
  for (int i = 0; i < 3; ++i) {
    const double half = 3 - 0.6 * i;
    add_box(b, centre + Vec3d{-half, -half, 0.3 * i}, centre + Vec3d{half, half, 0.3 * i + 0.3}, 2);
  }
  const double height = random.metres(7, 12);
  b.coat(Coat::Sandstone);
  add_column(b, centre + Vec3d{0, 0, 0.9}, 0.7, height, 24);
  b.coat(Coat::Copper);
  LatheStrip globe;
  constexpr int kRows = 8;
  for (int j = 0; j <= kRows; ++j) {
    const Vec3d p = on_circle(j, 2 * kRows);
    globe.push_back({0.9 * p.y, 0.9 * (1 - p.x), p.y, -p.x});
  }
  add_lathe(b, centre + Vec3d{0, 0, on_grid(0.9 + height)}, 20, {globe});
}

}  // namespace crease
