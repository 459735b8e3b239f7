#include "generate/shapes.h"

#include <algorithm>
#include <cmath>

namespace crease {

namespace {

constexpr Vec3d kUp{0, 0, 1};

}  // namespace

void add_box(ModelBuilder& b, const Vec3d& low, const Vec3d& high, double cell) {
  b.begin_body();
  int cells[3];
  for (int axis = 0; axis < 3; ++axis) {
    cells[axis] = cell > 0 ? std::max(1, int((high[axis] - low[axis]) / cell + 0.5)) : 1;
  }
  // All sides take their points from one lattice, so that they round alike.
  const auto lattice = [&](const int(&at)[3]) {
    Vec3d p;
    for (int axis = 0; axis < 3; ++axis) {
      p[axis] = on_grid(low[axis] + (high[axis] - low[axis]) * at[axis] / cells[axis]);
    }
    return p;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (int end = 0; end < 2; ++end) {
      // u x v is the axis: seen from its far end, u runs right and v up; from the near end, v and
      // u.
      const int u = (axis + (end == 1 ? 1 : 2)) % 3, v = (axis + (end == 1 ? 2 : 1)) % 3;
      Vec3d outwards;
      outwards[axis] = end == 1 ? 1 : -1;
      b.patch(cells[u], cells[v], b.normal(outwards), [&](int i, int j) {
        int at[3];
        at[axis] = end * cells[axis];
        at[u] = i;
        at[v] = j;
        return lattice(at);
      });
    }
  }
}

LatheStrip straight_strip(double radius0, double z0, double radius1, double z1, int rows) {
  LatheStrip strip;
  for (int j = 0; j <= rows; ++j) {
    const double t = double(j) / rows;
    strip.push_back(
        {radius0 + (radius1 - radius0) * t, z0 + (z1 - z0) * t, z1 - z0, radius0 - radius1});
  }
  return strip;
}

LatheStrip dome_strip(double radius, double z0, double height, int rows) {
  LatheStrip strip;
  for (int j = 0; j <= rows; ++j) {
    const Vec3d p = on_circle(j, 4 * rows);
    strip.push_back({radius * p.x, z0 + height * p.y, p.x * height, p.y * radius});
  }
  return strip;
}

void add_lathe(ModelBuilder& b, const Vec3d& centre, int segments,
               const std::vector<LatheStrip>& strips) {
  b.begin_body();
  for (const LatheStrip& strip : strips) {
    const auto at = [&](int j) { return strip[std::size_t(j)]; };
    const auto point = [&](int i, int j) {
      const Vec3d p = on_circle(i % segments, segments) * at(j).radius;
      return centre + Vec3d{p.x, p.y, at(j).z};
    };
    const int rows = int(strip.size()) - 1;
    const bool flat =
        std::all_of(strip.begin(), strip.end(), [](const LathePoint& p) { return p.out == 0; });
    if (flat) {
      b.patch(segments, rows, b.normal(kUp * at(0).up), point);
      continue;
    }
    const auto normal = [&](double i, int j) {
      return on_circle(i, segments) * at(j).out + kUp * at(j).up;
    };
    // A tip: the side's normals do not meet there, so each triangle has its own.
    const bool tip = at(rows).radius == 0 && at(rows).out != 0;
    const std::vector<AttributeId> rim =
        b.smooth_patch(segments, tip ? rows - 1 : rows, point,
                       [&](int i, int j) { return normal(i % segments, j); });
    if (!tip) continue;
    for (int i = 0; i < segments; ++i) {
      b.triangle({b.vertex(point(i, rows - 1)), b.vertex(point(i + 1, rows - 1)),
                  b.vertex(point(0, rows))},
                 {rim[std::size_t(i)], rim[std::size_t(i + 1)], b.normal(normal(i + 0.5, rows))});
    }
  }
}

void add_cylinder(ModelBuilder& b, const Vec3d& centre, double radius, double height, int segments,
                  int rows) {
  add_lathe(b, centre, segments,
            {straight_strip(0, 0, radius, 0), straight_strip(radius, 0, radius, height, rows),
             straight_strip(radius, height, 0, height)});
}

void add_dome(ModelBuilder& b, const Vec3d& centre, double radius, double height, int segments) {
  add_lathe(b, centre, segments,
            {straight_strip(0, 0, radius, 0), dome_strip(radius, 0, height, segments / 4)});
}

void add_cone(ModelBuilder& b, const Vec3d& centre, double radius, double height, int segments,
              int rows) {
  add_lathe(b, centre, segments,
            {straight_strip(0, 0, radius, 0), straight_strip(radius, 0, 0, height, rows)});
}

void add_column(ModelBuilder& b, const Vec3d& foot, double radius, double height, int segments) {
  const double plinth = radius * 1.4, low = height * 0.08, high = height * 0.92;
  add_lathe(
      b, foot, segments,
      {straight_strip(0, 0, plinth, 0), straight_strip(plinth, 0, plinth, low),
       straight_strip(plinth, low, radius, low),
       straight_strip(radius, low, radius * 0.85, high, 2),
       straight_strip(radius * 0.85, high, plinth, high),
       straight_strip(plinth, high, plinth, height), straight_strip(plinth, height, 0, height)});
}

void add_gable_roof(ModelBuilder& b, const GableRoof& roof) {
  b.begin_body();
  const double run = on_grid((roof.depth / 2 + roof.overhang) / roof.rows);
  const double rise = on_grid(roof.rise / roof.rows);
  const double middle = roof.low.y + roof.depth / 2;
  const double left = roof.low.x - roof.overhang, right = roof.low.x + roof.width + roof.overhang;
  const int columns = std::max(2, int((right - left) / 2.5));
  const auto x = [&](int i) { return on_grid(left + (right - left) * i / columns); };
  const auto front = [&](double at, int j) {
    return Vec3d{at, on_grid(middle - run * (roof.rows - j)), roof.low.z + rise * j};
  };
  const auto back = [&](double at, int j) {
    return Vec3d{at, on_grid(middle + run * (roof.rows - j)), roof.low.z + rise * j};
  };
  b.coat(roof.roof);
  b.patch(columns, roof.rows, b.normal({0, -rise, run}),
          [&](int i, int j) { return front(x(i), j); });
  b.patch(columns, roof.rows, b.normal({0, rise, run}),
          [&](int i, int j) { return back(x(columns - i), j); });

  b.coat(roof.gable);
  std::vector<Vec3d> gable;  // of the right side, counter-clockwise
  for (int j = 0; j < roof.rows; ++j) gable.push_back(back(right, j));
  for (int j = roof.rows; j >= 0; --j) gable.push_back(front(right, j));
  b.fan(gable, {1, 0, 0});
  std::reverse(gable.begin(), gable.end());
  for (Vec3d& p : gable) p.x = left;
  b.fan(gable, {-1, 0, 0});

  b.coat(Coat::Wood);
  std::vector<Vec3d> below;
  for (int i = 0; i <= columns; ++i) below.push_back(back(x(i), 0));
  for (int i = columns; i >= 0; --i) below.push_back(front(x(i), 0));
  b.fan(below, -kUp);
}

void add_barrel_roof(ModelBuilder& b, const Vec3d& low, double width, double depth, int segments,
                     Coat roof, Coat ends) {
  b.begin_body();
  const int columns = std::max(2, int(width / 3));
  const double radius = depth / 2, middle = low.y + radius;
  const auto point = [&](double x, int j) {
    const Vec3d p = on_circle(j, 2 * segments) * radius;
    return Vec3d{x, on_grid(middle - p.x), on_grid(low.z + p.y)};
  };
  const auto x = [&](int i) { return on_grid(low.x + width * i / columns); };
  b.coat(roof);
  b.smooth_patch(
      columns, segments, [&](int i, int j) { return point(x(i), j); },
      [&](int, int j) {
        const Vec3d p = on_circle(j, 2 * segments);
        return Vec3d{0, -p.x, p.y};
      });
  b.coat(ends);
  std::vector<Vec3d> end;
  for (int j = 0; j <= segments; ++j) end.push_back(point(low.x, j));
  b.fan(end, {-1, 0, 0});
  std::reverse(end.begin(), end.end());
  for (Vec3d& p : end) p.x = x(columns);
  b.fan(end, {1, 0, 0});
  std::vector<Vec3d> below;
  for (int i = 0; i <= columns; ++i) below.push_back(point(x(i), segments));
  for (int i = columns; i >= 0; --i) below.push_back(point(x(i), 0));
  b.fan(below, -kUp);
}

//   o---------o    The faces run between the opening's outline and the wall's, point by point;
//   | \  .  / |    where the outer outline turns, a triangle fills its corner.
//   o--.   .--o
//   |  |   |  |
//   o--o   o--o
void add_arch(ModelBuilder& b, const Arch& arch) {
  b.begin_body();
  const double half = arch.width / 2, radius = arch.opening / 2, above = arch.height - arch.spring;
  struct Outline {
    double x, z;
  };
  std::vector<Outline> inner, outer;
  inner.push_back({radius, 0});
  outer.push_back({half, 0});
  for (int k = 0; k <= arch.segments; ++k) {  // from the right to the left
    const Vec3d p = on_circle(k, 2 * arch.segments);
    inner.push_back({radius * p.x, arch.spring + radius * p.y});
    const double to_side = half / std::max(std::abs(p.x), 1e-9);
    const double to_top = above / std::max(p.y, 1e-9);
    const double reach = std::min(to_side, to_top);
    outer.push_back({reach * p.x, arch.spring + reach * p.y});
  }
  inner.push_back({-radius, 0});
  outer.push_back({-half, 0});
  const double middle = arch.low.x + half;
  const auto at = [&](const Outline& p, double y) {
    return Vec3d{on_grid(middle + p.x), arch.low.y + y, on_grid(arch.low.z + p.z)};
  };
  const std::size_t count = inner.size();
  const double back = arch.thickness;
  const auto on_top = [&](const Outline& p) { return p.z > arch.height - 0.001; };

  b.coat(arch.coat);
  const AttributeId front_normal = b.normal({0, -1, 0}), back_normal = b.normal({0, 1, 0});
  const AttributeId side_normal[3] = {b.normal({1, 0, 0}), b.normal(kUp), b.normal({-1, 0, 0})};
  const auto outside = [&](const Outline& p, const Outline& q, AttributeId n) {
    b.quad({at(p, 0), at(p, back), at(q, back), at(q, 0)}, n);
  };
  for (std::size_t k = 0; k + 1 < count; ++k) {
    const Outline &p = outer[k], &q = outer[k + 1], &r = inner[k + 1], &s = inner[k];
    b.quad({at(s, 0), at(p, 0), at(q, 0), at(r, 0)}, front_normal);
    b.quad({at(p, back), at(s, back), at(r, back), at(q, back)}, back_normal);
    const bool left = k >= count / 2;
    if (on_top(p) == on_top(q)) {
      outside(p, q, on_top(p) ? side_normal[1] : left ? side_normal[2] : side_normal[0]);
      continue;
    }
    const Outline corner{on_top(p) ? -half : half, arch.height};
    b.quad({at(p, 0), at(corner, 0), at(q, 0), at(q, 0)}, front_normal);
    b.quad({at(q, back), at(corner, back), at(p, back), at(p, back)}, back_normal);
    outside(p, corner, on_top(p) ? side_normal[1] : side_normal[0]);
    outside(corner, q, on_top(q) ? side_normal[1] : side_normal[2]);
  }
  b.smooth_patch(
      int(count) - 1, 1,
      [&](int i, int j) { return at(inner[count - 1 - std::size_t(i)], j == 0 ? back : 0); },
      [&](int i, int) {
        const int k = std::clamp(int(count) - 2 - i, 0, arch.segments);
        const Vec3d p = on_circle(k, 2 * arch.segments);
        return Vec3d{-p.x, 0, -p.y};
      });
  const AttributeId down = b.normal(-kUp);
  const Outline feet[2][2] = {{inner[0], outer[0]}, {outer[count - 1], inner[count - 1]}};
  for (const auto& [from, to] : feet) {
    b.quad({at(from, back), at(to, back), at(to, 0), at(from, 0)}, down);
  }
}

void add_stairs(ModelBuilder& b, const Vec3d& low, double width, int steps, double tread,
                double rise) {
  b.begin_body();
  const auto at = [&](double x, int y, int z) {
    return on_grid(low + Vec3d{x, y * tread, z * rise});
  };
  b.coat(Coat::Stone);
  std::vector<Vec3d> profile{at(width, steps, 0)};  // seen from the right, clockwise
  for (int i = 0; i < steps; ++i) {
    const AttributeId front = b.normal({0, -1, 0}), up = b.normal(kUp);
    b.quad({at(0, i, i), at(width, i, i), at(width, i, i + 1), at(0, i, i + 1)}, front);
    b.quad({at(0, i, i + 1), at(width, i, i + 1), at(width, i + 1, i + 1), at(0, i + 1, i + 1)},
           up);
    profile.push_back(at(width, i, i));
    profile.push_back(at(width, i, i + 1));
  }
  profile.push_back(at(width, steps, steps));
  // The foot of the highest step sees all of the profile; triangles along its own two edges would
  // have no area.
  for (double x : {width, 0.0}) {
    for (Vec3d& p : profile) p.x = low.x + x;
    const AttributeId n = b.normal({x > 0 ? 1.0 : -1.0, 0, 0});
    for (std::size_t i = 1; i + 1 < profile.size(); ++i) {
      const Vec3d& p = profile[x > 0 ? i + 1 : i];
      const Vec3d& q = profile[x > 0 ? i : i + 1];
      b.triangle({b.vertex(profile[0]), b.vertex(p), b.vertex(q)}, {n, n, n});
    }
  }
  b.flat_quad({at(width, steps, 0), at(0, steps, 0), at(0, steps, steps), at(width, steps, steps)});
  b.flat_quad({at(0, steps, 0), at(width, steps, 0), at(width, 0, 0), at(0, 0, 0)});
}

void add_spire(ModelBuilder& b, const Vec3d& centre, double radius, double height, int sides) {
  b.begin_body();
  std::vector<Vec3d> rim;
  for (int i = 0; i < sides; ++i) rim.push_back(centre + on_circle(i + 0.5, sides) * radius);
  const Vec3d tip = centre + kUp * height;
  for (int i = 0; i < sides; ++i) {
    b.flat_quad({rim[std::size_t(i)], rim[std::size_t((i + 1) % sides)], tip, tip});
  }
  std::reverse(rim.begin(), rim.end());
  b.fan(rim, centre, -kUp);
}

void add_balcony(ModelBuilder& b, const Vec3d& low, double width, double depth, int posts) {
  constexpr double kSlab = 0.2, kRail = 0.06, kHeight = 1.0;
  b.coat(Coat::Stone);
  add_box(b, low - Vec3d{0, depth, 0}, low + Vec3d{width, 0, kSlab});
  b.coat(Coat::Metal);
  const double front = low.y - depth + 0.05, bottom = low.z + kSlab, top = bottom + kHeight;
  add_box(b, {low.x, front, top}, {low.x + width, front + kRail, top + kRail});
  for (int i = 0; i < posts; ++i) {
    const double x = on_grid(low.x + (width - kRail) * i / (posts - 1));
    add_box(b, {x, front, bottom}, {on_grid(x + kRail), front + kRail, top});
  }
}

// Vertical walls through few points: each is a plane whatever the rounding.
void add_crenels(ModelBuilder& b, const Vec3d& centre, double outer, double inner, double height,
                 int merlons) {
  const int n = 2 * merlons;
  for (int k = 0; k < n; k += 2) {
    b.begin_body();
    const auto at = [&](int i, double radius, double z) {
      const Vec3d p = on_circle(k + i, n) * radius;
      return centre + Vec3d{p.x, p.y, z};
    };
    b.flat_quad({at(0, outer, 0), at(1, outer, 0), at(1, outer, height), at(0, outer, height)});
    b.flat_quad({at(1, inner, 0), at(0, inner, 0), at(0, inner, height), at(1, inner, height)});
    b.flat_quad({at(0, inner, 0), at(0, outer, 0), at(0, outer, height), at(0, inner, height)});
    b.flat_quad({at(1, outer, 0), at(1, inner, 0), at(1, inner, height), at(1, outer, height)});
    b.flat_quad(
        {at(0, outer, height), at(1, outer, height), at(1, inner, height), at(0, inner, height)});
    b.flat_quad({at(0, inner, 0), at(1, inner, 0), at(1, outer, 0), at(0, outer, 0)});
  }
}

void add_tree(ModelBuilder& b, const Vec3d& foot, double height, bool conifer) {
  b.coat(Coat::Wood);
  add_cylinder(b, foot, 0.2, height * 0.4, 6);
  b.coat(Coat::Leaves);
  const double radius = height * (conifer ? 0.22 : 0.28);
  if (conifer) {
    add_cone(b, foot + kUp * on_grid(height * 0.25), radius, height * 0.75, 10, 2);
    return;
  }
  LatheStrip crown;
  constexpr int kRows = 4;
  for (int j = 0; j <= kRows; ++j) {
    const Vec3d p = on_circle(j, 2 * kRows);  // from the bottom pole to the top
    crown.push_back({radius * p.y, radius * 1.1 * (1 - p.x), p.y * 1.1, -p.x});
  }
  add_lathe(b, foot + kUp * on_grid(height * 0.35), 8, {crown});
}

}  // namespace crease
