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

#include "base/mixed.h"
#include "crease/ids.h"
#include "crease/mesh.h"
#include "crease/vec.h"
#include "hierarchy/eight_triangles.h"

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
    blocks_[b].put(lane, next, previous);
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
        Block::product(group.at, group.at, group.squared);
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
  static constexpr std::size_t kLanes = EightTriangles::kLanes;
  static constexpr std::size_t kMostLooks = 16384;  // at blocks, else fans take the square of time
  using Block = EightTriangles;
  using Lanes = EightTriangles::Lanes;
  using Ints = EightTriangles::Ints;

  struct Taken {
    std::uint32_t witness, place;
    float told, squared;  // as the witness will have them
  };

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
  std::vector<Block> blocks_;             // those that were ever needed
  std::vector<std::uint32_t> triangles_;  // around the vertex
  std::vector<Taken> taken_;
  std::vector<std::uint32_t> left_;             // by those taken
  std::vector<std::uint32_t> count_, crowded_;  // scratch of settle()
  std::vector<std::uint64_t> ranked_;           // scratch of thin_out()
};

}  // namespace crease
