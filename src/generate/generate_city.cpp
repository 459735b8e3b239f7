// The plan: blocks on a grid, in rings around the landmark, dense in the middle and green outside.
#include "crease/generate.h"

#include "generate/buildings.h"
#include "generate/shapes.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace crease {

namespace {

constexpr double kBlockWidth = 64, kBlockDepth = 52, kStreet = 12, kKerb = 0.15;
constexpr std::size_t kLandmarkFrom = 150'000;  // triangles: a small city has only a church

using AddBuilding = void (*)(ModelBuilder&, Random&, double width, double depth);

struct Kind {
  const char* name;
  AddBuilding add;
};

void add_trees(ModelBuilder& b, Random& random, double width, double depth) {
  const int count = random.between(1, 3);
  for (int i = 0; i < count; ++i) {
    const double x = random.metres(0, width), y = random.metres(0, depth);
    const double height = random.metres(4, 9);
    add_tree(b, {x, y, 0}, height, random.chance(30));
  }
}

constexpr Kind kHouse{"house", add_house}, kShed{"shed", add_shed},
    kApartments{"apartments", add_apartments}, kOffice{"office tower", add_office_tower},
    kRound{"round tower", add_round_tower}, kHall{"hall", add_hall},
    kWater{"water tower", add_water_tower}, kChurch{"church", add_church},
    kRotunda{"rotunda", add_rotunda}, kArcade{"arcade", add_arcade},
    kMonument{"monument", add_monument}, kTrees{"trees", add_trees};

struct Lot {
  Kind kind;
  Vec3d corner;           // front left, from the block's middle
  int quarter_turns = 0;  // 0: the front looks towards -y
  double width = 0, depth = 0;
  bool turned = false;  // by the angle of the 3-4-5 triangle besides
};

// Widths of houses in a row of `length` with gaps between.
std::vector<std::pair<double, double>> cut_row(Random& random, double length, double least,
                                               double most) {
  std::vector<std::pair<double, double>> pieces;  // begin, width
  double at = 0;
  while (length - at >= least) {
    double width = random.metres(least, most);
    if (length - at - width < least) width = std::min(length - at, most);
    pieces.emplace_back(at, on_grid(width));
    at = on_grid(at + width + random.metres(1.2, 3));
  }
  return pieces;
}

// Houses around a courtyard.
void plan_perimeter(Random& random, std::vector<Lot>& lots) {
  constexpr double kX = kBlockWidth / 2 - 2, kY = kBlockDepth / 2 - 2, kDepth = 11;
  for (int side = 0; side < 4; ++side) {
    const bool long_side = side % 2 == 0;
    const double length = long_side ? 2 * kX : 2 * (kY - kDepth) - 4;
    for (const auto& [begin, width] : cut_row(random, length, 11, 19)) {
      const double from = begin - length / 2;
      const Vec3d corner[] = {{from, -kY, 0}, {kX, from, 0}, {-from, kY, 0}, {-kX, -from, 0}};
      const Kind kind = random.chance(8) ? kRound : kApartments;
      lots.push_back({kind, corner[side], side, width, kDepth});
    }
  }
  lots.push_back({kTrees, {-14, -9, 0}, 0, 28, 18});
  if (random.chance(50)) lots.push_back({kShed, {-4, -3, 0}, 0, random.metres(5, 8), 5});
}

void plan_downtown(Random& random, std::vector<Lot>& lots) {
  for (double x : {-29.0, 3.0}) {
    for (double y : {-23.0, 3.0}) {
      const Kind kind = random.chance(70) ? kOffice : random.chance(50) ? kRound : kApartments;
      const double width = random.metres(17, 25), depth = random.metres(14, 19);
      lots.push_back({kind, {x, y, 0}, 0, width, depth});
    }
  }
}

void plan_houses(Random& random, std::vector<Lot>& lots) {
  constexpr int kPlots = 4;
  constexpr double kPlot = kBlockWidth / kPlots;
  for (int row = 0; row < 2; ++row) {
    for (int i = 0; i < kPlots; ++i) {
      const double left = -kBlockWidth / 2 + i * kPlot;
      const double width = random.metres(8, 11.5), depth = random.metres(7, 9.6);
      const double x = left + 2.5, y = -kBlockDepth / 2 + random.metres(4.5, 7);
      const Vec3d corner = row == 0 ? Vec3d{x, y, 0} : Vec3d{-x, -y, 0};
      lots.push_back({kHouse, corner, 2 * row, width, depth, random.chance(15)});
      const Vec3d garden = row == 0 ? Vec3d{left + 2, -9, 0} : Vec3d{-left - 2, 9, 0};
      lots.push_back({kTrees, garden, 2 * row, 12, 8});
      if (!random.chance(25)) continue;
      const Vec3d shed = row == 0 ? Vec3d{left + 9, -7, 0} : Vec3d{-left - 9, 7, 0};
      lots.push_back({kShed, shed, 2 * row, random.metres(3, 5), random.metres(3, 5)});
    }
  }
}

void plan_park(Random& random, std::vector<Lot>& lots) {
  lots.push_back({random.chance(50) ? kRotunda : kMonument, {-9, -9, 0}, 0, 18, 18});
  lots.push_back({kArcade, {-25, 15, 0}, 0, random.metres(30, 48), 4});
  for (int i = 0; i < 8; ++i) {
    const double x = i % 4 < 2 ? -28 + 12 * (i % 2) : 12 + 8 * (i % 2);
    lots.push_back({kTrees, {x, i < 4 ? -22.0 : 2.0, 0}, 0, 8, 16});
  }
}

void plan_church(Random& random, std::vector<Lot>& lots) {
  lots.push_back({kChurch, {-20, -6, 0}, random.chance(50) ? 0 : 2, 40, 13});
  if (lots.back().quarter_turns == 2) lots.back().corner = {20, 6, 0};
  for (double y : {-22.0, 14.0}) {
    for (double x : {-28.0, -8.0, 12.0}) lots.push_back({kTrees, {x, y, 0}, 0, 14, 8});
  }
}

void plan_industry(Random& random, std::vector<Lot>& lots) {
  lots.push_back({kHall, {-29, -23, 0}, 0, random.metres(30, 44), random.metres(18, 24)});
  lots.push_back({kHall, {29, 23, 0}, 2, random.metres(22, 33), random.metres(12, 16)});
  lots.push_back({kWater, {18, -22, 0}, 0, 10, 10});
  lots.push_back({kShed, {-27, 8, 0}, 0, random.metres(6, 10), random.metres(6, 9)});
  lots.push_back({kTrees, {-14, 8, 0}, 0, 8, 14});
}

struct BlockKind {
  void (*plan)(Random&, std::vector<Lot>&);
  bool green;
  std::array<int, 3> share;  // percent in the inner, middle and outer rings
};
constexpr BlockKind kBlocks[] = {
    {plan_perimeter, false, {40, 10, 3}}, {plan_downtown, false, {20, 2, 1}},
    {plan_houses, true, {22, 65, 78}},    {plan_park, true, {10, 8, 7}},
    {plan_church, true, {4, 5, 4}},       {plan_industry, false, {4, 10, 7}},
};

const BlockKind& choose_block(Random& random, int ring) {
  const std::size_t zone = ring <= 2 ? 0 : ring <= 5 ? 1 : 2;
  int draw = random.between(0, 99);
  for (const BlockKind& kind : kBlocks) {
    draw -= kind.share[zone];
    if (draw < 0) return kind;
  }
  return kBlocks[2];
}

class City {
 public:
  explicit City(const CityOptions& options) : options_(options) {}

  Mesh build() {
    const bool landmark = options_.triangles >= kLandmarkFrom;
    if (landmark) add_centre();
    for (int ring = landmark ? 2 : 0; !full_; ++ring) add_ring(ring);
    add_ground();
    return b_.take();
  }

 private:
  // Rings are squares of blocks, walked around from a corner.
  void add_ring(int ring) {
    outer_ring_ = ring;
    if (ring == 0) return add_block(0, 0, 0);
    for (int k = 0; k < 2 * ring; ++k) {
      add_block(-ring + k, -ring, ring);
      add_block(ring, -ring + k, ring);
      add_block(ring - k, ring, ring);
      add_block(-ring, ring - k, ring);
    }
  }

  void add_block(int i, int j, int ring) {
    if (full_) return;
    const Vec3d middle{i * (kBlockWidth + kStreet), j * (kBlockDepth + kStreet), 0};
    Random random(options_.seed, next_stream_++);
    const BlockKind& kind = choose_block(random, ring);
    add_pavement(middle, kBlockWidth / 2, kBlockDepth / 2, kind.green);
    std::vector<Lot> lots;
    kind.plan(random, lots);
    for (const Lot& lot : lots) add_lot(middle, lot);
  }

  void add_pavement(const Vec3d& middle, double half_width, double half_depth, bool green) {
    b_.begin_part("block " + std::to_string(++block_count_));
    b_.place({.origin = middle});
    b_.coat(Coat::Stone);
    add_box(b_, {-half_width, -half_depth, 0}, {half_width, half_depth, kKerb}, 16);
    if (!green) return;
    b_.coat(Coat::Grass);
    add_box(b_, {-half_width + 2, -half_depth + 2, kKerb},
            {half_width - 2, half_depth - 2, kKerb + 0.05}, 16);
  }

  // What does not fit into the triangles that are left gives way to something smaller.
  void add_lot(const Vec3d& middle, const Lot& lot) {
    if (full_) return;
    Random random(options_.seed, next_stream_++);
    Site site = Site{.origin = middle}.at(lot.corner + Vec3d{0, 0, kKerb}, lot.quarter_turns);
    if (lot.turned) {
      site.origin = site.point({lot.width * 0.25, 0, 0});
      const double c = site.cosine, s = site.sine;
      site.cosine = c * kPythagoreanCosine - s * kPythagoreanSine;
      site.sine = s * kPythagoreanCosine + c * kPythagoreanSine;
    }
    for (const Kind& kind : {lot.kind, kHouse, kShed}) {
      if (kind.add == add_house && lot.width < 7) continue;
      const ModelBuilder::Mark mark = b_.mark();
      b_.begin_part(std::string(kind.name) + " " + std::to_string(++building_count_));
      b_.place(site);
      kind.add(b_, random, std::min(lot.width, kind.add == add_shed ? 8.0 : lot.width),
               std::min(lot.depth, kind.add == lot.kind.add ? lot.depth : 9.0));
      if (b_.triangle_count() <= options_.triangles + options_.triangles / 100) {
        full_ = b_.triangle_count() + options_.triangles / 200 >= options_.triangles;
        return;
      }
      b_.take_back(mark);
      --building_count_;
    }
    full_ = true;
  }

  // The inner nine blocks.
  void add_centre() {
    constexpr double kX = 1.5 * kBlockWidth + kStreet, kY = 1.5 * kBlockDepth + kStreet;
    add_pavement({}, kX, kY, false);
    Random random(options_.seed, next_stream_++);
    b_.begin_part("cathedral");
    b_.place({.origin = {0, 0, kKerb}});
    add_landmark(b_, random);
    for (double x : {-1.0, 1.0}) {
      for (double y : {-1.0, 1.0}) {
        add_lot({}, {x * y > 0 ? kRotunda : kMonument, {x * 88 - 8, y * 68 - 8, 0}, 0, 16, 16});
      }
      for (int i = -4; i <= 4; ++i) {
        add_lot({}, {kTrees, {x * 86 - 4, i * 12.0 - 6, 0}, 0, 8, 12});
        add_lot({}, {kTrees, {i * 16.0 - 8, x * 68 - 4, 0}, 0, 16, 8});
      }
    }
  }

  void add_ground() {
    const double x = (outer_ring_ + 0.5) * (kBlockWidth + kStreet) + kStreet;
    const double y = (outer_ring_ + 0.5) * (kBlockDepth + kStreet) + kStreet;
    b_.begin_part("ground");
    b_.begin_body();
    b_.place({});
    b_.coat(Coat::Asphalt);
    b_.quad({Vec3d{-x, -y, 0}, Vec3d{x, -y, 0}, Vec3d{x, y, 0}, Vec3d{-x, y, 0}},
            b_.normal({0, 0, 1}));
  }

  CityOptions options_;
  ModelBuilder b_;
  std::uint64_t next_stream_ = 1;
  int block_count_ = 0, building_count_ = 0, outer_ring_ = 0;
  bool full_ = false;
};

}  // namespace

Mesh generate_city(const CityOptions& options) {
  return City(options).build();
}

}  // namespace crease
