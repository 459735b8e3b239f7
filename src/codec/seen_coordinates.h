// Coordinates that vertices around a place have already: walls, tiles, voxels and grids of heights
// have few of them, so that naming one takes less than telling how far off it is.
//
//   SeenPlace seen(models, gate, leaving);
//   if (seen.looks()) for (w : vertices around) seen.add(from_parent(around, place of w));
//   x = seen.code(coder, 0, 0, mixture, start, x, [&](std::int32_t x) { return code_axis(...); });
//   ...                                                          // likewise along 1 and 2
//   seen.finish();
//
// One is asked for only where its kind is likelier than chance: where the mixture expects it
// anyway, asking would take more than it saves. Those that are not asked for teach how likely their
// kind is all the same.
#pragma once

#include "codec/axis_mixture.h"
#include "codec/mixed_bit.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

namespace crease::codec {

// How likely coordinates are that others have, from those before in a block.
struct SeenModels {
  template <std::size_t N, std::size_t M, std::size_t K>
  struct Table {
    std::array<std::array<std::array<AdaptiveBit, K>, M>, N> of;
    Table() {
      for (auto& a : of) {
        for (auto& b : a) b.fill(AdaptiveBit(0.02, 6));
      }
    }
    AdaptiveBit& at(std::size_t i, std::size_t j, std::size_t k) { return of[i][j][k]; }
  };
  std::array<Table<4, 3, 5>, 4> by_scale;  // and as by_distance
  Table<4, 3, 5> by_distance;  // and by how many have it, and who had a coordinate before
  Table<3, 4, 3> by_axis;      // and by how many were asked for, and how many have it
  Table<5, 3, 3> by_leaving;   // and by axis, and how many have it
  MixingWeights<4> weights;
};

// Whether to look at what is around at all: in a block where hardly any place has a coordinate of
// that, only now and then.
class SeenGate {
 public:
  bool opens() { return looked_ < 32 || found_ * 16 >= looked_ || ++passed_ % 8 == 0; }
  void learn(bool is_found) {
    found_ += is_found;
    if (++looked_ < 256) return;
    looked_ /= 2;
    found_ /= 2;
  }

 private:
  std::uint32_t looked_ = 0, found_ = 0, passed_ = 0;
};

// Of one place.
class SeenPlace {
 public:
  SeenPlace(SeenModels& models, SeenGate& gate, std::size_t leaving)
      : models_(models), gate_(gate), leaving_(leaving), looks_(gate.opens()) {}

  bool looks() const { return looks_; }
  // The first kMostAround count.
  void add(const std::array<std::int32_t, 3>& place) {
    if (vertices_ == kMostAround) return;
    const std::uint32_t who = std::uint32_t(1) << vertices_++;
    for (std::size_t i = 0; i < 3; ++i) {
      OnAxis& on = axes_[i];
      const std::int32_t* begin = on.coordinates.data();
      const std::int32_t* end = begin + on.count;
      const std::int32_t* found = std::find(begin, end, place[i]);
      const auto k = static_cast<std::size_t>(found - begin);
      if (found == end) {
        on.coordinates[on.count] = place[i];
        on.who[on.count++] = 0;
      }
      on.who[k] |= who;
    }
  }

  // A coordinate along `axis`, less `less`, round at 2^32; `mixture` tells where it is likely, as
  // for code_axis(). `code_other` codes one that nobody has, or that was not asked for.
  template <class Coder, class CodeOther>
  std::int32_t code(Coder& coder, std::size_t axis, std::int32_t less, AxisMixture& mixture,
                    std::int32_t start, std::int32_t value, const CodeOther& code_other) {
    const OnAxis& on = axes_[axis];
    if (on.count == 0) return code_other(value);
    Candidates candidates = look(on, less, mixture);
    bool is_told = false;
    for (std::size_t i = 0; i < candidates.likely_count && i < kMostAsked; ++i) {
      const auto& [away, k] = candidates.likely[i];
      const std::size_t times = times_class(on.who[k]);
      MixedBit<4> bit(
          {candidates.kind[k], &models_.by_axis.at(axis, i, times),
           &models_.by_distance.at(distance_class(away), times, before_class(on.who[k])),
           &models_.by_leaving.at(leaving_, axis, times)},
          models_.weights);
      candidates.was_asked |= std::uint32_t(1) << k;
      const std::int32_t coordinate = candidates.coordinates[k];
      if (!coder.bit(bit, value == coordinate)) continue;
      value = coordinate;
      is_told = is_found_ = true;
      weigh(mixture, start,
            static_cast<std::int32_t>(static_cast<std::uint32_t>(value) -
                                      static_cast<std::uint32_t>(start)),
            1);
      break;
    }
    if (!is_told) value = code_other(value);
    learn(on, candidates, value);
    return value;
  }
  void finish() {
    if (looks_) gate_.learn(is_found_);
  }

 private:
  static constexpr std::size_t kMostAround = 18;
  static constexpr std::size_t kMostAsked = 4;
  static constexpr std::uint32_t kLeastOdds = 1 << (kProbabilityBits - 6);  // to be asked for

  struct OnAxis {
    std::array<std::int32_t, kMostAround> coordinates;
    std::array<std::uint32_t, kMostAround> who;  // has it: a bit for each vertex
    std::size_t count = 0;
  };
  struct Likely {
    float away = 0;  // from where the heaviest component has it, in its scales
    std::uint32_t index = 0;
  };
  struct Candidates {
    std::array<std::int32_t, kMostAround> coordinates;
    std::array<AdaptiveBit*, kMostAround> kind;
    std::array<Likely, kMostAround> likely;  // the nearest first
    std::size_t likely_count = 0, scale = 0;
    std::uint32_t was_asked = 0;
    float inverse_scale = 0;
  };

  static std::size_t times_class(std::uint32_t who) {
    const int times = std::popcount(who);
    return times < 2 ? 0 : times < 4 ? 1 : 2;
  }
  static std::size_t distance_class(float away) {
    return away < 0.5f ? 0 : away < 1.5f ? 1 : away < 5 ? 2 : 3;
  }
  static std::size_t scale_class(float inverse) {
    return inverse > 1 ? 0 : inverse > 1.0f / 8 ? 1 : inverse > 1.0f / 64 ? 2 : 3;
  }
  std::size_t before_class(std::uint32_t who) const {
    return told_ == 0 ? 0 : 2 * told_ - 1 + ((told_by_ & who) != 0);
  }

  // Beside how likely the mixture makes the same: that much, for what a wrong question costs.
  static bool is_worth_asking(std::uint32_t probability, float away, float inverse_scale) {
    const float odds = static_cast<float>(probability) * (1.0f / 65536);
    const float half = 0.5f * inverse_scale, factor = 2.75f - 1.7f * odds;
    if (away >= 5 || odds >= half * factor) return true;
    const float from = away - half, to = away + half;
    const float chance = 0.5f * (to / std::sqrt(1 + to * to) - from / std::sqrt(1 + from * from));
    return odds >= chance * factor;
  }

  Candidates look(const OnAxis& on, std::int32_t less, const AxisMixture& mixture) {
    std::size_t heaviest = 0;
    for (std::size_t k = 1; k < kComponents; ++k) {
      if (mixture.weight[k] > mixture.weight[heaviest]) heaviest = k;
    }
    const float center = mixture.center[heaviest];
    Candidates result;
    result.inverse_scale = mixture.inverse_scale[heaviest];
    result.scale = scale_class(result.inverse_scale);
    for (std::size_t k = 0; k < on.count; ++k) {
      const auto coordinate = static_cast<std::int32_t>(
          static_cast<std::uint32_t>(on.coordinates[k]) - static_cast<std::uint32_t>(less));
      const float away = std::abs(static_cast<float>(coordinate) - center) * result.inverse_scale;
      result.coordinates[k] = coordinate;
      result.kind[k] = &models_.by_scale[result.scale].at(
          distance_class(away), times_class(on.who[k]), before_class(on.who[k]));
      const std::uint32_t probability = result.kind[k]->probability();
      if (probability < kLeastOdds || !is_worth_asking(probability, away, result.inverse_scale))
        continue;
      std::size_t at = result.likely_count++;
      for (; at > 0 && away < result.likely[at - 1].away; --at) {
        result.likely[at] = result.likely[at - 1];
      }
      result.likely[at] = {away, static_cast<std::uint32_t>(k)};
    }
    return result;
  }

  void learn(const OnAxis& on, const Candidates& candidates, std::int32_t value) {
    std::uint32_t who = 0;
    for (std::size_t k = 0; k < on.count; ++k) {
      const bool is_it = candidates.coordinates[k] == value;
      if (is_it) who = on.who[k];
      if ((candidates.was_asked >> k & 1) == 0) candidates.kind[k]->learn(is_it);
    }
    if (who == 0) return;
    ++told_;
    told_by_ &= who;
  }

  SeenModels& models_;
  SeenGate& gate_;
  std::size_t leaving_;
  bool looks_, is_found_ = false;
  std::uint32_t vertices_ = 0;
  std::array<OnAxis, 3> axes_;
  std::size_t told_ = 0;                // axes along which somebody around has the coordinate
  std::uint32_t told_by_ = 0xffffffff;  // who has all of these
};

}  // namespace crease::codec
