#include "generate/shapes.h"

#include <algorithm>
#include <cmath>

namespace crease {

namespace {}  // namespace

void add_box(ModelBuilder& b, const Vec3d& low, const Vec3d& high) {
  b.begin_body();
  for (int axis = 0; axis < 3; ++axis) {
    for (int end = 0; end < 2; ++end) {
      // u x v is the axis: seen from its far end, u runs right and v up; from the near end, v and
      // u.
      const int u = (axis + (end == 1 ? 1 : 2)) % 3, v = (axis + (end == 1 ? 2 : 1)) % 3;
      const auto at = [&](bool right, bool up) {
        Vec3d p = low;
        p[axis] = end == 1 ? high[axis] : low[axis];
        if (right) p[u] = high[u];
        if (up) p[v] = high[v];
        return on_grid(p);
      };
      Vec3d outwards;
      outwards[axis] = end == 1 ? 1 : -1;
      b.quad({at(false, false), at(true, false), at(true, true), at(false, true)},
             b.normal(outwards));
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

LatheStrip dome_strip(double radius, double z0, double height, int rows, double lantern) {
  LatheStrip strip;
  const auto add = [&](const Vec3d& p) {
    strip.push_back({radius * p.x, z0 + height * p.y, p.x * height, p.y * radius});
  };
  for (int j = 0; j <= rows; ++j) {
    const Vec3d p = on_circle(j, 4 * rows);
    if (lantern == 0 || radius * p.x > 1.2 * lantern) add(p);
  }
  const double x = lantern / radius;
  if (lantern > 0) add({x, std::sqrt(1 - x * x), 0});
  return strip;
}

void add_lathe(ModelBuilder& b, const Vec3d& centre, int segments,
               const std::vector<LatheStrip>& strips, const std::vector<Coat>& coats) {
  b.begin_body();
  for (std::size_t s = 0; s < strips.size(); ++s) {
    const LatheStrip& strip = strips[s];
    if (!coats.empty()) b.coat(coats[s]);
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
    const auto is_tip = [&](int j) { return at(j).radius == 0 && at(j).out != 0; };
    const int first = is_tip(0) ? 1 : 0, last = is_tip(rows) ? rows - 1 : rows;
    const auto normals_of = [&](int j) {
      std::vector<AttributeId> normals;
      for (int i = 0; i < segments; ++i) normals.push_back(b.normal(normal(i, j)));
      return normals;
    };
    ModelBuilder::RimNormals rim;
    if (first < last) {
      rim = b.smooth_patch(
          segments, last - first, [&](int i, int j) { return point(i, j + first); },
          [&](int i, int j) { return normal(i % segments, j + first); });
    } else {
      rim.low = rim.high = normals_of(first);
    }
    const auto corner = [&](const std::vector<AttributeId>& n, int i) {
      return n[std::size_t(i % segments)];
    };
    for (int i = 0; i < segments; ++i) {
      const auto at_rim = [&](int step, int j) { return b.vertex(point(i + step, j)); };
      if (last < rows) {
        b.triangle({at_rim(0, last), at_rim(1, last), b.vertex(point(0, rows))},
                   {corner(rim.high, i), corner(rim.high, i + 1), b.normal(normal(i + 0.5, rows))});
      }
      if (first > 0) {
        b.triangle({at_rim(1, first), at_rim(0, first), b.vertex(point(0, 0))},
                   {corner(rim.low, i + 1), corner(rim.low, i), b.normal(normal(i + 0.5, 0))});
      }
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
       straight_strip(plinth, low, radius, low), straight_strip(radius, low, radius * 0.85, high),
       straight_strip(radius * 0.85, high, plinth, high),
       straight_strip(plinth, high, plinth, height), straight_strip(plinth, height, 0, height)});
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
  const std::size_t count = inner.size();
  const double back = arch.thickness;
  const auto on_top = [&](const Outline& p) { return p.z > arch.height - 0.001; };

  b.coat(arch.coat);
  const AttributeId front_normal = b.normal({0, -1, 0}), back_normal = b.normal({0, 1, 0});
  const AttributeId right_normal = b.normal({1, 0, 0}), left_normal = b.normal({-1, 0, 0});
  const AttributeId up = b.normal(kUp), down = b.normal(-kUp);
  for (int bay = 0; bay < arch.bays; ++bay) {
    // Distances from the middle are rounded, so that neighbours have the same points between them.
    const double middle = on_grid(arch.low.x + (bay + 0.5) * arch.width);
    const auto at = [&](const Outline& p, double y) {
      return Vec3d{middle + on_grid(p.x), arch.low.y + y, on_grid(arch.low.z + p.z)};
    };
    const bool first = bay == 0, last = bay + 1 == arch.bays;
    const auto outside = [&](const Outline& p, const Outline& q, bool top, bool left) {
      if (!top && !(left ? first : last)) return;  // within the wall
      b.quad({at(p, 0), at(p, back), at(q, back), at(q, 0)}, top    ? up
                                                             : left ? left_normal
                                                                    : right_normal);
    };
    for (std::size_t k = 0; k + 1 < count; ++k) {
      const Outline &p = outer[k], &q = outer[k + 1], &r = inner[k + 1], &s = inner[k];
      b.quad({at(s, 0), at(p, 0), at(q, 0), at(r, 0)}, front_normal);
      b.quad({at(p, back), at(s, back), at(r, back), at(q, back)}, back_normal);
      if (on_top(p) == on_top(q)) {
        outside(p, q, on_top(p), k >= count / 2);
        continue;
      }
      const Outline corner{on_top(p) ? -half : half, arch.height};
      b.quad({at(p, 0), at(corner, 0), at(q, 0), at(q, 0)}, front_normal);
      b.quad({at(q, back), at(corner, back), at(p, back), at(p, back)}, back_normal);
      outside(p, corner, on_top(p), false);
      outside(corner, q, on_top(q), true);
    }
    b.smooth_patch(
        int(count) - 1, 1,
        [&](int i, int j) { return at(inner[count - 1 - std::size_t(i)], j == 0 ? back : 0); },
        [&](int i, int) {
          const int k = std::clamp(int(count) - 2 - i, 0, arch.segments);
          const Vec3d p = on_circle(k, 2 * arch.segments);
          return Vec3d{-p.x, 0, -p.y};
        });
    const Outline feet[2][2] = {{inner[0], outer[0]}, {outer[count - 1], inner[count - 1]}};
    for (const auto& [from, to] : feet) {
      b.quad({at(from, back), at(to, back), at(to, 0), at(from, 0)}, down);
    }
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

//   3--4       7--0    From above; the points end a hand's breadth inside the wall, so that no face
//   |  5-------6  |    lies on it.
//   2-------------1
void add_balcony(ModelBuilder& b, const Vec3d& low, double width, double depth, Coat coat) {
  constexpr double kInWall = 0.1, kThickness = 0.1, kSlab = 0.2, kHeight = 1.15;
  b.begin_body();
  b.coat(coat);
  const double x[] = {
      width, width, 0, 0, kThickness, kThickness, width - kThickness, width - kThickness};
  const double y[] = {
      kInWall, -depth, -depth, kInWall, kInWall, kThickness - depth, kThickness - depth, kInWall};
  const auto at = [&](std::size_t i, double z) { return on_grid(low + Vec3d{x[i], y[i], z}); };
  const double top = kHeight;
  const AttributeId up = b.normal(kUp), right = b.normal({1, 0, 0}), left = b.normal({-1, 0, 0});
  const AttributeId front = b.normal({0, -1, 0}), back = b.normal({0, 1, 0});
  b.quad({at(0, 0), at(1, 0), at(2, 0), at(3, 0)}, b.normal(-kUp));
  b.quad({at(2, 0), at(1, 0), at(1, top), at(2, top)}, front);
  b.quad({at(1, 0), at(0, 0), at(0, top), at(1, top)}, right);
  b.quad({at(3, 0), at(2, 0), at(2, top), at(3, top)}, left);
  b.quad({at(1, top), at(0, top), at(7, top), at(6, top)}, up);
  b.quad({at(2, top), at(1, top), at(6, top), at(5, top)}, up);
  b.quad({at(3, top), at(2, top), at(5, top), at(4, top)}, up);
  b.quad({at(5, kSlab), at(4, kSlab), at(4, top), at(5, top)}, right);
  b.quad({at(6, kSlab), at(5, kSlab), at(5, top), at(6, top)}, back);
  b.quad({at(7, kSlab), at(6, kSlab), at(6, top), at(7, top)}, left);
  b.quad({at(4, kSlab), at(5, kSlab), at(6, kSlab), at(7, kSlab)}, up);
  const Vec3d end[] = {at(0, 0),     at(0, top), at(7, top), at(7, kSlab),
                       at(4, kSlab), at(4, top), at(3, top), at(3, 0)};
  std::vector<Vec3d> loop(std::rbegin(end), std::rend(end));
  b.polygon(loop, {0, 1, 0});
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

// As few triangles as still look round: there are thousands.
void add_tree(ModelBuilder& b, const Vec3d& foot, double height, bool conifer) {
  b.coat(Coat::Wood);
  add_spire(b, foot - kUp * 0.2, 0.25, height * 0.6, 5);
  b.coat(Coat::Leaves);
  const double radius = height * (conifer ? 0.22 : 0.28);
  if (conifer) {
    add_cone(b, foot + kUp * on_grid(height * 0.2), radius, height * 0.8, 9);
    return;
  }
  LatheStrip crown;
  constexpr int kRows = 3;
  for (int j = 0; j <= kRows; ++j) {
    const Vec3d p = on_circle(j, 2 * kRows);  // from the bottom pole to the top
    crown.push_back({radius * p.y, radius * 1.1 * (1 - p.x), p.y * 1.1, -p.x});
  }
  add_lathe(b, foot + kUp * on_grid(height * 0.35), 8, {crown});
}

}  // namespace crease
