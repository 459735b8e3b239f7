#include "generate/walls.h"

#include <algorithm>
#include <cmath>

namespace crease {

namespace {

constexpr Vec3d kAlong[4] = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};

}  // namespace

RingBody::RingBody(ModelBuilder& builder, const Vec3d& low, double width, double depth)
    : b_(builder), low_(low), width_(width), depth_(depth), z_(low.z) {
  b_.begin_body();
}

Vec3d RingBody::corner(int side, double inset, double z) const {
  const double x[] = {inset, width_ - inset, width_ - inset, inset};
  const double y[] = {inset, inset, depth_ - inset, depth_ - inset};
  return on_grid(Vec3d{low_.x + x[side % 4], low_.y + y[side % 4], z});
}

RingBody::Opening RingBody::opening(int side, int bay, int bays, int floor,
                                    const WallStyle& style) const {
  const double pitch = length_of(side) / bays, middle = (bay + 0.5) * pitch;
  const double base = floor * style.floor_height;
  Opening o{middle - style.window_width / 2, middle + style.window_width / 2, base + style.sill,
            base + style.sill + style.window_height, Coat::Glass};
  if (side == style.front && floor == 0 && style.shop) {
    o.left = middle - pitch / 2 + 0.35;
    o.right = middle + pitch / 2 - 0.35;
    o.bottom = 0.4;
  }
  if (side == style.front && floor == 0 && style.door && bay == bays / 2) {
    o.bottom = 0.15;
    o.coat = Coat::Wood;
  }
  return {on_grid(o.left), on_grid(o.right), on_grid(o.bottom), on_grid(o.top), o.coat};
}

//   o-----------o    What is around the openings falls into strips between the openings of two
//   |\_ _____ _/|    columns, quads between two of one column, and a polygon along each of the
//   | o-o   o-o |    wall's own edges. No corner is added, so that neighbouring walls and the roof
//   | |_|---|_| |    meet in four points whatever the windows are.
//   |/  \___/  \|
//   o-----------o
void RingBody::wall(int side, int bays, const WallStyle& style) {
  const Vec3d along = kAlong[side], outwards = cross(along, kUp);
  const Vec3d from = corner(side, 0, low_.z);
  const double length = length_of(side), low = -style.foundation;
  const double high = style.floors * style.floor_height;
  const auto at = [&](double x, double z, double deep = 0) {
    return on_grid(from + along * x - outwards * deep + kUp * z);
  };
  const AttributeId front = b_.normal(outwards);
  b_.coat(style.coat);
  if (bays == 0)
    return b_.quad({at(0, low), at(length, low), at(length, high), at(0, high)}, front);

  const int floors = style.floors;
  std::vector<Opening> openings;
  for (int i = 0; i < bays; ++i) {
    for (int f = 0; f < floors; ++f) openings.push_back(opening(side, i, bays, f, style));
  }
  const auto opening_at = [&](int i, int f) -> const Opening& {
    return openings[std::size_t(i * floors + f)];
  };
  // Points up along one side of a column of openings.
  const auto column = [&](int i, bool right) {
    std::vector<Vec3d> points;
    for (int f = 0; f < floors; ++f) {
      const Opening& o = opening_at(i, f);
      points.push_back(at(right ? o.right : o.left, o.bottom));
      points.push_back(at(right ? o.right : o.left, o.top));
    }
    return points;
  };

  for (int i = 0; i + 1 < bays; ++i) {
    const std::vector<Vec3d> p = column(i, true), q = column(i + 1, false);
    for (std::size_t k = 0; k + 1 < p.size(); ++k) {
      b_.quad({p[k], q[k], q[k + 1], p[k + 1]}, front);
    }
  }
  for (int i = 0; i < bays; ++i) {
    for (int f = 0; f + 1 < floors; ++f) {
      const Opening &o = opening_at(i, f), &above = opening_at(i, f + 1);
      b_.quad({at(o.left, o.top), at(o.right, o.top), at(above.right, above.bottom),
               at(above.left, above.bottom)},
              front);
    }
  }
  std::vector<Vec3d> left = column(0, false), right = column(bays - 1, true), below, above;
  for (int i = 0; i < bays; ++i) {
    const Opening &lowest = opening_at(i, 0), &highest = opening_at(i, floors - 1);
    below.insert(below.end(), {at(lowest.left, lowest.bottom), at(lowest.right, lowest.bottom)});
    above.insert(above.end(), {at(highest.left, highest.top), at(highest.right, highest.top)});
  }
  std::reverse(right.begin(), right.end());
  std::reverse(below.begin(), below.end());
  const Vec3d corners[] = {at(0, low), at(length, low), at(length, high), at(0, high)};
  below.insert(below.end(), {corners[0], corners[1]});
  right.insert(right.end(), {corners[1], corners[2]});
  above.insert(above.end(), {corners[2], corners[3]});
  left.insert(left.end(), {corners[3], corners[0]});
  for (const std::vector<Vec3d>& border : {below, right, above, left}) b_.polygon(border, outwards);

  const double d = style.deep_all || side == style.front ? style.depth : 0;
  AttributeId facing[4]{};
  if (d > 0) {
    const Vec3d inwards[] = {kUp, -along, -kUp, along};
    for (std::size_t k = 0; k < 4; ++k) facing[k] = b_.normal(inwards[k]);
  }
  const AttributeId pane = d > 0 ? b_.normal(outwards) : front;
  for (const Opening& p : openings) {
    const double x[] = {p.left, p.right, p.right, p.left}, z[] = {p.bottom, p.bottom, p.top, p.top};
    b_.coat(p.coat);
    b_.quad({at(x[0], z[0], d), at(x[1], z[1], d), at(x[2], z[2], d), at(x[3], z[3], d)}, pane);
    if (d == 0) continue;
    b_.coat(Coat::Stone);
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t next = (k + 1) % 4;
      b_.quad({at(x[k], z[k]), at(x[next], z[next]), at(x[next], z[next], d), at(x[k], z[k], d)},
              facing[k]);
    }
  }
}

void RingBody::walls(const WallStyle& style) {
  for (int side = 0; side < 4; ++side) wall(side, style.bays[std::size_t(side)], style);
  z_ = on_grid(low_.z - style.foundation);
  floor(Coat::Stone);
  z_ = on_grid(low_.z + style.floors * style.floor_height);
}

void RingBody::floor(Coat coat) {
  b_.coat(coat);
  b_.quad(
      {corner(3, inset_, z_), corner(2, inset_, z_), corner(1, inset_, z_), corner(0, inset_, z_)},
      b_.normal(-kUp));
}

void RingBody::ring(const RingStage& stage) {
  const double inset = on_grid(inset_ + stage.inset), z = on_grid(z_ + stage.rise);
  b_.coat(stage.coat);
  for (int side = 0; side < 4; ++side) {
    b_.flat_quad({corner(side, inset_, z_), corner(side + 1, inset_, z_),
                  corner(side + 1, inset, z), corner(side, inset, z)});
  }
  inset_ = inset;
  z_ = z;
}

void RingBody::hip(double rise, Coat coat) {
  const double run = std::min(width_, depth_) / 2;
  const double z = on_grid(z_ + rise);
  b_.coat(coat);
  // The inner rectangle has no width: two of its corners are one at each end of the ridge.
  for (int side = 0; side < 4; ++side) {
    const Vec3d p = corner(side, inset_, z_), q = corner(side + 1, inset_, z_);
    Vec3d r = corner(side + 1, run, z), s = corner(side, run, z);
    if (width_ >= depth_) r.y = s.y = on_grid(low_.y + depth_ / 2);
    if (width_ <= depth_) r.x = s.x = on_grid(low_.x + width_ / 2);
    const bool hip_end = (side % 2 == 1) == (width_ >= depth_);
    b_.flat_quad({p, q, hip_end ? s : r, s});
  }
}

void RingBody::gable(const Gable& gable) {
  const double o = gable.overhang, z = z_, ridge_z = on_grid(z_ + gable.rise);
  const double front = low_.y + inset_, back = low_.y + depth_ - inset_;
  const double ends[] = {low_.x + inset_, low_.x + width_ - inset_};
  const double ridge = on_grid(low_.y + depth_ / 2);
  const auto at = [&](int end, double y, double at_z) {
    return on_grid(Vec3d{ends[end], y, at_z});
  };
  b_.coat(gable.roof);
  b_.flat_quad(
      {at(0, front - o, z), at(1, front - o, z), at(1, ridge, ridge_z), at(0, ridge, ridge_z)});
  b_.flat_quad(
      {at(1, back + o, z), at(0, back + o, z), at(0, ridge, ridge_z), at(1, ridge, ridge_z)});
  if (o > 0) {
    b_.coat(Coat::Wood);
    const AttributeId down = b_.normal(-kUp);
    b_.quad({at(0, front, z), at(1, front, z), at(1, front - o, z), at(0, front - o, z)}, down);
    b_.quad({at(1, back, z), at(0, back, z), at(0, back + o, z), at(1, back + o, z)}, down);
  }
  b_.coat(gable.wall);
  for (int end = 0; end < 2; ++end) {
    const AttributeId n = b_.normal({end == 1 ? 1.0 : -1.0, 0, 0});
    const VertexId tip = b_.vertex(at(end, ridge, ridge_z));
    std::vector<double> y{front - o, front, back, back + o};
    if (end == 0) std::reverse(y.begin(), y.end());
    for (std::size_t i = 0; i < 3; ++i) {
      b_.triangle({b_.vertex(at(end, y[i], z)), b_.vertex(at(end, y[i + 1], z)), tip}, {n, n, n});
    }
  }
}

void RingBody::vault(double rise, int segments, Coat roof, Coat ends) {
  const double half = depth_ / 2 - inset_, middle = low_.y + depth_ / 2;
  const double left = low_.x + inset_, right = low_.x + width_ - inset_;
  const auto point = [&](double x, int j) {
    const Vec3d p = on_circle(j, 2 * segments);
    return on_grid(Vec3d{x, middle - half * p.x, z_ + rise * p.y});
  };
  b_.coat(roof);
  b_.smooth_patch(
      1, segments, [&](int i, int j) { return point(i == 0 ? left : right, j); },
      [&](int, int j) {
        const Vec3d p = on_circle(j, 2 * segments);
        return Vec3d{0, -p.x * rise, p.y * half};
      });
  b_.coat(ends);
  for (double x : {left, right}) {
    std::vector<Vec3d> end;
    for (int j = 0; j <= segments; ++j) end.push_back(point(x, j));
    if (x == right) std::reverse(end.begin(), end.end());
    b_.polygon(end, {x == right ? 1.0 : -1.0, 0, 0});
  }
}

void RingBody::close(Coat coat) {
  b_.coat(coat);
  b_.quad(
      {corner(0, inset_, z_), corner(1, inset_, z_), corner(2, inset_, z_), corner(3, inset_, z_)},
      b_.normal(kUp));
}

}  // namespace crease
