// How a parent lies between its children, in bits: see hierarchy/between.h.
#pragma once

#include "codec/adaptive_bit.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace crease::codec {

using FourBits = std::array<AdaptiveBit, 4>;

// Starts from what was found in many models, known as well as 24 bits would have told.
inline FourBits four_bits(double a, double b, double c, double d) {
  constexpr int kSeen = 24;
  return {AdaptiveBit(a, kSeen), AdaptiveBit(b, kSeen), AdaptiveBit(c, kSeen),
          AdaptiveBit(d, kSeen)};
}

// Mostly in the middle, or towards the child whose neighbours are nearer. By how much nearer they
// are, in four classes.
struct EighthsModel {
  FourBits is_middle = four_bits(0.25, 0.34, 0.46, 0.58);
  FourBits is_nearer = four_bits(0.96, 0.94, 0.88, 0.67);
  // By whether it is the nearer one.
  std::array<FourBits, 2> is_one = {four_bits(0.68, 0.68, 0.7, 0.68),
                                    four_bits(0.27, 0.33, 0.46, 0.63)};
  std::array<FourBits, 2> is_two = {four_bits(0.82, 0.82, 0.85, 0.87),
                                    four_bits(0.76, 0.8, 0.88, 0.89)};
};

// 1 to 7, from the first child; `first` and `second`: how far off the children's neighbours are.
template <class Coder>
int code_eighths(Coder& coder, EighthsModel& model, float first, float second, int eighths) {
  const bool first_is_nearer = first <= second;
  const float sum = first + second, nearer = first_is_nearer ? first : second;
  const std::size_t c =
      sum > 0 ? std::min<std::size_t>(static_cast<std::size_t>(8 * nearer / sum), 3) : 3;
  if (coder.bit(model.is_middle[c], eighths == 4)) return 4;
  const bool towards = coder.bit(model.is_nearer[c], (eighths < 4) == first_is_nearer);
  const int away = eighths < 4 ? 4 - eighths : eighths - 4;
  int steps = 1;
  if (!coder.bit(model.is_one[towards][c], away == 1)) {
    steps = coder.bit(model.is_two[towards][c], away == 2) ? 2 : 3;
  }
  return towards == first_is_nearer ? 4 - steps : 4 + steps;
}

// Mostly the last axis, nearest to the normal; by how near another one is to it.
struct StepAxisModel {
  FourBits is_last = four_bits(0.97, 0.97, 0.95, 0.85);
  std::array<AdaptiveBit, 2> is_second;  // by whether it is nearer than the first
};

// `normal`: its parts along the axes, not below zero.
template <class Coder>
int code_step_axis(Coder& coder, StepAxisModel& model, const std::array<float, 3>& normal,
                   int axis) {
  const float beside = std::max(normal[0], normal[1]);
  const std::size_t c =
      normal[2] > 0 ? static_cast<std::size_t>(std::min(4 * beside / normal[2], 3.0f)) : 0;
  if (coder.bit(model.is_last[c], axis == 2)) return 2;
  return coder.bit(model.is_second[normal[1] > normal[0]], axis == 1) ? 1 : 0;
}

}  // namespace crease::codec
