// Witnesses: points of a finer surface, each kept with the triangle of the present one that is
// about nearest to it, so that whoever contracts a vertex knows how far the surface has gone from
// them.
//
//   Witnesses witnesses = witnesses_of(mesh, positions);  // on the grid
//   mover.start();                                        // after a contraction to the place v
//   for (t : triangles around v) mover.add(t, next - v, previous - v);
//   for (t : those, and those that vanished) mover.take(t, i, witnesses);
//   const float far = mover.measure(witnesses, v);        // changes nothing yet
//   mover.settle(witnesses);
//
// Distances are measured to the triangles around the vertex alone, so they are no less than those
// to the whole surface; and at some points only, so that the rest can be farther away than they
// tell, in general by little. A triangle keeps kMostWitnesses, so that all of it takes linear time:
// the farthest, and some of the others, so that what they are spread over stays large.
//
// A witness counts where it gets farther away than it ever was, by a tenth: else whatever is done
// around a place that is wrong already would count as wrong as it.
#pragma once

#include "crease/ids.h"
#include "crease/mesh.h"
#include "crease/vec.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace crease {

inline constexpr std::size_t kMostWitnesses = 8, kFarthestWitnesses = 4;
inline constexpr float kFarther = 1.1f;  // what counts

struct Witnesses {
  std::vector<Vec3i> places;         // per witness
  std::vector<std::uint32_t> next;   // per witness: of the same triangle, or kNone
  std::vector<float> told;           // per witness: how far away it was when it last counted
  std::vector<float> from;           // per witness: how far from what it stands for it may
                                     // be itself; or empty: it is a point of that
  std::vector<std::uint32_t> first;  // per triangle, or kNone

  void put(std::uint32_t witness, std::uint32_t triangle) {
    next[witness] = first[triangle];
    first[triangle] = witness;
  }
};

// Every vertex that has a triangle, at the first of them.
Witnesses witnesses_of(const Mesh& mesh, std::span<const Vec3i> positions);

class WitnessMover {
 public:
  void start() {
    blocks_.clear();
    triangles_.clear();
    taken_.clear();
    left_.clear();
  }

  // One of the triangles around the vertex, which stands at the origin.
  void add(std::uint32_t triangle, const Vec3d& next, const Vec3d& previous) {
    const std::size_t lane = triangles_.size() % kLanes;
    if (lane == 0) blocks_.emplace_back();
    triangles_.push_back(triangle);
    Block& block = blocks_.back();
    for (int i = 0; i < 3; ++i) {
      block.next[i][lane] = static_cast<float>(next[i]);
      block.previous[i][lane] = static_cast<float>(previous[i]);
    }
  }

  // The witnesses of a triangle that changed: the `place`-th that was added, or kNone if it
  // vanished.
  void take(std::uint32_t triangle, std::uint32_t place, const Witnesses& witnesses) {
    std::uint32_t w = witnesses.first[triangle];
    if (w != kNone) left_.push_back(triangle);
    for (; w != kNone; w = witnesses.next[w]) taken_.push_back({w, place, 0, 0});
  }

  // Finds the triangle nearest to each of those taken; returns how far from it the farthest one is
  // of those that count. Where there is no triangle: from the vertex.
  [[gnu::always_inline]] inline float measure(const Witnesses& witnesses, const Vec3i& vertex) {
    if (taken_.empty()) return 0;
    for (Block& block : blocks_) block.prepare();
    fill_up();
    std::size_t looks = kMostLooks;
    float farthest = 0;
    for (Taken& taken : taken_) {
      const std::uint32_t w = taken.witness;
      const Vec3i& place = witnesses.places[w];
      // Differences of 32 bits are exact in doubles, as they are nowhere else.
      const float p[3] = {static_cast<float>(double(place.x) - vertex.x),
                          static_cast<float>(double(place.y) - vertex.y),
                          static_cast<float>(double(place.z) - vertex.z)};
      const float from = witnesses.from.empty() ? 0 : witnesses.from[w];
      const float told = kFarther * witnesses.told[w], enough = std::max(told - from, 0.0f);
      float best = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
      std::size_t at = 0;
      const auto look_at = [&](std::size_t b) __attribute__((always_inline)) {
        Lanes squared;
        blocks_[b].measure(p, squared);
        for (std::size_t i = 0; i < kLanes; ++i) {
          const bool nearer = squared[i] < best;
          best = nearer ? squared[i] : best;
          at = nearer ? b * kLanes + i : at;
        }
      };
      if (taken.place != kNone && blocks_.size() > 1) {  // around a fan's hub the old one may do
        at = taken.place;
        look_at(taken.place / kLanes);
      }
      const bool is_good = blocks_.size() > 1 && best <= enough * enough;
      if (!is_good && looks >= blocks_.size()) {
        for (std::size_t b = 0; b < blocks_.size(); ++b) look_at(b);
        looks -= blocks_.size();
      }
      taken.squared = best;
      const float away = std::sqrt(best) + from;
      taken.counts_as = away > told ? away : 0;
      farthest = std::max(farthest, taken.counts_as);
      if (triangles_.empty()) continue;
      taken.place = static_cast<std::uint32_t>(std::min(at, triangles_.size() - 1));
    }
    return farthest;
  }

  // Gives each of those taken to the triangle that measure() found; where there is none, nobody has
  // them any more.
  void settle(Witnesses& witnesses) {
    for (std::uint32_t triangle : left_) witnesses.first[triangle] = kNone;
    count_.assign(triangles_.size(), 0);
    bool is_crowded = false;
    for (const Taken& taken : taken_) {
      if (taken.counts_as > 0) witnesses.told[taken.witness] = taken.counts_as;
      if (triangles_.empty()) continue;
      witnesses.put(taken.witness, triangles_[taken.place]);
      is_crowded |= ++count_[taken.place] > kMostWitnesses;
    }
    if (is_crowded) thin_out(witnesses);
  }

 private:
  static constexpr std::size_t kLanes = 8;
  static constexpr std::size_t kMostLooks = 16384;  // at blocks, else fans take the square of time
  using Lanes = float __attribute__((vector_size(32), aligned(16)));
  static constexpr float kTiny = 1e-30f;

  struct Taken {
    std::uint32_t witness, place;
    float squared, counts_as;  // how far away; 0: not farther than it ever was
  };

  // Eight triangles with a corner at the origin.
  struct Block {
    Lanes next[3], previous[3], normal[3];
    Lanes per_next, per_previous, per_side, per_normal;  // one over squared lengths

    [[gnu::always_inline]] inline void prepare() {
      const Lanes *a = next, *b = previous;
      const Lanes none{};
      normal[0] = a[1] * b[2] - a[2] * b[1];
      normal[1] = a[2] * b[0] - a[0] * b[2];
      normal[2] = a[0] * b[1] - a[1] * b[0];
      const Lanes s[] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
      const auto over = [&](const Lanes* v, Lanes& inverse) __attribute__((always_inline)) {
        const Lanes squared = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        inverse = squared > kTiny ? 1.0f / squared : none;
      };
      over(a, per_next);
      over(b, per_previous);
      over(s, per_side);
      over(normal, per_normal);
    }

    // Squared distances from p.
    [[gnu::always_inline]] inline void measure(const float* at, Lanes& squared) const {
      const Lanes *a = next, *b = previous, *n = normal;
      const Lanes none{}, one = none + 1.0f;
      const Lanes p[] = {none + at[0], none + at[1], none + at[2]};
      const auto to_side = [&](const Lanes* from, const Lanes* side, const Lanes& inverse,
                               Lanes& result) __attribute__((always_inline)) {
        Lanes t = (from[0] * side[0] + from[1] * side[1] + from[2] * side[2]) * inverse;
        t = t > none ? t : none;
        t = t < one ? t : one;
        const Lanes d[] = {from[0] - t * side[0], from[1] - t * side[1], from[2] - t * side[2]};
        result = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
      };
      const Lanes q[] = {p[0] - a[0], p[1] - a[1], p[2] - a[2]};
      const Lanes s[] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
      Lanes first, second, third;
      to_side(p, a, per_next, first);
      to_side(p, b, per_previous, second);
      to_side(q, s, per_side, third);
      first = first < second ? first : second;
      first = first < third ? first : third;
      // How far p is over the plane, and on which side of each side of the triangle.
      const Lanes over = p[0] * n[0] + p[1] * n[1] + p[2] * n[2];
      const auto inside = [&](const Lanes* side, const Lanes* from, Lanes& turn)
          __attribute__((always_inline)) {
        turn = (side[1] * from[2] - side[2] * from[1]) * n[0] +
               (side[2] * from[0] - side[0] * from[2]) * n[1] +
               (side[0] * from[1] - side[1] * from[0]) * n[2];
      };
      Lanes u, v, w;
      inside(a, p, u);
      inside(p, b, v);  // b is where it ends
      inside(s, q, w);
      const auto is_over = (u > none) & (v > none) & (w > none);
      const Lanes plane = over * per_normal * over;
      squared = is_over ? plane : first;
    }
  };

  // What is left of the last block is its first triangle again.
  void fill_up() {
    if (blocks_.empty()) return;
    const std::size_t used = (triangles_.size() - 1) % kLanes + 1;
    Block& block = blocks_.back();
    for (std::size_t i = used; i < kLanes; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        block.next[axis][i] = block.next[axis][0];
        block.previous[axis][i] = block.previous[axis][0];
        block.normal[axis][i] = block.normal[axis][0];
      }
      block.per_next[i] = block.per_next[0];
      block.per_previous[i] = block.per_previous[0];
      block.per_side[i] = block.per_side[0];
      block.per_normal[i] = block.per_normal[0];
    }
  }

  // In no order that the mesh would know of.
  static std::uint32_t mixed(std::uint32_t x) {
    x *= 0x9e3779b1u;
    return (x ^ x >> 15) * 0x85ebca77u;
  }

  void thin_out(Witnesses& witnesses) {
    // nth_element() promises no order, only who is among them: what is sorted is the same
    // everywhere.
    const auto by_witness = [](const Taken& a, const Taken& b) { return a.witness < b.witness; };
    std::sort(taken_.begin(), taken_.end(), [&](const Taken& a, const Taken& b) {
      return a.place != b.place ? a.place < b.place : by_witness(a, b);
    });
    for (auto begin = taken_.begin(), end = begin; begin != taken_.end(); begin = end) {
      while (end != taken_.end() && end->place == begin->place) ++end;
      if (static_cast<std::size_t>(end - begin) <= kMostWitnesses) continue;
      const auto others = begin + kFarthestWitnesses, left_out = begin + kMostWitnesses;
      std::nth_element(begin, others, end, [&](const Taken& a, const Taken& b) {
        return a.squared != b.squared ? a.squared > b.squared : by_witness(a, b);
      });
      std::nth_element(others, left_out, end, [](const Taken& a, const Taken& b) {
        return mixed(a.witness) < mixed(b.witness);
      });
      std::sort(begin, left_out, by_witness);
      const std::uint32_t triangle = triangles_[begin->place];
      witnesses.first[triangle] = kNone;
      for (auto kept = begin; kept != left_out; ++kept) witnesses.put(kept->witness, triangle);
    }
  }

  std::vector<Block> blocks_;
  std::vector<std::uint32_t> triangles_, count_;  // around the vertex
  std::vector<std::uint32_t> left_;               // by those taken
  std::vector<Taken> taken_;
};

}  // namespace crease
