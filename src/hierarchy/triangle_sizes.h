// How large the triangles of a mesh are, but for a few that are far larger than all others.
//
//   TriangleSizes sizes;
//   for each triangle: sizes.add(area);
//   sizes.mean()   // of all, those beyond most() counted as that large
//
// A model on a ground a thousand times its size has two triangles with nearly all of the area. What
// a normal is worth beside a distance follows from how large triangles are: measured by the
// ground's it would decide all of the model's shape.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace crease {

class TriangleSizes {
 public:
  // In any unit, finite, not negative. Sums depend on the order in which areas come.
  void add(double area) {
    Bin& bin = bins_[exponent_of(area)];
    ++bin.count;
    bin.area += area;
    ++count_;
  }

  std::uint64_t count() const { return count_; }

  // Beyond it an area counts as this much: about kTimes what all but a tenth are within.
  double most() const {
    std::uint64_t within = 0;
    for (const Bin& bin : bins_) {
      within += bin.count;
      if (within * 10 >= count_ * 9 && bin.area > 0) return kTimes * bin.area / double(bin.count);
    }
    return 0;
  }

  double mean() const {
    const double limit = most();
    double sum = 0;
    for (const Bin& bin : bins_) sum += std::min(bin.area, limit * double(bin.count));
    return count_ > 0 ? sum / double(count_) : 0;
  }

 private:
  struct Bin {
    std::uint64_t count = 0;
    double area = 0;
  };
  // Scans, machines and cities have nothing beyond it, or next to nothing.
  static constexpr double kTimes = 64;

  static std::size_t exponent_of(double area) {
    const std::uint32_t exponent = std::bit_cast<std::uint32_t>(static_cast<float>(area)) >> 23;
    return std::min<std::size_t>(exponent, kBins - 1);  // whatever the number is
  }

  static constexpr std::size_t kBins = 256;
  std::array<Bin, kBins> bins_{};  // by powers of two
  std::uint64_t count_ = 0;
};

// How much of space a texture covers. `most`: of TriangleSizes; of a larger triangle a part of that
// size counts.
class TextureSize {
 public:
  explicit TextureSize(double most) : most_(most) {}

  // a, b, c: two texture coordinates each.
  void add(double area, const float* a, const float* b, const float* c) {
    const double of_texture = 0.5 * std::abs(double(b[0] - a[0]) * double(c[1] - a[1]) -
                                             double(c[0] - a[0]) * double(b[1] - a[1]));
    for (const float* uv : {a, b, c}) {
      for (int i = 0; i < 2; ++i) {
        low_[i] = std::min(low_[i], uv[i]);
        high_[i] = std::max(high_[i], uv[i]);
      }
    }
    space_ += std::min(area, most_);
    texture_ += area > most_ ? of_texture * (most_ / area) : of_texture;
  }

  // Squared length in space of one unit of the texture. 0: triangles have next to no area there, as
  // where each shows one texel of a palette; what is left of it is rounding.
  double unit2() const {
    const double range = (double(high_[0]) - low_[0]) * (double(high_[1]) - low_[1]);
    return texture_ > kPalette * std::max(range, 0.0) ? space_ / texture_ : 0;
  }

 private:
  static constexpr double kPalette = 1e-3;  // of what the coordinates span; charts have 0.05 to 1

  double most_, space_ = 0, texture_ = 0;
  float low_[2] = {HUGE_VALF, HUGE_VALF}, high_[2] = {-HUGE_VALF, -HUGE_VALF};
};

}  // namespace crease
