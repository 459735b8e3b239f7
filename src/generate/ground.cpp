#include "generate/ground.h"

#include <algorithm>
#include <vector>

namespace crease {

namespace {

constexpr double kWaterLevel = -3.5, kBottom = -9;

// Between the middles of the streets around block i.
double cell_low(const StreetAxis& axis, int i) {
  return on_grid(axis.at(i).low - axis.street_after(i - 1) / 2);
}

struct Row {
  double low, high;
  int block;
  bool river;
};

bool has_river(const BlockRange& range) {
  return range.low_y - 1 <= kRiverAfter && range.high_y + 1 > kRiverAfter;
}

}  // namespace

void BlockRange::add(int i, int j) {
  if (empty) *this = {i, i, j, j, false};
  low_x = std::min(low_x, i);
  high_x = std::max(high_x, i);
  low_y = std::min(low_y, j);
  high_y = std::max(high_y, j);
}

std::size_t ground_triangle_count(const BlockRange& range) {
  const bool river = has_river(range);
  const int columns = range.high_x - range.low_x + 3, blocks = range.high_y - range.low_y + 3;
  const int rows = blocks + river;
  // Tops, quays, two rows of sides of which the river lacks the upper one, the bottom.
  return std::size_t(2 * columns * rows + (river ? 4 * columns - 4 : 0) + 4 * 2 * (columns + rows) +
                     2 * (columns + rows));
}

void add_ground(ModelBuilder& b, const StreetGrid& grid, const BlockRange& range,
                const std::function<Coat(int i, int j)>& coat_of) {
  b.begin_part("ground");
  b.begin_body();
  b.place({});
  std::vector<double> x;
  for (int i = range.low_x - 1; i <= range.high_x + 2; ++i) x.push_back(cell_low(grid.x, i));
  std::vector<Row> rows;
  for (int j = range.low_y - 1; j <= range.high_y + 1; ++j) {
    Row row{cell_low(grid.y, j), cell_low(grid.y, j + 1), j, false};
    if (j == kRiverAfter) row.high = grid.river_low;
    if (j == kRiverAfter + 1) row.low = grid.river_high;
    rows.push_back(row);
    if (j == kRiverAfter && has_river(range)) {
      rows.push_back({grid.river_low, grid.river_high, j, true});
    }
  }
  const std::size_t columns = x.size() - 1;
  const auto level = [](const Row& row) { return row.river ? kWaterLevel : 0; };

  const AttributeId up = b.normal(kUp), north = b.normal({0, 1, 0}), south = b.normal({0, -1, 0});
  const AttributeId west = b.normal({-1, 0, 0}), east = b.normal({1, 0, 0});
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const Row& row = rows[r];
    const double z = level(row);
    for (std::size_t c = 0; c < columns; ++c) {
      b.coat(row.river ? Coat::Water : coat_of(range.low_x - 1 + int(c), row.block));
      b.quad({Vec3d{x[c], row.low, z}, Vec3d{x[c + 1], row.low, z}, Vec3d{x[c + 1], row.high, z},
              Vec3d{x[c], row.high, z}},
             up);
      if (!row.river) continue;
      b.coat(Coat::Stone);
      b.quad({Vec3d{x[c + 1], row.low, z}, Vec3d{x[c], row.low, z}, Vec3d{x[c], row.low, 0},
              Vec3d{x[c + 1], row.low, 0}},
             north);
      b.quad({Vec3d{x[c], row.high, z}, Vec3d{x[c + 1], row.high, z}, Vec3d{x[c + 1], row.high, 0},
              Vec3d{x[c], row.high, 0}},
             south);
    }
  }

  // The sides, in two rows that part at the water's level, and the bottom.
  b.coat(Coat::Stone);
  std::vector<Vec3d> rim;  // counter-clockwise from above
  for (std::size_t c = 0; c < columns; ++c) rim.push_back({x[c], rows.front().low, 0});
  for (const Row& row : rows) rim.push_back({x[columns], row.low, 0});
  for (std::size_t c = columns; c > 0; --c) rim.push_back({x[c], rows.back().high, 0});
  for (std::size_t r = rows.size(); r > 0; --r) rim.push_back({x[0], rows[r - 1].high, 0});
  const auto side = [&](const Vec3d& p, const Vec3d& q, double low, double high, AttributeId n) {
    b.quad(
        {Vec3d{p.x, p.y, low}, Vec3d{q.x, q.y, low}, Vec3d{q.x, q.y, high}, Vec3d{p.x, p.y, high}},
        n);
  };
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const Vec3d &p = rim[i], &q = rim[(i + 1) % rim.size()];
    const AttributeId n = p.y == q.y ? (q.x > p.x ? south : north) : q.y > p.y ? east : west;
    const bool river = p.x == q.x && std::min(p.y, q.y) == grid.river_low && has_river(range);
    if (!river) side(p, q, kWaterLevel, 0, n);
    side(p, q, kBottom, kWaterLevel, n);
  }
  std::vector<Vec3d> below(rim.rbegin(), rim.rend());
  for (Vec3d& p : below) p.z = kBottom;
  const Vec3d middle{on_grid((x.front() + x.back()) / 2),
                     on_grid((rows.front().low + rows.back().high) / 2), kBottom};
  b.fan(below, middle, -kUp);
}

}  // namespace crease
