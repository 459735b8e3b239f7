// One of a few, by how likely each is: shares of 2^16 that a range coder takes at once.
//
//   const Shares<8> shares(up_to, before, count);   // up_to[i] - before: the odds of 0 to i
//   together i = coder.one_of(shares, i);
#pragma once

#include "base/wide.h"
#include "codec/eight_floats.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#if defined(CREASE_AVX2)
#include <immintrin.h>
#endif

namespace crease::codec {

inline constexpr std::uint32_t kAllShares = 1u << 16;

// Of N at most, a multiple of 8. What is never likely keeps a share of kLeast.
template <std::size_t N>
class Shares {
 public:
  static constexpr std::uint32_t kAll = kAllShares;

  // Even ones if there are no odds at all. 1 <= count <= N.
  [[gnu::always_inline]] Shares(const std::array<float, N>& up_to, float before,
                                std::size_t count) {
    constexpr float kFree = static_cast<float>(kAll - kLeast * N);
    const float whole = up_to[count - 1] - before;
    if constexpr (N > 8) end_ = count + 1;
    std::uint32_t first = 1;
    if (whole > 0) {
      const float unit = kFree / whole;
      FourFloats most{};
      for (; first < end_; first += 4) {
        FourFloats part;
        std::memcpy(&part, up_to.data() + first - 1, sizeof part);
        most = greater(growing(greater((part - before) * unit, FourFloats{})),
                       FourFloats{most[3], most[3], most[3], most[3]});
        place(first, count,
              __builtin_convertvector(lesser(most, FourFloats{} + kFree), FourInts) +
                  kLeast * static_cast<std::int32_t>(first));
      }
    } else {
      const std::int32_t share = kAll / static_cast<std::int32_t>(count);
      for (; first < end_; first += 4) {
        const std::int32_t i = static_cast<std::int32_t>(first);
        place(first, count,
              FourInts{i, i + 1, i + 2, i + 3} * share - FourInts{0, 1, 2, 3} * kLeast);
      }
    }
    begin_[0] = 0;
  }
#if defined(CREASE_AVX2)
  // Where those from the second on begin, of at most eight, with eight floats at once; `last`:
  // up_to[count - 1].
  [[gnu::always_inline]] CREASE_AVX2 static __m256i begins_of_eight(__m256 up_to, float before,
                                                                    float last,
                                                                    std::uint32_t count) {
    const float whole = last - before;
    const __m256i next = _mm256_setr_epi32(1, 2, 3, 4, 5, 6, 7, 8);
    const int all = static_cast<int>(count);
    __m256i begin;
    if (whole > 0) [[likely]] {
      constexpr float kFree = static_cast<float>(kAll - kLeast * N);
      const float unit = kFree / whole;
      __m256 most = _mm256_max_ps((up_to - before) * unit, _mm256_setzero_ps());
      most = _mm256_max_ps(most, _mm256_permute_ps(most, 0b10010000));  // 0, 0, 1, 2
      most = _mm256_max_ps(most, _mm256_permute_ps(most, 0b01000100));  // 0, 1, 0, 1
      const __m256i low = _mm256_setr_epi32(0, 0, 0, 0, 3, 3, 3, 3);
      most = _mm256_max_ps(most, _mm256_permutevar8x32_ps(most, low));
      most = _mm256_min_ps(most, _mm256_set1_ps(kFree));
      begin = _mm256_add_epi32(_mm256_cvttps_epi32(most), _mm256_slli_epi32(next, kLeastBits));
    } else {
      begin = _mm256_mullo_epi32(next, _mm256_set1_epi32(static_cast<int>(kAll) / all));
    }
    const __m256i is_one = _mm256_cmpgt_epi32(_mm256_set1_epi32(all), next);
    return _mm256_blendv_epi8(_mm256_set1_epi32(kAll), begin, is_one);
  }
#endif

  // Where it begins; where the last one ends is kAll.
  std::uint32_t begin(std::size_t i) const {
    return begin_[i];
  }
  // Whose share `at` is in, below kAll.
  std::uint32_t find(std::uint32_t at) const {
    std::uint32_t before = 0;  // a bit for each that begins up to there: the first ones
    const std::int32_t most = static_cast<std::int32_t>(at);
    for (std::size_t i = 1; i < (N > 8 ? end_ : N); i += 4) {
      FourInts begin;
      std::memcpy(&begin, begin_.data() + i, sizeof begin);
      before |= negative_lanes(begin <= most) << (i - 1);
    }
    return static_cast<std::uint32_t>(std::countr_one(before));
  }

 private:
  static constexpr int kLeastBits = 3;
  static constexpr std::int32_t kLeast = 1 << kLeastBits;

  // Each the greatest up to there: rounded, sums need not grow.
  static FourFloats growing(const FourFloats& x) {
    const FourFloats one = greater(x, FourFloats{x[0], x[0], x[1], x[2]});
    return greater(one, FourFloats{one[0], one[1], one[0], one[1]});
  }
  // Those from `first` on; kAll from `count` on.
  void place(std::uint32_t first, std::size_t count, FourInts begin) {
    constexpr FourInts kNext{0, 1, 2, 3};
    const FourInts is_one =
        kNext < static_cast<std::int32_t>(count) - static_cast<std::int32_t>(first);
    begin = ((begin + kNext * kLeast) & is_one) | (static_cast<std::int32_t>(kAll) & ~is_one);
    std::memcpy(begin_.data() + first, &begin, sizeof begin);
  }

  std::size_t end_ = N;  // of those that matter; few of many, mostly
  std::array<std::uint32_t, N + 1> begin_;
};

}  // namespace crease::codec
