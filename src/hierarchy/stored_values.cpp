#include "crease/stored_values.h"

#include "mesh/octahedral.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

namespace crease {

namespace {

constexpr int kShift = 16;

OctahedralCode unpacked(std::uint32_t code) {
  return {code & ((1u << kShift) - 1), code >> kShift};
}

// Of four vectors.
void store_by_turns(const FourFloats& x, const FourFloats& y, const FourFloats& z, Vec3f* found) {
  static_assert(sizeof(Vec3f) == 12);
  const FourFloats z0_x1 = __builtin_shufflevector(z, x, 0, 0, 5, 5);
  const FourFloats y1_z1 = __builtin_shufflevector(y, z, 1, 1, 5, 5);
  const FourFloats z2_x3 = __builtin_shufflevector(z, x, 2, 2, 7, 7);
  const FourFloats y3_z3 = __builtin_shufflevector(y, z, 3, 3, 7, 7);
  const FourFloats x0_y0 = __builtin_shufflevector(x, y, 0, 4, 1, 5);
  const FourFloats x2_y2 = __builtin_shufflevector(x, y, 2, 6, 3, 7);
  const FourFloats by_turns[] = {__builtin_shufflevector(x0_y0, z0_x1, 0, 1, 4, 6),
                                 __builtin_shufflevector(y1_z1, x2_y2, 0, 2, 4, 5),
                                 __builtin_shufflevector(z2_x3, y3_z3, 0, 2, 4, 6)};
  std::memcpy(found, by_turns, sizeof(by_turns));
}

}  // namespace

bool StoredValues::is_finite() const {
  return std::all_of(numbers_.begin(), numbers_.end(), [](float x) { return std::isfinite(x); });
}

Vec3f StoredValues::direction(std::size_t i) const {
  if (is_packed()) return octahedral_direction(max_component_, unpacked(codes_[i]));
  const float* const n = &numbers_[3 * i];
  return {n[0], n[1], n[2]};
}

void StoredValues::directions(std::span<const std::uint32_t> which, std::span<Vec3f> found) const {
  if (!is_packed()) {
    for (std::size_t i = 0; i < which.size(); ++i) found[i] = direction(which[i]);
    return;
  }
  static_assert(OctahedralCoding::kZero.u == 0 && OctahedralCoding::kZero.v == 0);
  const std::uint32_t max_component = max_component_;
  const std::uint32_t* const codes = codes_.data();
  const std::size_t in_fours = which.size() - which.size() % 4;
  for (std::size_t i = 0; i < in_fours; i += 4) {
    const auto code = [&](std::size_t k) { return static_cast<std::int32_t>(codes[which[i + k]]); };
    const FourInts four{code(0), code(1), code(2), code(3)};
    constexpr std::int32_t kMask = (1 << kShift) - 1;
    const auto [x, y, z] =
        octahedral_directions(max_component, four & kMask, four >> kShift & kMask);
    store_by_turns(x, y, z, &found[i]);
  }
  for (std::size_t i = in_fours; i < which.size(); ++i) {
    found[i] = octahedral_direction(max_component, unpacked(codes[which[i]]));
  }
}

StoredValue StoredValues::operator[](std::size_t i) const {
  StoredValue value;
  value.dimension = dimension_;
  if (is_packed()) {
    const Vec3f n = direction(i);
    value.numbers = {n.x, n.y, n.z, 0};
  } else {
    std::copy_n(&numbers_[dimension_ * i], dimension_, value.numbers.begin());
  }
  return value;
}

StoredValues StoredValues::chosen(std::span<const std::uint32_t> which) const {
  StoredValues result;
  result.dimension_ = dimension_;
  result.max_component_ = max_component_;
  if (is_packed()) {
    result.codes_.reserve(which.size());
    for (const std::uint32_t i : which) result.codes_.push_back(codes_[i]);
    return result;
  }
  result.numbers_.reserve(dimension_ * which.size());
  for (const std::uint32_t i : which) {
    const auto first = numbers_.begin() + static_cast<std::ptrdiff_t>(dimension_ * std::size_t(i));
    result.numbers_.insert(result.numbers_.end(), first, first + dimension_);
  }
  return result;
}

void StoredValues::pack_directions() {
  if (dimension_ != 3 || is_packed() || numbers_.empty()) return;
  const std::optional<int> bits = octahedral_bits_of(numbers_);
  if (!bits) return;
  const OctahedralCoding coding(*bits);
  codes_.reserve(numbers_.size() / 3);
  for (std::size_t i = 0; i < numbers_.size(); i += 3) {
    const auto code = coding.exact_code({numbers_[i], numbers_[i + 1], numbers_[i + 2]});
    codes_.push_back(code->u | code->v << kShift);
  }
  max_component_ = coding.max_component();
  numbers_ = {};
}

}  // namespace crease
