#include "generate/walls.h"

#include <algorithm>
#include <cmath>

namespace crease {

namespace {

constexpr Vec3d kAlong[4] = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
constexpr Vec3d kUp{0, 0, 1};

std::vector<double> even_columns(double length, double cell) {
  const int count = std::max(1, int(length / cell + 0.5));
  std::vector<double> columns;
  for (int i = 0; i <= count; ++i) columns.push_back(double(i) / count);
  return columns;
}

// A column for each window and for the wall between two.
std::vector<double> wall_columns(double length, int bays, double window_width) {
  if (bays == 0) return even_columns(length, 3);
  const double bay = length / bays, margin = (bay - window_width) / 2;
  std::vector<double> columns{0};
  for (int i = 0; i < bays; ++i) {
    const double left = on_grid(i * bay + margin);
    columns.push_back(left / length);
    columns.push_back((left + window_width) / length);
  }
  columns.push_back(1);
  return columns;
}

}  // namespace

RingBody::RingBody(ModelBuilder& builder, const Vec3d& low, double width, double depth)
    : b_(builder), low_(low), width_(width), depth_(depth), z_(low.z) {
  b_.begin_body();
  subdivide(3);
}

void RingBody::subdivide(double cell) {
  columns_[0] = even_columns(width_, cell);
  columns_[1] = even_columns(depth_, cell);
}

Vec3d RingBody::corner(int side, double inset) const {
  const double x[] = {inset, width_ - inset, width_ - inset, inset};
  const double y[] = {inset, inset, depth_ - inset, depth_ - inset};
  return {low_.x + x[side % 4], low_.y + y[side % 4], 0};
}

Vec3d RingBody::point(int side, int column, double inset, double z) const {
  // Measured from the left and from below on every side, so that opposite sides that meet in a
  // ridge round to the same points.
  const bool backwards = side >= 2;
  const Vec3d from = corner(backwards ? side + 1 : side, inset);
  const Vec3d to = corner(backwards ? side : side + 1, inset);
  const double t = columns_[std::size_t(side % 2)]
                           [std::size_t(backwards ? column_count(side) - column : column)];
  Vec3d p = on_grid(from + (to - from) * t);
  p.z = z;
  return p;
}

std::vector<Vec3d> RingBody::loop(double inset, double z) const {
  std::vector<Vec3d> points;
  for (int side = 0; side < 4; ++side) {
    for (int i = 0; i < column_count(side); ++i) points.push_back(point(side, i, inset, z));
  }
  return points;
}

// The wall is a grid of cells; some cells lie deeper, and where a deep one meets one that is not,
// there is a reveal.
void RingBody::wall(int side, const WallStyle& style) {
  const Vec3d along = kAlong[side], outwards = cross(along, kUp);
  const double length = side % 2 == 0 ? width_ : depth_;
  const int bays = side % 2 == 0 ? style.bays_front : style.bays_side;
  const bool windows = bays > 0 && (side != 2 || style.back_windows);

  std::vector<double>& columns = columns_[std::size_t(side % 2)];
  if (side < 2) columns = wall_columns(length, bays, style.window_width);
  std::vector<double> x, z{low_.z};
  for (double t : columns) x.push_back(on_grid(t * length));
  if (side >= 2) {
    std::reverse(x.begin(), x.end());
    for (double& at : x) at = on_grid(length - at);
  }
  for (int floor = 0; floor < style.floors; ++floor) {
    const double base = low_.z + floor * style.floor_height;
    z.push_back(base + style.sill);
    z.push_back(base + style.sill + style.window_height);
  }
  z.push_back(low_.z + style.floors * style.floor_height);

  const int columns_here = int(x.size()) - 1, row_count = int(z.size()) - 1;
  const int door_column = 2 * (bays / 2) + 1;
  const auto is_deep = [&](int i, int j) {
    if (!windows || i < 0 || j < 0 || i >= columns_here || j >= row_count) return false;
    if (side == 0 && style.shop && j < 2) return i > 0 && i + 1 < columns_here && j == 1;
    if (side == 0 && style.door && j == 0) return i == door_column;
    return i % 2 == 1 && j % 2 == 1;
  };
  const Vec3d from = corner(side, 0);
  const auto at = [&](int i, int j, double deep) {
    Vec3d p = from + along * x[std::size_t(i)] - outwards * deep;
    p.z = z[std::size_t(j)];
    return p;
  };

  const AttributeId front = b_.normal(outwards);
  AttributeId glass = front, right{}, left{}, up{}, down{};
  if (windows) {
    glass = b_.normal(outwards);
    right = b_.normal(along);
    left = b_.normal(-along);
    up = b_.normal(kUp);
    down = b_.normal(-kUp);
  }
  const double d = style.depth;
  for (int j = 0; j < row_count; ++j) {
    for (int i = 0; i < columns_here; ++i) {
      if (!is_deep(i, j)) {
        b_.coat(style.coat);
        b_.quad({at(i, j, 0), at(i + 1, j, 0), at(i + 1, j + 1, 0), at(i, j + 1, 0)}, front);
        continue;
      }
      const bool door = side == 0 && style.door && !style.shop && i == door_column && j < 2;
      b_.coat(door ? Coat::Wood : Coat::Glass);
      b_.quad({at(i, j, d), at(i + 1, j, d), at(i + 1, j + 1, d), at(i, j + 1, d)}, glass);
      b_.coat(Coat::Stone);
      if (!is_deep(i - 1, j)) {
        b_.quad({at(i, j, 0), at(i, j, d), at(i, j + 1, d), at(i, j + 1, 0)}, right);
      }
      if (!is_deep(i + 1, j)) {
        b_.quad({at(i + 1, j, d), at(i + 1, j, 0), at(i + 1, j + 1, 0), at(i + 1, j + 1, d)}, left);
      }
      if (!is_deep(i, j - 1)) {
        b_.quad({at(i, j, 0), at(i + 1, j, 0), at(i + 1, j, d), at(i, j, d)}, up);
      }
      if (!is_deep(i, j + 1)) {
        b_.quad({at(i, j + 1, d), at(i + 1, j + 1, d), at(i + 1, j + 1, 0), at(i, j + 1, 0)}, down);
      }
    }
  }
}

void RingBody::walls(const WallStyle& style) {
  for (int side = 0; side < 4; ++side) wall(side, style);
  floor(Coat::Stone);
  z_ = on_grid(low_.z + style.floors * style.floor_height);
}

void RingBody::floor(Coat coat) {
  std::vector<Vec3d> below = loop(inset_, z_);
  std::reverse(below.begin(), below.end());
  b_.coat(coat);
  b_.fan(below, -kUp);
}

void RingBody::ring(const RingStage& stage) {
  const double inset_step = on_grid(stage.inset / stage.rows);
  const double rise_step = on_grid(stage.rise / stage.rows);
  b_.coat(stage.coat);
  for (int side = 0; side < 4; ++side) {
    const Vec3d inwards = cross(kUp, kAlong[side]);
    const Vec3d facing = cross(kAlong[side], inwards * inset_step + kUp * rise_step);
    b_.patch(column_count(side), stage.rows, b_.normal(facing), [&](int i, int j) {
      return point(side, i, on_grid(inset_ + j * inset_step), on_grid(z_ + j * rise_step));
    });
  }
  inset_ = on_grid(inset_ + stage.rows * inset_step);
  z_ = on_grid(z_ + stage.rows * rise_step);
}

void RingBody::hip(int rows, double rise, Coat coat) {
  const double run = std::min(width_, depth_) / 2 - inset_;
  const auto divides = [&](int count) {
    return std::abs(on_grid(run / count) * count - run) < 1e-6;
  };
  while (rows > 1 && !divides(rows)) --rows;
  ring({.rows = rows, .inset = run, .rise = rise, .coat = coat});
}

void RingBody::close(Coat coat) {
  b_.coat(coat);
  b_.fan(loop(inset_, z_), kUp);
}

}  // namespace crease
