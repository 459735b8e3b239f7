#include "codec/number_lattice.h"

#include <algorithm>
#include <cmath>

namespace crease {

float NumberLattice::value(std::int32_t code) const {
  if (palette.empty()) return static_cast<float>(code) / divisor;
  const auto entry = static_cast<std::size_t>((code - low) / grain);
  const std::int32_t beyond = (code - low) % grain;
  if (beyond == 0) return palette[entry];
  // Both products are exact, so it is the same whether or not one is fused with the sum.
  const double below = double(palette[entry]) * double(grain - beyond);
  return static_cast<float>((below + double(palette[entry + 1]) * double(beyond)) / double(grain));
}

std::int32_t NumberLattice::nearest(float value) const {
  if (!palette.empty()) {
    const auto above = std::upper_bound(palette.begin(), palette.end(), value);
    if (above == palette.begin()) return low;
    if (above == palette.end()) return high;
    const auto entry = static_cast<std::int32_t>(above - palette.begin()) - 1;
    const double from = double(*(above - 1)), to = double(*above);
    const double beyond = std::ceil((double(value) - from) * double(grain) / (to - from) - 0.5);
    return low + entry * grain + static_cast<std::int32_t>(beyond);
  }
  const double code = std::ceil(double(value) * double(divisor) - 0.5);  // a product of 48 bits
  return static_cast<std::int32_t>(std::clamp(code, double(low), double(high)));
}

}  // namespace crease
