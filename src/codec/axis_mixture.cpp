#include "codec/axis_mixture.h"

#include "base/wide.h"

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

CREASE_AVX2 void ends_of(std::size_t count, const float* weight, const float* center,
                         const float* inverse_scale, float low, float width, float* ends) {
  const __m256 y = low + width * __m256{1, 2, 3, 4, 5, 6, 7, 8} - 0.5f;
  __m256 sum{};
  for (std::size_t i = 0; i < count; i += 2) {
    const __m256 first = distribution((y - center[i]) * inverse_scale[i]);
    const __m256 second = distribution((y - center[i + 1]) * inverse_scale[i + 1]);
    sum = sum + weight[i] * first;
    sum = sum + weight[i + 1] * second;
  }
  _mm256_storeu_ps(ends, sum);
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
  steepest_ = greatest_of(counts & EightFloats(mixture.inverse_scale));
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

void LikelyComponents::at_ends(std::int64_t low, std::int64_t width,
                               std::array<float, 8>& ends) const {
#if defined(CREASE_AVX2)
  if (has_avx2()) {
    return ends_of(count_, weight_.data(), center_.data(), inverse_scale_.data(),
                   static_cast<float>(low), static_cast<float>(width), ends.data());
  }
#endif
  at_ends_by_fours(low, width, ends);
}

void LikelyComponents::at_ends_by_fours(std::int64_t low, std::int64_t width,
                                        std::array<float, 8>& ends) const {
  constexpr std::array<float, 8> kEnds{1, 2, 3, 4, 5, 6, 7, 8};
  const EightFloats y =
      EightFloats(static_cast<float>(low)) + static_cast<float>(width) * EightFloats(kEnds) - 0.5f;
  EightFloats sum(0.0f);
  for (std::size_t i = 0; i < count_; i += 2) {
    const EightFloats first = distribution((y - center_[i]) * inverse_scale_[i]);
    const EightFloats second = distribution((y - center_[i + 1]) * inverse_scale_[i + 1]);
    sum = sum + weight_[i] * first;
    sum = sum + weight_[i + 1] * second;
  }
  sum.store(ends);
}

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
