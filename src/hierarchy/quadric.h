// Quadrics: weighted sums of squared distances as a function of a point (Garland 1999), and of
// squared attribute errors as a function of a point and a value (Hoppe 1999).
//
// Positions are in grid units relative to the patch's centre, so that doubles keep a plane exact to
// a fraction of a grid unit. `weight` is an area (surface, attributes) or a squared length (lines).
//
// Everything is in rows of four, which the compiler makes SIMD instructions of: no products are
// fused, so the result is the same to the bit on every processor.
#pragma once

#include "base/wide.h"
#include "crease/mesh.h"
#include "crease/vec.h"

#include <algorithm>
#include <cmath>

namespace crease::simplification {

// (x, y, z, 1): a point; (gradient, offset): a linear function. Aligned as operator new aligns.
using Row = double __attribute__((vector_size(32), aligned(16)));

inline double sum_of(const Row& r) {
  return (r[0] + r[2]) + (r[1] + r[3]);
}

// To the nearest grid position; |x| < 2^51. std::round is a call where there is no SSE 4.1.
inline double rounded(double x) {
  constexpr double kShift = 6755399441055744.0;  // 1.5 * 2^52
  return (x + kShift) - kShift;
}
inline Vec3d rounded(const Vec3d& x) {
  return {rounded(x.x), rounded(x.y), rounded(x.z)};
}

struct Quadric {
  // The symmetric matrix of x^T A x + 2 b x + c by rows: (A | b) and below it c.
  Row row[3] = {};
  double c = 0;
  double weight = 0;

  // w * |f(x)|^2 for a linear function f.
  void add_square(const Row& f, double w) {
    const Row wf = f * w;
    row[0] += wf[0] * f;
    row[1] += wf[1] * f;
    row[2] += wf[2] * f;
    c += wf[3] * f[3];
  }

  // w * (n.x + d)^2; n need not be a unit vector.
  void add_plane(const Vec3d& n, double d, double w) { add_square(Row{n.x, n.y, n.z, d}, w); }

  void add(const Quadric& o) {
    for (int i = 0; i < 3; ++i) row[i] += o.row[i];
    c += o.c;
    weight += o.weight;
  }

  // Not a copy to which the other is added: it would be written in halves of rows, and a row cannot
  // be loaded again until both have reached the cache. Nor an empty one: clearing it takes as long
  // as all of the rest.
  friend Quadric operator+(const Quadric& x, const Quadric& y) {
    return {{x.row[0] + y.row[0], x.row[1] + y.row[1], x.row[2] + y.row[2]},
            x.c + y.c,
            x.weight + y.weight};
  }
  // add_plane() to none.
  static Quadric of_plane(const Vec3d& n, double d, double w, double weight) {
    const Row f{n.x, n.y, n.z, d}, wf = f * w;
    return {{wf[0] * f, wf[1] * f, wf[2] * f}, wf[3] * f[3], weight};
  }

  // All but the weight.
  void add_scaled(const Quadric& o, double scale) {
    for (int i = 0; i < 3; ++i) row[i] += scale * o.row[i];
    c += scale * o.c;
  }

  double at(const Vec3d& x) const {
    const Row t = x.x * row[0] + x.y * row[1] + x.z * row[2];
    return std::max(0.0, sum_of(t * Row{x.x, x.y, x.z, 2}) + c);
  }

  double trace() const { return row[0][0] + row[1][1] + row[2][2]; }

  // The minimum, pulled towards `near` where the quadric says little: on a plane it is singular,
  // and an unbounded optimum flies away. `pull` is relative to the trace.
  Vec3d minimum(const Vec3d& near, double pull) const {
    const double mu = pull * trace();
    if (!(mu > 0)) return near;
    // Half of the gradient at `near`.
    const Row t = near.x * row[0] + near.y * row[1] + near.z * row[2];
    const Vec3d r{t[0] + row[0][3], t[1] + row[1][3], t[2] + row[2][3]};
    const double a01 = row[0][1], a02 = row[0][2], a12 = row[1][2];
    const double m00 = row[0][0] + mu, m11 = row[1][1] + mu, m22 = row[2][2] + mu;
    const double c00 = m11 * m22 - a12 * a12;
    const double c01 = a02 * a12 - a01 * m22;
    const double c02 = a01 * a12 - a02 * m11;
    const double det = m00 * c00 + a01 * c01 + a02 * c02;
    if (!(det > 0)) return near;
    const double c11 = m00 * m22 - a02 * a02;
    const double c12 = a01 * a02 - m00 * a12;
    const double c22 = m00 * m11 - a01 * a01;
    const double s = -1 / det;
    return {near.x + s * (c00 * r.x + c01 * r.y + c02 * r.z),
            near.y + s * (c01 * r.x + c11 * r.y + c12 * r.z),
            near.z + s * (c02 * r.x + c12 * r.y + c22 * r.z)};
  }
};

inline constexpr int kMaxDimension = 4;  // of an attribute layer

// Over a wedge's triangles: sum of w * |f(x) - s|^2, f the attribute on each triangle as a linear
// function and s the value that the wedge will carry. `own` is the part without s.
struct AttributeQuadric {
  Quadric own;                     // own.weight: the area
  Row linear[kMaxDimension] = {};  // weighted sums of the functions, by component

  void add(const AttributeQuadric& o, int dimension) {
    own.add(o.own);
    for (int j = 0; j < dimension; ++j) linear[j] += o.linear[j];
  }

  friend AttributeQuadric operator+(const AttributeQuadric& x, const AttributeQuadric& y) {
    return {x.own + y.own,
            {x.linear[0] + y.linear[0], x.linear[1] + y.linear[1], x.linear[2] + y.linear[2],
             x.linear[3] + y.linear[3]}};
  }

  // Triangles on which the attribute is `value` everywhere.
  void add_constant(const float* value, double area, int dimension) {
    own.weight += area;
    for (int j = 0; j < dimension; ++j) {
      const double wv = area * double(value[j]);
      own.c += wv * double(value[j]);
      linear[j][3] += wv;
    }
  }

  // weight * (the value that is best at x).
  double weighted_value(int j, const Vec3d& x) const {
    return sum_of(linear[j] * Row{x.x, x.y, x.z, 1});
  }

  // Adds scale * (error with the best value) to `sum`, as a quadric in x alone.
  void add_reduced(Quadric& sum, int dimension, double scale) const {
    if (!(own.weight > 0)) return;
    sum.add_scaled(own, scale);
    for (int j = 0; j < dimension; ++j) sum.add_square(linear[j], -scale / own.weight);
  }

  // Adds scale * (error with the value `value`) to `sum`, as a quadric in x alone.
  void add_fixed(Quadric& sum, int dimension, const float* value, double scale) const {
    sum.add_scaled(own, scale);
    for (int j = 0; j < dimension; ++j) {
      const double v = scale * double(value[j]);
      for (int i = 0; i < 3; ++i) sum.row[i][3] -= v * linear[j][i];
      sum.c += v * (own.weight * double(value[j]) - 2 * linear[j][3]);
    }
  }

  // add_reduced() of x and y joined, without making the joined quadric: the inner loop of the
  // simplifier inside a smooth surface.
  static void add_reduced_pair(const AttributeQuadric& x, const AttributeQuadric& y, int dimension,
                               Quadric& sum, double scale) {
    const double area = x.own.weight + y.own.weight;
    if (!(area > 0)) return;
    Row row[3];
    for (int i = 0; i < 3; ++i) row[i] = x.own.row[i] + y.own.row[i];
    double c = x.own.c + y.own.c;
    const double inverse = 1 / area;
    for (int j = 0; j < dimension; ++j) {
      const Row f = x.linear[j] + y.linear[j];
      const Row g = f * inverse;
      for (int i = 0; i < 3; ++i) row[i] -= g[i] * f;
      c -= g[3] * f[3];
    }
    for (int i = 0; i < 3; ++i) sum.row[i] += scale * row[i];
    sum.c += scale * c;
  }

  // The error at x with the value `value`.
  double at(const Vec3d& x, int dimension, const float* value) const {
    const Row* q = own.row;
    double b[] = {q[0][3], q[1][3], q[2][3]}, c = own.c;  // as add_fixed()
    for (int j = 0; j < dimension; ++j) {
      const double v = double(value[j]);
      for (int i = 0; i < 3; ++i) b[i] -= v * linear[j][i];
      c += v * (own.weight * v - 2 * linear[j][3]);
    }
    const Quadric sum{{Row{q[0][0], q[0][1], q[0][2], b[0]}, Row{q[1][0], q[1][1], q[1][2], b[1]},
                       Row{q[2][0], q[2][1], q[2][2], b[2]}},
                      c};
    return sum.at(x);
  }

  // How far what the attribute paints on the surface is displaced, the root of the mean, where the
  // attribute is off by `square`, as at() says: that by the mean slope, of which there are two
  // directions. None of numbers: nobody knows how they are painted.
  double displacement(double square, AttributeRole role) const {
    if (role == AttributeRole::Other) return 0;
    const double unseen = role == AttributeRole::Color    ? kUnseenColor
                          : role == AttributeRole::Normal ? kUnseenNormal
                                                          : 0;
    const double seen = square - unseen * own.weight;
    const double slope = own.trace();
    return seen > 0 && slope > 0 ? std::sqrt(2 * seen / slope) : 0;
  }

 private:
  // Squared: five of 255 in one component, and a chord of eight degrees.
  static constexpr double kUnseenColor = 4e-4, kUnseenNormal = 0.0195;
};

}  // namespace crease::simplification
