#include "crease/stored_values.h"

#include "mesh/octahedral.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace crease {

namespace {

constexpr int kShift = 16;

OctahedralCode unpacked(std::uint32_t code) {
  return {code & ((1u << kShift) - 1), code >> kShift};
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
    FourInts u, v;
    for (std::size_t k = 0; k < 4; ++k) {
      const OctahedralCode code = unpacked(codes[which[i + k]]);
      u[k] = static_cast<std::int32_t>(code.u), v[k] = static_cast<std::int32_t>(code.v);
    }
    const auto [x, y, z] = octahedral_directions(max_component, u, v);
    for (std::size_t k = 0; k < 4; ++k) found[i + k] = {x[k], y[k], z[k]};
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
