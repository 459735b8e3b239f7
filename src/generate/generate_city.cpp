// The plan: blocks of many sizes between streets, avenues and a river, from the landmark in the
// middle outwards until the triangles are used up; dense inside, green outside.
#include "crease/generate.h"

#include "generate/blocks.h"
#include "generate/buildings.h"
#include "generate/ground.h"
#include "generate/shapes.h"
#include "generate/street_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

namespace crease {

namespace {

constexpr double kKerb = 0.15;

// Pavements and lawns lie one in the other. They reach so far down that no simplifier folds their
// sides away while their tops are still apart.
constexpr double kSlabDepth = 3;
constexpr std::size_t kLandmarkFrom = 150'000;  // triangles: a small city has only a church
constexpr double kRoad = 12;
constexpr double kBlockTriangles = 1500;  // rather less than a block has where all is outskirts

struct BlockAt {
  int i, j;
  std::int64_t order;
};

class City {
 public:
  explicit City(const CityOptions& options)
      : options_(options),
        has_landmark_(options.triangles >= kLandmarkFrom),
        last_block_(last_block_for(options.triangles)),
        grid_(make_street_grid(options.seed, last_block_)),
        is_built_(side() * side()) {}

  Mesh build() {
    for (const BlockAt& block : blocks_from_the_middle()) {
      if (full_) break;
      const bool is_centre = std::abs(block.i) <= 1 && std::abs(block.j) <= 1;
      if (has_landmark_ && is_centre) {
        if (range_.empty) add_centre();
      } else {
        add_block(block.i, block.j);
      }
    }
    add_ground(b_, grid_, range_, [&](int i, int j) {
      if (is_built_[block_index(i, j)]) return Coat::Asphalt;
      return stream(i, j).chance(45) ? Coat::Field : Coat::Grass;
    });
    return b_.take();
  }

 private:
  static int last_block_for(std::size_t triangles) {
    const double blocks_along = std::sqrt(double(triangles) / kBlockTriangles);
    return std::max(kLastInnerBlock, int(blocks_along / 2) + 4);
  }
  std::size_t side() const { return std::size_t(2 * last_block_ + 1); }
  std::size_t block_index(int i, int j) const {
    return std::size_t(j + last_block_) * side() + std::size_t(i + last_block_);
  }

  // Random numbers of a block, so that no block moves another, nor do those beyond the inner ones.
  Random stream(int i, int j, int lot = 0) const {
    constexpr int kLast = kLastInnerBlock, kSide = 2 * kLast + 1;
    constexpr std::uint64_t kOuter = std::uint64_t(1) << 40, kRow = 1 << 20;
    const bool is_inner = std::max(std::abs(i), std::abs(j)) <= kLast;
    const std::uint64_t number =
        is_inner ? std::uint64_t((j + kLast) * kSide + i + kLast)
                 : kOuter + std::uint64_t(j) * kRow + std::uint64_t(i);  // modulo 2^64
    return Random(options_.seed, 100 + number + std::uint64_t(lot) * kSide * kSide);
  }

  // In rounded squares, in whole metres; a little out of order, so that the edge of the city frays.
  std::vector<BlockAt> blocks_from_the_middle() const {
    std::vector<BlockAt> blocks;
    for (int j = -last_block_ + 2; j <= last_block_ - 2; ++j) {
      for (int i = -last_block_ + 2; i <= last_block_ - 2; ++i) {
        const std::int64_t x = std::int64_t(grid_.x.at(i).middle());
        const std::int64_t y = std::int64_t(grid_.y.at(j).middle());
        const std::int64_t stretch = stream(i, j, 1).between(85, 118);
        blocks.push_back({i, j, (x * x * x * x + y * y * y * y) * stretch});
      }
    }
    std::ranges::stable_sort(blocks, {}, &BlockAt::order);
    return blocks;
  }

  Zone zone_of(int i, int j) const {
    const double x = grid_.x.at(i).middle(), y = grid_.y.at(j).middle();
    const auto within = [&](double at_x, double at_y, double radius) {
      return (x - at_x) * (x - at_x) + (y - at_y) * (y - at_y) < radius * radius;
    };
    if (within(330, 250, 120)) return Zone::Downtown;
    if (x < -430 && std::abs(y - grid_.river_low) < 100) return Zone::Works;
    if (within(0, 0, 330)) return Zone::OldTown;
    return within(0, 0, 520) ? Zone::Middle : Zone::Outer;
  }

  void build_on(int i, int j) {
    range_.add(i, j);
    is_built_[block_index(i, j)] = true;
  }

  void add_block(int i, int j) {
    const StreetAxis::Block &x = grid_.x.at(i), &y = grid_.y.at(j);
    const double width = x.high - x.low, depth = y.high - y.low;
    build_on(i, j);
    Random random = stream(i, j);
    const BlockPlan plan = plan_block(random, zone_of(i, j), width, depth);
    const Vec3d middle{x.middle(), y.middle(), 0};
    add_pavement(middle, width, depth, plan.green);
    add_lots(i, j, middle, plan.lots);
    if (j != kRiverAfter || !x.avenue_after) return;
    const double road = on_grid(x.high + (grid_.x.street_after(i) - kRoad) / 2);
    add_lot({}, {kBridge, {road, grid_.river_low, 0}, 0, kRoad, grid_.river_high - grid_.river_low},
            stream(i, j, 2));
  }

  // The nine blocks in the middle.
  void add_centre() {
    for (int j = -1; j <= 1; ++j) {
      for (int i = -1; i <= 1; ++i) build_on(i, j);
    }
    const double x = grid_.x.at(1).high, y = grid_.y.at(1).high;
    add_pavement({}, 2 * x, 2 * y, false);
    b_.begin_part("cathedral");
    b_.place({.origin = {0, 0, kKerb}});
    Random random = stream(0, 0);
    add_landmark(b_, random);
    add_lots(0, 0, {}, plan_close(x, y));
  }

  void add_lots(int i, int j, const Vec3d& middle, const std::vector<Lot>& lots) {
    int number = 3;
    for (const Lot& lot : lots) {
      add_lot({.origin = middle + Vec3d{0, 0, kKerb}}, lot, stream(i, j, number++));
    }
  }

  void add_pavement(const Vec3d& middle, double width, double depth, bool green) {
    b_.begin_part("block " + std::to_string(++block_count_));
    b_.place({.origin = middle});
    b_.coat(Coat::Stone);
    const double x = width / 2, y = depth / 2;
    add_box(b_, {-x, -y, -kSlabDepth - 0.5}, {x, y, kKerb});
    if (!green) return;
    b_.coat(Coat::Grass);
    add_box(b_, {-x + 2, -y + 2, -kSlabDepth}, {x - 2, y - 2, kKerb + 0.05});
  }

  std::size_t used_triangle_count() const {
    return b_.triangle_count() + ground_triangle_count(range_);
  }

  // What does not fit into the triangles that are left gives way to something smaller.
  void add_lot(const Site& block, const Lot& lot, const Random& lot_random) {
    if (full_) return;
    Site site = block.at(lot.corner, lot.quarter_turns);
    if (lot.turned) {
      site.origin = site.point({on_grid(lot.width * 0.25), 0, 0});
      const double c = site.cosine, s = site.sine;
      site.cosine = c * kPythagoreanCosine - s * kPythagoreanSine;
      site.sine = s * kPythagoreanCosine + c * kPythagoreanSine;
    }
    for (const BuildingKind& kind : {lot.kind, kHouse, kShed}) {
      if (kind.add == kHouse.add && (lot.width < 7 || lot.depth < 6)) continue;
      Random random = lot_random;
      const ModelBuilder::Mark mark = b_.mark();
      b_.begin_part(std::string(kind.name) + " " + std::to_string(++building_count_));
      b_.place(site);
      kind.add(b_, random, std::min(lot.width, kind.add == kShed.add ? 8.0 : lot.width),
               std::min(lot.depth, kind.add == lot.kind.add ? lot.depth : 9.0));
      if (used_triangle_count() <= options_.triangles + options_.triangles / 100) {
        full_ = used_triangle_count() + options_.triangles / 200 >= options_.triangles;
        return;
      }
      b_.take_back(mark);
      --building_count_;
      if (kind.add == kBridge.add) return;
    }
    full_ = true;
  }

  CityOptions options_;
  bool has_landmark_;
  int last_block_;
  StreetGrid grid_;
  ModelBuilder b_;
  BlockRange range_;
  std::vector<bool> is_built_;  // by block_index()
  int block_count_ = 0, building_count_ = 0;
  bool full_ = false;
};

}  // namespace

Mesh generate_city(const CityOptions& options) {
  Mesh city = City({options.seed, std::min(options.triangles, CityOptions::kMost)}).build();
  city.up = UpAxis::Z;
  return city;
}

}  // namespace crease
