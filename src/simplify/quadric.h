// Quadrics: weighted sums of squared distances as a function of a point (Garland 1999), and of
// squared attribute errors as a function of a point and a value (Hoppe 1999).
//
// Positions are in grid units relative to the patch's centre, so that doubles keep a plane exact to
// a fraction of a grid unit. `weight` is an area (surface, attributes) or a squared length (lines).
#pragma once

#include "crease/vec.h"

#include <algorithm>

namespace crease::simplification {

struct Quadric {
  // x^T A x + 2 b x + c, A symmetric.
  double a00 = 0, a01 = 0, a02 = 0, a11 = 0, a12 = 0, a22 = 0;
  double b0 = 0, b1 = 0, b2 = 0;
  double c = 0;
  double weight = 0;

  // w * (n.x + d)^2; n need not be a unit vector.
  void add_plane(const Vec3d& n, double d, double w) {
    a00 += w * n.x * n.x;
    a01 += w * n.x * n.y;
    a02 += w * n.x * n.z;
    a11 += w * n.y * n.y;
    a12 += w * n.y * n.z;
    a22 += w * n.z * n.z;
    b0 += w * n.x * d;
    b1 += w * n.y * d;
    b2 += w * n.z * d;
    c += w * d * d;
  }

  void add(const Quadric& o) {
    a00 += o.a00;
    a01 += o.a01;
    a02 += o.a02;
    a11 += o.a11;
    a12 += o.a12;
    a22 += o.a22;
    b0 += o.b0;
    b1 += o.b1;
    b2 += o.b2;
    c += o.c;
    weight += o.weight;
  }

  void add(const Quadric& o, double scale) {
    a00 += scale * o.a00;
    a01 += scale * o.a01;
    a02 += scale * o.a02;
    a11 += scale * o.a11;
    a12 += scale * o.a12;
    a22 += scale * o.a22;
    b0 += scale * o.b0;
    b1 += scale * o.b1;
    b2 += scale * o.b2;
    c += scale * o.c;
    weight += scale * o.weight;
  }

  double at(const Vec3d& x) const {
    const double ax = a00 * x.x + a01 * x.y + a02 * x.z + 2 * b0;
    const double ay = a01 * x.x + a11 * x.y + a12 * x.z + 2 * b1;
    const double az = a02 * x.x + a12 * x.y + a22 * x.z + 2 * b2;
    return std::max(0.0, x.x * ax + x.y * ay + x.z * az + c);
  }

  double trace() const { return a00 + a11 + a22; }

  // Half of the gradient at x.
  Vec3d slope(const Vec3d& x) const {
    return {a00 * x.x + a01 * x.y + a02 * x.z + b0, a01 * x.x + a11 * x.y + a12 * x.z + b1,
            a02 * x.x + a12 * x.y + a22 * x.z + b2};
  }

  // The minimum, pulled towards `near` where the quadric says little: on a plane it is singular,
  // and an unbounded optimum flies away (DESIGN 10). `pull` is relative to the trace.
  Vec3d minimum(const Vec3d& near, double pull) const {
    const double mu = pull * trace();
    if (!(mu > 0)) return near;
    const double m00 = a00 + mu, m11 = a11 + mu, m22 = a22 + mu;
    const Vec3d r = slope(near);
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

// Over a wedge's triangles: sum of w * |g x + d - s|^2, g and d the attribute's gradient and offset
// on each triangle, s the value that the wedge will carry. `own` is the part without s.
struct AttributeQuadric {
  Quadric own;                      // own.weight: the area
  double g[kMaxDimension][3] = {};  // weighted sums of gradients
  double d[kMaxDimension] = {};     // and of offsets

  void add(const AttributeQuadric& o, int dimension) {
    own.add(o.own);
    for (int j = 0; j < dimension; ++j) {
      g[j][0] += o.g[j][0];
      g[j][1] += o.g[j][1];
      g[j][2] += o.g[j][2];
      d[j] += o.d[j];
    }
  }

  void add_linear(int j, const Vec3d& gradient, double offset, double w) {
    own.add_plane(gradient, offset, w);
    g[j][0] += w * gradient.x;
    g[j][1] += w * gradient.y;
    g[j][2] += w * gradient.z;
    d[j] += w * offset;
  }

  // weight * (the value that is best at x).
  double weighted_value(int j, const Vec3d& x) const {
    return g[j][0] * x.x + g[j][1] * x.y + g[j][2] * x.z + d[j];
  }

  // Adds scale * (error with the best value) to `sum`, as a quadric in x alone.
  void add_reduced(Quadric& sum, int dimension, double scale) const {
    if (!(own.weight > 0)) return;
    const double area = sum.weight;
    sum.add(own, scale);
    sum.weight = area;
    const double s = -scale / own.weight;
    for (int j = 0; j < dimension; ++j) sum.add_plane({g[j][0], g[j][1], g[j][2]}, d[j], s);
  }

  // Adds scale * (error with the value `value`) to `sum`, as a quadric in x alone.
  void add_fixed(Quadric& sum, int dimension, const double* value, double scale) const {
    const double area = sum.weight;
    sum.add(own, scale);
    sum.weight = area;
    for (int j = 0; j < dimension; ++j) {
      const double v = value[j];
      sum.b0 -= scale * v * g[j][0];
      sum.b1 -= scale * v * g[j][1];
      sum.b2 -= scale * v * g[j][2];
      sum.c += scale * v * (own.weight * v - 2 * d[j]);
    }
  }

  // add_reduced() of x and y joined, without making the joined quadric: the inner loop of the
  // simplifier inside a smooth surface.
  template <int kDimension>
  static void add_reduced_pair(const AttributeQuadric& x, const AttributeQuadric& y, Quadric& sum,
                               double scale) {
    const double area = x.own.weight + y.own.weight;
    if (!(area > 0)) return;
    const double s = scale / area;
    double a00 = 0, a01 = 0, a02 = 0, a11 = 0, a12 = 0, a22 = 0, b0 = 0, b1 = 0, b2 = 0, c = 0;
    for (int j = 0; j < kDimension; ++j) {
      const double g0 = x.g[j][0] + y.g[j][0], g1 = x.g[j][1] + y.g[j][1],
                   g2 = x.g[j][2] + y.g[j][2], d0 = x.d[j] + y.d[j];
      a00 += g0 * g0;
      a01 += g0 * g1;
      a02 += g0 * g2;
      a11 += g1 * g1;
      a12 += g1 * g2;
      a22 += g2 * g2;
      b0 += g0 * d0;
      b1 += g1 * d0;
      b2 += g2 * d0;
      c += d0 * d0;
    }
    sum.a00 += scale * (x.own.a00 + y.own.a00) - s * a00;
    sum.a01 += scale * (x.own.a01 + y.own.a01) - s * a01;
    sum.a02 += scale * (x.own.a02 + y.own.a02) - s * a02;
    sum.a11 += scale * (x.own.a11 + y.own.a11) - s * a11;
    sum.a12 += scale * (x.own.a12 + y.own.a12) - s * a12;
    sum.a22 += scale * (x.own.a22 + y.own.a22) - s * a22;
    sum.b0 += scale * (x.own.b0 + y.own.b0) - s * b0;
    sum.b1 += scale * (x.own.b1 + y.own.b1) - s * b1;
    sum.b2 += scale * (x.own.b2 + y.own.b2) - s * b2;
    sum.c += scale * (x.own.c + y.own.c) - s * c;
  }

  // The error at x with the value `value`.
  double at(const Vec3d& x, int dimension, const double* value) const {
    Quadric sum;
    add_fixed(sum, dimension, value, 1);
    return sum.at(x);
  }
};

}  // namespace crease::simplification
