#include "codec/number_lattice.h"

#include <algorithm>
#include <cmath>

namespace crease {

float NumberLattice::value(std::int32_t code) const {
  if (!palette.empty()) return palette[static_cast<std::size_t>(code - low)];
  return static_cast<float>(code) / divisor;
}

std::int32_t NumberLattice::nearest(float value) const {
  if (!palette.empty()) {
    const auto above = std::lower_bound(palette.begin(), palette.end(), value);
    auto at = static_cast<std::int32_t>(above - palette.begin());
    if (above == palette.end() ||
        (at > 0 && double(value) - double(*(above - 1)) <= double(*above) - double(value))) {
      --at;
    }
    return low + at;
  }
  const double code = std::ceil(double(value) * double(divisor) - 0.5);  // a product of 48 bits
  return static_cast<std::int32_t>(std::clamp(code, double(low), double(high)));
}

}  // namespace crease
