// Witnesses: points of a finer surface, each kept with the triangle of the present one that is
// about nearest to it, so that whoever contracts a vertex knows how far the surface has gone from
// them.
//
//   Witnesses witnesses = witnesses_of(mesh, positions);   // on the grid
//   mover.start();                                         // of a contraction to the place v
//   for (t : triangles around v) mover.add(t, next - v, previous - v);
//   for (t : those, and those that vanished) mover.take(t, i, witnesses);
//   const float far = mover.measure(witnesses, v, known);  // changes nothing yet
//   mover.settle(witnesses);
//
// Distances are measured to the triangles around the vertex alone, so they are no less than those
// to the whole surface; and at some points only, so that the rest can be farther away than they
// tell, in general by little. A triangle keeps kMostWitnesses, so that all of it takes linear time:
// the farthest, and some of the others, so that what they are spread over stays large.
//
// It stays with a triangle, though another may be nearer, while it is no farther from it than what
// is said of the vertex anyway: three of four need not look at all triangles then, and what levels
// say is the same but for a few per cent of some of 5 % and less.
//
// A witness counts where it gets farther away than it ever was, by a tenth: else whatever is done
// around a place that is wrong already would count as wrong as it.
#pragma once

#include "crease/ids.h"
#include "crease/mesh.h"
#include "crease/vec.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace crease {

inline constexpr std::size_t kMostWitnesses = 8, kFarthestWitnesses = 4;
inline constexpr float kFarther = 1.1f;  // what counts

struct Witness {
  Vec3i place;
  std::uint32_t next = kNone;  // of the same triangle
  float told = 0;              // how far away it was when it last counted
  float from = 0;              // how far it may be from what it stands for
  float squared = 0;           // distance from its triangle
};

struct Witnesses {
  std::vector<Witness> all;
  std::vector<std::uint32_t> first;  // per triangle, or kNone

  void put(std::uint32_t witness, std::uint32_t triangle) {
    all[witness].next = first[triangle];
    first[triangle] = witness;
  }
};

// Every vertex that has a triangle, at the first of them.
Witnesses witnesses_of(const Mesh& mesh, std::span<const Vec3i> positions);

// Those of some triangles side by side, so that whoever contracts only there has them at hand.
class WitnessesOfPart {
 public:
  // Of a model that will be asked for no others of these triangles before they are given back.
  WitnessesOfPart(const Witnesses& model, std::span<const std::uint32_t> triangles);
  // Triangles by their places in `triangles`.
  Witnesses& here() { return here_; }
  const Witnesses& here() const { return here_; }
  // Those at the first of them; of the others there are none any more.
  void give_back(std::span<const std::uint32_t> triangles, std::size_t count,
                 Witnesses& model) const;

 private:
  Witnesses here_;
  std::vector<std::uint32_t> ids_;  // per witness: in the model
};

class WitnessMover {
 public:
  void start() {
    triangles_.clear();
    taken_.clear();
    left_.clear();
  }

  // One of the triangles around the vertex, which stands at the origin.
  void add(std::uint32_t triangle, const Vec3d& next, const Vec3d& previous) {
    const std::size_t lane = triangles_.size() % kLanes, b = triangles_.size() / kLanes;
    if (b == blocks_.size()) blocks_.emplace_back();
    triangles_.push_back(triangle);
    Block& block = blocks_[b];
    for (int i = 0; i < 3; ++i) {
      const auto to_next = static_cast<float>(next[i]);
      const auto to_previous = static_cast<float>(previous[i]);
      if (lane == 0) {  // what no other triangle takes is this one again
        block.next[i] = Lanes{} + to_next;
        block.previous[i] = Lanes{} + to_previous;
      }
      block.next[i][lane] = to_next;
      block.previous[i][lane] = to_previous;
    }
  }

  // The witnesses of a triangle that changed: the `place`-th that was added, or kNone if it
  // vanished. In the order of places, which is quicker.
  void take(std::uint32_t triangle, std::uint32_t place, const Witnesses& witnesses) {
    std::uint32_t w = witnesses.first[triangle];
    if (w != kNone) left_.push_back(triangle);
    for (; w != kNone; w = witnesses.all[w].next) taken_.push_back({w, place, 0, 0});
  }

  // Finds the triangle nearest to each of those taken; but it stays where it is if it is no farther
  // from there than `known`, which is said of the vertex anyway, or too near to count. Returns how
  // far from the surface the farthest one is of those that count. Where there is no triangle: from
  // the vertex.
  [[gnu::always_inline]] inline float measure(const Witnesses& witnesses, const Vec3i& vertex,
                                              float known) {
    if (taken_.empty()) return 0;
    const std::size_t block_count = (triangles_.size() + kLanes - 1) / kLanes;
    for (std::size_t b = 0; b < block_count; ++b) blocks_[b].prepare();
    std::size_t looks = kMostLooks;
    Lanes farthest{};
    for (std::size_t begin = 0, end = 0; begin < taken_.size(); begin = end) {
      end = end_of_group(begin);
      const std::span<Taken> taken = std::span(taken_).subspan(begin, end - begin);
      const bool vanished = taken[0].place == kNone;
      Group group;
      for (std::size_t i = 0; i < taken.size(); ++i) {
        group.load(i, witnesses.all[taken[i].witness], vertex, taken[i].place);
      }
      Lanes enough2 = Lanes{} - 1.0f;
      if (vanished) {
        product(group.at, group.at, group.squared);
      } else {
        Block own;
        blocks_[taken[0].place / kLanes].pick_into(group.place, own);
        own.measure(group.at, group.squared);
        Lanes enough;
        group.find_enough(known, enough);
        enough2 = own.per_normal > 0 ? enough : enough2;
      }
      for (std::size_t i = 0; i < taken.size(); ++i) {
        if (group.squared[i] <= enough2[i] || looks < block_count) continue;
        if (vanished) taken[i].place = 0;
        const Lanes p[] = {Lanes{} + group.at[0][i], Lanes{} + group.at[1][i],
                           Lanes{} + group.at[2][i]};
        float best = group.squared[i];
        for (std::size_t b = 0; b < block_count; ++b) {
          blocks_[b].find_nearest(p, b, best, taken[i].place);
        }
        group.squared[i] = best;
        looks -= block_count;
      }
      group.tell(known, farthest);
      for (std::size_t i = 0; i < taken.size(); ++i) {
        taken[i].told = group.told[i];
        taken[i].squared = group.squared[i];
      }
    }
    float result = 0;
    for (std::size_t i = 0; i < kLanes; ++i) result = std::max(result, farthest[i]);
    return result;
  }

  // Gives each of those taken to the triangle that measure() found; where there is none, nobody has
  // them any more.
  void settle(Witnesses& witnesses) {
    for (const std::uint32_t t : left_) witnesses.first[t] = kNone;
    count_.assign(triangles_.size(), 0);
    crowded_.clear();
    for (const Taken& taken : taken_) {
      Witness& w = witnesses.all[taken.witness];
      w.told = taken.told;
      w.squared = taken.squared;
      if (triangles_.empty()) continue;
      const std::size_t at = std::min<std::size_t>(taken.place, triangles_.size() - 1);
      witnesses.put(taken.witness, triangles_[at]);
      if (++count_[at] == kMostWitnesses + 1) crowded_.push_back(triangles_[at]);
    }
    for (const std::uint32_t t : crowded_) thin_out(t, witnesses);
  }

 private:
  static constexpr std::size_t kLanes = 8;
  static constexpr std::size_t kMostLooks = 16384;  // at blocks, else fans take the square of time
  using Lanes = float __attribute__((vector_size(32), aligned(16)));
  using Ints = std::int32_t __attribute__((vector_size(32), aligned(16)));
  static constexpr float kTiny = 1e-30f, kHandicap = 1e-12f;

  struct Taken {
    std::uint32_t witness, place;
    float told, squared;  // as the witness will have them
  };

  // Results of eight floats go where they are told, since not all callers know such registers.
  [[gnu::always_inline]] static inline void product(const Lanes* a, const Lanes* b, Lanes& result) {
    result = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }
  [[gnu::always_inline]] static inline void cross(const Lanes* a, const Lanes* b, Lanes* result) {
    result[0] = a[1] * b[2] - a[2] * b[1];
    result[1] = a[2] * b[0] - a[0] * b[2];
    result[2] = a[0] * b[1] - a[1] * b[0];
  }
  // table[which[i]] for all i.
  [[gnu::always_inline]] static inline void pick(const Lanes& table, const Ints& which,
                                                 Lanes& result) {
#if defined(__clang__)
    for (std::size_t i = 0; i < kLanes; ++i) result[i] = table[which[i]];
#else
    result = __builtin_shuffle(table, which);
#endif
  }

  // Eight witnesses, about the vertex; what is not loaded stands there and counts for nothing.
  struct Group {
    Lanes at[3]{}, told{}, from{}, squared;
    Ints place{};

    void load(std::size_t lane, const Witness& w, const Vec3i& vertex, std::uint32_t where) {
      // Differences of 32 bits are exact in doubles, as they are nowhere else.
      for (int i = 0; i < 3; ++i) {
        at[i][lane] = static_cast<float>(double(w.place[i]) - double(vertex[i]));
      }
      told[lane] = w.told;
      from[lane] = w.from;
      place[lane] = static_cast<std::int32_t>(where % kLanes);
    }

    // What is so near does not count.
    [[gnu::always_inline]] inline void find_enough(float known, Lanes& enough2) const {
      Lanes enough = kFarther * told;
      enough = enough > known ? enough : Lanes{} + known;
      enough -= from;
      enough = enough > 0 ? enough : Lanes{};
      enough2 = enough * enough;
    }

    [[gnu::always_inline]] inline void tell(float known, Lanes& farthest) {
      Lanes away;
      for (std::size_t i = 0; i < kLanes; ++i) away[i] = std::sqrt(squared[i]);
      away += from;
      const auto counts = away > kFarther * told;
      const Lanes far = counts ? away : Lanes{};
      farthest = farthest > far ? farthest : far;
      told = (counts | ((away <= known) & (away > told))) ? away : told;
    }
  };

  // Eight triangles with a corner at the origin.
  struct Block {
    Lanes next[3], previous[3], normal[3];
    Lanes to_next[3], to_previous[3];  // products with them are barycentric coordinates
    Lanes per_next, per_previous, per_side, per_normal;  // one over squared lengths
    // Without area: so much farther, so that of two that are as near the other one is it.
    Lanes handicap;

    [[gnu::always_inline]] inline void prepare() {
      const Lanes none{};
      const auto over = [&](const Lanes* v, Lanes& inverse) __attribute__((always_inline)) {
        Lanes squared;
        product(v, v, squared);
        inverse = squared > kTiny ? 1.0f / squared : none;
      };
      const Lanes side[] = {previous[0] - next[0], previous[1] - next[1], previous[2] - next[2]};
      cross(next, previous, normal);
      over(next, per_next);
      over(previous, per_previous);
      over(side, per_side);
      over(normal, per_normal);
      product(side, side, handicap);
      Lanes other;
      product(next, next, other);
      handicap = per_normal > none ? none : kHandicap * (handicap + other);
      cross(previous, normal, to_next);
      cross(normal, next, to_previous);
      for (int i = 0; i < 3; ++i) {
        to_next[i] *= per_normal;
        to_previous[i] *= per_normal;
      }
    }

    // One of these triangles for each lane of the result.
    [[gnu::always_inline]] inline void pick_into(const Ints& which, Block& result) const {
      for (int i = 0; i < 3; ++i) {
        pick(next[i], which, result.next[i]);
        pick(previous[i], which, result.previous[i]);
        pick(normal[i], which, result.normal[i]);
        pick(to_next[i], which, result.to_next[i]);
        pick(to_previous[i], which, result.to_previous[i]);
      }
      pick(per_next, which, result.per_next);
      pick(per_previous, which, result.per_previous);
      pick(per_side, which, result.per_side);
      pick(per_normal, which, result.per_normal);
      pick(handicap, which, result.handicap);
    }

    // Squared distances of p.
    [[gnu::always_inline]] inline void measure(const Lanes* p, Lanes& squared) const {
      const Lanes none{}, one = none + 1.0f;
      const auto to_side = [&](const Lanes* from, const Lanes* side, const Lanes& inverse,
                               Lanes& result) __attribute__((always_inline)) {
        Lanes t;
        product(from, side, t);
        t *= inverse;
        t = t > none ? t : none;
        t = t < one ? t : one;
        const Lanes d[] = {from[0] - t * side[0], from[1] - t * side[1], from[2] - t * side[2]};
        product(d, d, result);
      };
      const Lanes q[] = {p[0] - next[0], p[1] - next[1], p[2] - next[2]};
      const Lanes side[] = {previous[0] - next[0], previous[1] - next[1], previous[2] - next[2]};
      Lanes first, second, third, over, u, v;
      to_side(p, next, per_next, first);
      to_side(p, previous, per_previous, second);
      to_side(q, side, per_side, third);
      Lanes nearest = first < second ? first : second;
      nearest = nearest < third ? nearest : third;
      product(p, normal, over);
      product(p, to_next, u);
      product(p, to_previous, v);
      const auto is_over = (u > none) & (v > none) & (u + v < one);
      squared = is_over ? over * per_normal * over : nearest + handicap;
    }

    // If one of these triangles, those from place 8 b on, is nearer to p than the best so far; of
    // two that are about as near, which is a few of the last bits, the first.
    [[gnu::always_inline]] inline void find_nearest(const Lanes* p, std::size_t b, float& best,
                                                    std::uint32_t& at) const {
      Lanes squared;
      measure(p, squared);
      // Floats that are not negative lie in order as integers do.
      Ints key, other;
      std::memcpy(&key, &squared, sizeof key);
      key = (key & -8) | Ints{0, 1, 2, 3, 4, 5, 6, 7};
      other = __builtin_shufflevector(key, key, 4, 5, 6, 7, 0, 1, 2, 3);
      key = key < other ? key : other;
      other = __builtin_shufflevector(key, key, 2, 3, 0, 1, 6, 7, 4, 5);
      key = key < other ? key : other;
      other = __builtin_shufflevector(key, key, 1, 0, 3, 2, 5, 4, 7, 6);
      key = key < other ? key : other;
      const auto lane = static_cast<std::size_t>(key[0] & 7);
      const bool nearer = squared[lane] < best;
      best = nearer ? squared[lane] : best;
      at = nearer ? static_cast<std::uint32_t>(b * kLanes + lane) : at;
    }
  };

  // Of those from `begin` on as many as are looked at together: of the same block, or vanished.
  std::size_t end_of_group(std::size_t begin) const {
    const std::size_t most = std::min(taken_.size(), begin + kLanes);
    const std::size_t block = taken_[begin].place / kLanes;
    std::size_t end = begin + 1;
    while (end < most && taken_[end].place / kLanes == block) ++end;
    return end;
  }

  void thin_out(std::uint32_t triangle, Witnesses& witnesses) {
    ranked_.clear();
    for (std::uint32_t w = witnesses.first[triangle]; w != kNone; w = witnesses.all[w].next) {
      // Floats that are not negative lie in order as integers do.
      ranked_.push_back(ranked(std::bit_cast<std::uint32_t>(witnesses.all[w].squared), w));
    }
    bring_forward(std::span(ranked_), kFarthestWitnesses);
    const std::span<std::uint64_t> others = std::span(ranked_).subspan(kFarthestWitnesses);
    for (std::uint64_t& r : others) r = ranked(mixed(witness_of(r)), witness_of(r));
    bring_forward(others, kMostWitnesses - kFarthestWitnesses);
    witnesses.first[triangle] = kNone;
    for (std::size_t i = 0; i < kMostWitnesses; ++i) {
      witnesses.put(witness_of(ranked_[i]), triangle);
    }
  }

  static std::uint64_t ranked(std::uint32_t rank, std::uint32_t witness) {
    return std::uint64_t(rank) << 32 | witness;
  }
  static std::uint32_t witness_of(std::uint64_t ranked) {
    return static_cast<std::uint32_t>(ranked);
  }
  // The largest so many.
  static void bring_forward(std::span<std::uint64_t> all, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      std::uint64_t most = all[i];
      for (std::size_t k = i + 1; k < all.size(); ++k) {  // without branches that nobody foretells
        const std::uint64_t other = all[k];
        all[k] = std::min(most, other);
        most = std::max(most, other);
      }
      all[i] = most;
    }
  }
  // In no order that the mesh would know of.
  static std::uint32_t mixed(std::uint32_t x) {
    x *= 0x9e3779b1u;
    return (x ^ x >> 15) * 0x85ebca77u;
  }

  std::vector<Block> blocks_;             // those that were ever needed
  std::vector<std::uint32_t> triangles_;  // around the vertex
  std::vector<Taken> taken_;
  std::vector<std::uint32_t> left_;             // by those taken
  std::vector<std::uint32_t> count_, crowded_;  // scratch of settle()
  std::vector<std::uint64_t> ranked_;           // scratch of thin_out()
};

}  // namespace crease
