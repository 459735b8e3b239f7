#include "generate/blocks.h"

#include "generate/buildings.h"
#include "generate/shapes.h"

#include <algorithm>
#include <array>
#include <utility>

namespace crease {

namespace {

void add_trees(ModelBuilder& b, Random& random, double width, double depth) {
  // Two do not grow in one place, nor to one height.
  const int count = random.chance(30) ? 2 : 1;
  const double room = width / count - 1;
  for (int i = 0; i < count; ++i) {
    const double x = on_grid(i * (room + 1)) + random.metres(0, room);
    const double y = random.metres(0, depth);
    const double height = i == 0 ? random.metres(4, 6.4) : random.metres(6.6, 9);
    add_tree(b, {x, y, 0}, height, random.chance(30));
  }
}

// In line along x, four metres and more apart.
void add_alley(ModelBuilder& b, Random& random, double width, double depth) {
  const int count = std::max(2, int(width / 8));
  const double height = random.metres(5, 7);
  for (int i = 0; i < count; ++i) {
    add_tree(b, on_grid(Vec3d{(i + 0.5) * width / count, depth / 2, 0}),
             height + 0.1 * random.between(-6, 6), false);
  }
}

constexpr BuildingKind kTownHouse{"town house", add_town_house},
    kApartments{"apartments", add_apartments}, kArcadeHouse{"arcade house", add_arcade_house},
    kOffice{"office tower", add_office_tower}, kRound{"round tower", add_round_tower},
    kHall{"hall", add_hall}, kWater{"water tower", add_water_tower}, kChurch{"church", add_church},
    kTownHall{"town hall", add_town_hall}, kRotunda{"rotunda", add_rotunda},
    kArcade{"arcade", add_arcade}, kMonument{"monument", add_monument},
    kFountain{"fountain", add_fountain}, kAlley{"trees", add_alley};

struct Block {
  Random& random;
  double width, depth;
  std::vector<Lot>& lots;
};

// One of the four sides of a rectangle around the block's middle: lots in a row that look outwards.
struct Side {
  int turns;
  double half_along, half_across;  // half the row's length; how far out the fronts are
};

Vec3d corner_on(const Side& side, double from) {
  const double along = from - side.half_along, out = side.half_across;
  const Vec3d corners[] = {{along, -out, 0}, {out, along, 0}, {-along, out, 0}, {-out, -along, 0}};
  return corners[side.turns];
}

struct RowKind {
  BuildingKind kind;
  int percent;
  double least, most, depth;
};
constexpr RowKind kOldRow[] = {{kTownHouse, 70, 6.4, 9, 10.6},
                               {kApartments, 20, 11, 17, 10.6},
                               {kArcadeHouse, 7, 11, 15, 11.6},
                               {kRound, 3, 11, 12, 11}};
constexpr RowKind kTerrace[] = {{kTownHouse, 90, 6.4, 8.4, 10}, {kArcadeHouse, 10, 11, 14, 12}};

// Detached, but close: an alley of a metre or two between.
template <std::size_t N>
void add_row(Block& block, const Side& side, const RowKind (&kinds)[N]) {
  Random& random = block.random;
  const double length = 2 * side.half_along;
  double at = 0;
  while (true) {
    int draw = random.between(0, 99);
    const RowKind* kind = kinds;
    while (draw >= kind->percent && kind + 1 < std::end(kinds)) {
      draw -= kind->percent;
      ++kind;
    }
    if (length - at < kind->least) kind = kinds;
    const double left = length - at;
    if (left < kind->least) return;
    double width = random.metres(kind->least, kind->most);
    if (left - width < kinds[0].least + 1) width = std::min(left, kind->most);
    block.lots.push_back(
        {kind->kind, corner_on(side, on_grid(at)), side.turns, on_grid(width), kind->depth});
    at = on_grid(at + width + random.metres(0.8, 1.6));
  }
}

// Houses around a courtyard.
void plan_perimeter(Block& block) {
  constexpr double kDepth = 11.8;
  const double x = block.width / 2 - 2, y = block.depth / 2 - 2;
  for (int turns = 0; turns < 4; ++turns) {
    const bool long_side = turns % 2 == 0;
    add_row(block, {turns, long_side ? x : y - kDepth - 1, long_side ? y : x}, kOldRow);
  }
  const double court = block.width - 2 * kDepth - 10;
  block.lots.push_back({kTrees, {-court / 2, -4, 0}, 0, court, 8});
  if (block.random.chance(60)) {
    block.lots.push_back({kShed, {-4, -6, 0}, 0, block.random.metres(5, 8), 5});
  }
}

void plan_downtown(Block& block) {
  const double half_x = block.width / 2, half_y = block.depth / 2;
  for (double x : {-half_x + 2, 2.0}) {
    for (double y : {-half_y + 2, 2.0}) {
      Random& random = block.random;
      const BuildingKind kind = random.chance(75)   ? kOffice
                                : random.chance(40) ? kRound
                                                    : kApartments;
      const double width = random.metres(18, half_x - 4), depth = random.metres(14, half_y - 4);
      block.lots.push_back({kind, on_grid(Vec3d{x, y, 0}), 0, width, depth});
    }
  }
}

// Two rows back to back, gardens between.
void plan_terraces(Block& block) {
  for (int turns : {0, 2}) {
    add_row(block, {turns, block.width / 2 - 2, block.depth / 2 - 4}, kTerrace);
  }
  for (double x = -block.width / 2 + 4; x + 12 < block.width / 2; x += 16) {
    block.lots.push_back({kTrees, {x, -5, 0}, 0, 12, 10});
    if (block.random.chance(40)) block.lots.push_back({kShed, {x + 12, -3, 0}, 0, 3, 2.6});
  }
}

void plan_houses(Block& block) {
  Random& random = block.random;
  const int plots = int(block.width / 13.4);
  const double plot = on_grid(block.width / plots);
  for (int row = 0; row < 2; ++row) {
    const double sign = row == 0 ? 1 : -1;
    for (int i = 0; i < plots; ++i) {
      const double left = -block.width / 2 + i * plot;
      const double width = random.metres(8, 10.4), depth = random.metres(7, 9.6);
      const double x = left + 1.6, y = -block.depth / 2 + random.metres(4, 7);
      block.lots.push_back({kHouse, on_grid(Vec3d{sign * x, sign * y, 0}), 2 * row, width, depth,
                            random.chance(12)});
      const double behind = y + 11;
      if (random.chance(45)) {
        block.lots.push_back(
            {kTrees, on_grid(Vec3d{sign * (left + 2), sign * behind, 0}), 2 * row, plot - 4, 3});
      }
      if (!random.chance(22)) continue;
      block.lots.push_back({kShed, on_grid(Vec3d{sign * (left + 3), sign * (behind + 1), 0}),
                            2 * row, random.metres(3, 5), random.metres(3, 4)});
    }
  }
}

void plan_park(Block& block) {
  const double x = block.width / 2 - 4, y = block.depth / 2 - 4;
  const int what = block.random.between(0, 2);
  block.lots.push_back({what == 0   ? kRotunda
                        : what == 1 ? kMonument
                                    : kFountain,
                        {-9, -9, 0},
                        0,
                        18,
                        18});
  block.lots.push_back({kArcade, {-x + 4, y - 6, 0}, 0, block.random.metres(21, 34), 4});
  for (double at_y : {-y, y - 2}) block.lots.push_back({kAlley, {-x, at_y, 0}, 0, 2 * x, 3});
  for (double at_x : {-x, x - 10}) {
    for (double at_y : {-y + 6, 2.0}) block.lots.push_back({kTrees, {at_x, at_y, 0}, 0, 10, 10});
  }
}

void plan_church(Block& block) {
  const double x = block.width / 2 - 5, y = block.depth / 2 - 5;
  const int turns = block.random.chance(50) ? 0 : 2;
  block.lots.push_back({kChurch, turns == 0 ? Vec3d{-20, -6, 0} : Vec3d{20, 6, 0}, turns, 40, 13});
  for (double at_y : {-y - 1, y - 2}) block.lots.push_back({kAlley, {-x, at_y, 0}, 0, 2 * x, 3});
}

// A square with a town hall on one side and old houses on two.
void plan_market(Block& block) {
  const double x = block.width / 2 - 2, y = block.depth / 2 - 2;
  block.lots.push_back({kTownHall, {15, y, 0}, 2, 30, 18});
  block.lots.back().corner = {-15, y - 18, 0};
  block.lots.back().quarter_turns = 0;
  block.lots.push_back(
      {block.random.chance(60) ? kFountain : kMonument, {-6, -y + 4, 0}, 0, 12, 12});
  for (int turns : {1, 3}) add_row(block, {turns, y, x}, kOldRow);
}

void plan_works(Block& block) {
  const double x = block.width / 2 - 3, y = block.depth / 2 - 3;
  Random& random = block.random;
  block.lots.push_back({kHall, {-x, -y, 0}, 0, random.metres(33, 44), random.metres(18, y)});
  block.lots.push_back({kHall, {x, y, 0}, 2, random.metres(22, 33), random.metres(12, 16)});
  block.lots.push_back({kWater, {x - 11, -y + 1, 0}, 0, 10, 10});
  block.lots.push_back({kShed, {-x + 2, y - 12, 0}, 0, random.metres(6, 8), random.metres(6, 8)});
  block.lots.push_back({kTrees, {-x + 12, y - 12, 0}, 0, 8, 10});
}

struct BlockKind {
  void (*plan)(Block&);
  bool green;
  std::array<int, 5> percent;  // in each zone
};
constexpr BlockKind kBlocks[] = {
    {plan_perimeter, false, {64, 10, 18, 2, 10}}, {plan_market, false, {8, 5, 2, 1, 0}},
    {plan_terraces, true, {16, 0, 32, 10, 10}},   {plan_park, true, {7, 5, 6, 4, 0}},
    {plan_church, true, {5, 0, 4, 2, 0}},         {plan_downtown, false, {0, 80, 0, 0, 0}},
    {plan_works, false, {0, 0, 2, 2, 70}},        {plan_houses, true, {0, 0, 36, 79, 10}},
};

}  // namespace

const BuildingKind kHouse{"house", add_house}, kShed{"shed", add_shed},
    kBridge{"bridge", add_bridge}, kTrees{"trees", add_trees};

BlockPlan plan_block(Random& random, Zone zone, double width, double depth) {
  int draw = random.between(0, 99);
  const BlockKind* kind = kBlocks;
  while (draw >= kind->percent[std::size_t(zone)] && kind + 1 < std::end(kBlocks)) {
    draw -= kind->percent[std::size_t(zone)];
    ++kind;
  }
  BlockPlan plan{.green = kind->green, .lots = {}};
  Block block{random, width, depth, plan.lots};
  kind->plan(block);
  return plan;
}

std::vector<Lot> plan_close(double half_width, double half_depth) {
  std::vector<Lot> lots;
  for (double x : {-1.0, 1.0}) {
    for (double y : {-1.0, 1.0}) {
      const double at_x = x * (half_width - 16), at_y = y * (half_depth - 14);
      lots.push_back({x * y > 0 ? kRotunda : kMonument, {at_x - 8, at_y - 8, 0}, 0, 16, 16});
    }
    for (int i = -1; i <= 1; ++i) {
      lots.push_back({kAlley, {i * 52.0 - 24, x * (half_depth - 7) - 2, 0}, 0, 48, 4});
      lots.push_back({kAlley, {x * (half_width - 7) + 2, i * 42.0 - 20, 0}, 1, 40, 4});
    }
  }
  return lots;
}

}  // namespace crease
