#include "codec/axis_mixture.h"

#if defined(CREASE_AVX2)
#include <immintrin.h>
#endif

namespace crease::codec {

namespace {

// Where a component's distribution function is z standard widths off its centre, without the half.
EightFloats distribution(const EightFloats& z) {
  return z / root(1.0f + z * z);
}

#if defined(CREASE_AVX2)

// Quotients and roots of eight take as long as those of four: half of what narrowing down takes.
[[gnu::always_inline]] CREASE_AVX2 inline __m256 distribution(__m256 z) {
  return z / _mm256_sqrt_ps(1.0f + z * z);
}

CREASE_AVX2 void weigh_wide(AxisMixture& mixture, float start, float low, float high) {
  const __m256 center = _mm256_loadu_ps(mixture.center.data()) - start;
  const __m256 inverse = _mm256_loadu_ps(mixture.inverse_scale.data());
  const __m256 odds =
      distribution((high - center) * inverse) - distribution((low - center) * inverse);
  _mm256_storeu_ps(mixture.weight.data(), _mm256_loadu_ps(mixture.weight.data()) * odds);
}

#endif

}  // namespace

LikelyComponents::LikelyComponents(const AxisMixture& mixture, std::int32_t start) {
  const EightFloats weight(mixture.weight);
  const EightFloats least(sum_of(weight) * kLeastShare);
  const EightInts counts = weight > least;
  all_ = sum_of(counts & weight);
  const EightFloats inverse(mixture.inverse_scale);
  steepest_ = greatest_of(counts & inverse);
  std::array<std::int32_t, kComponents> one;
  std::array<float, kComponents> centers;
  counts.store(one.data());
  (EightFloats(mixture.center) - static_cast<float>(start)).store(centers);
  for (std::size_t k = 0; k < kComponents; ++k) {
    weight_[count_] = mixture.weight[k];
    center_[count_] = centers[k];
    inverse_scale_[count_] = mixture.inverse_scale[k];
    count_ -= static_cast<std::size_t>(std::int64_t(one[k]));
  }
  weight_[count_] = center_[count_] = inverse_scale_[count_] = 0;  // makes an even number of them
}

Part LikelyComponents::part(const Parts& parts, Which which) const {
#if defined(CREASE_AVX2)
  if (has_avx2()) {
    return wide_part(static_cast<float>(parts.low), static_cast<float>(parts.width), parts.below,
                     static_cast<std::uint32_t>(parts.count), parts.is_endless, which.number,
                     which.is_index);
  }
#endif
  return part_by_fours(parts, which);
}

// Components two by two, since nobody can tell how many they are; where their number is odd, the
// last one weighs nothing.
Part LikelyComponents::part_by_fours(const Parts& parts, Which which) const {
  constexpr std::array<float, 8> kEnds{1, 2, 3, 4, 5, 6, 7, 8};
  const EightFloats y = EightFloats(static_cast<float>(parts.low)) +
                        static_cast<float>(parts.width) * EightFloats(kEnds) - 0.5f;
  EightFloats sum(0.0f);
  for (std::size_t i = 0; i < count_; i += 2) {
    const EightFloats first = distribution((y - center_[i]) * inverse_scale_[i]);
    const EightFloats second = distribution((y - center_[i + 1]) * inverse_scale_[i + 1]);
    sum = sum + weight_[i] * first;
    sum = sum + weight_[i + 1] * second;
  }
  std::array<float, 8> up_to;
  sum.store(up_to);
  if (parts.is_endless) up_to[7] = all_;
  const Shares<8> shares(up_to, parts.below, parts.count);
  const std::uint32_t i = which.is_index ? which.number : shares.find(which.number);
  const float before = i > 0 ? up_to[i - 1] : parts.is_endless ? up_to[0] : parts.below;
  return {i, shares.begin(i), shares.begin(i + 1), before};
}

#if defined(CREASE_AVX2)

CREASE_AVX2 Part LikelyComponents::wide_part(float low, float width, float below,
                                             std::uint32_t count, bool is_endless,
                                             std::uint32_t which, bool is_index) const {
  const __m256 y = low + width * __m256{1, 2, 3, 4, 5, 6, 7, 8} - 0.5f;
  __m256 sum = _mm256_setzero_ps();
  for (std::size_t i = 0; i < count_; i += 2) {
    const __m256 first = distribution((y - center_[i]) * inverse_scale_[i]);
    const __m256 second = distribution((y - center_[i + 1]) * inverse_scale_[i + 1]);
    sum = sum + weight_[i] * first;
    sum = sum + weight_[i + 1] * second;
  }
  // All that a part may need stands behind what the one before it may.
  alignas(32) std::array<float, 16> up_to;
  alignas(32) std::array<std::uint32_t, 16> begins;
  const float all = all_;
  if (is_endless) sum = _mm256_blend_ps(sum, _mm256_set1_ps(all), 1 << 7);
  _mm256_store_ps(&up_to[8], sum);
  const float last = is_endless ? all : up_to[7 + count];
  up_to[7] = is_endless ? up_to[8] : below;
  const __m256i begin = Shares<8>::begins_of_eight(sum, below, last, count);
  begins[7] = 0;
  _mm256_store_si256(reinterpret_cast<__m256i*>(&begins[8]), begin);
  const __m256i is_after = _mm256_cmpgt_epi32(begin, _mm256_set1_epi32(static_cast<int>(which)));
  const auto found = static_cast<std::uint32_t>(std::countr_zero(
      static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(is_after)))));
  const std::uint32_t i = is_index ? which : found;
  return {i, begins[7 + i], begins[8 + i], up_to[7 + i]};
}

#endif

void weigh(AxisMixture& mixture, std::int32_t start, std::int64_t low, std::int64_t width) {
#if defined(CREASE_AVX2)
  if (has_avx2()) {
    return weigh_wide(mixture, static_cast<float>(start), static_cast<float>(low) - 0.5f,
                      static_cast<float>(low + width) - 0.5f);
  }
#endif
  weigh_by_fours(mixture, start, low, width);
}

void weigh_by_fours(AxisMixture& mixture, std::int32_t start, std::int64_t low,
                    std::int64_t width) {
  const float from = static_cast<float>(low) - 0.5f;
  const float to = static_cast<float>(low + width) - 0.5f;
  const EightFloats center = EightFloats(mixture.center) - static_cast<float>(start);
  const EightFloats inverse(mixture.inverse_scale);
  const EightFloats odds =
      distribution((to - center) * inverse) - distribution((from - center) * inverse);
  (EightFloats(mixture.weight) * odds).store(mixture.weight);
}

}  // namespace crease::codec
