// How finely attribute values are kept: what --normal-bits, --texcoord-bits and --color-bits ask
// for.
//
//   BuildOptions options;
//   options.attributes.normal_bits = 12;
//
// Values are snapped once, before simplification, as positions are; from there on they are exact.
#pragma once

#include "crease/result.h"

#include <cstdint>

namespace crease {

enum class NormalCoding : std::uint8_t {
  Octahedral,  // bits a component, 8 to 16
  Deering,     // G03's sextants: bits an angle, 4 to 12; 6 are its 17 bits a normal
};

inline constexpr int kExactBits = 0;  // values as they are, floats; beside all ranges

struct AttributePrecision {
  NormalCoding normal_coding = NormalCoding::Octahedral;
  // With 12 bits normals are off by 0.04 degrees at most, which not even a mirror shows
  // (docs/attributes.md).
  int normal_bits = 12;
  // Over the range of each component: off by at most its 2^-(bits + 1), and, where textures repeat,
  // by about 2^(1 - bits) of one. Values that already lie on a lattice as coarse, or are few, are
  // kept exactly. 4 to 16, both.
  int texcoord_bits = 14;
  int color_bits = 10;
};

// Fails with BadValue, saying which bits are out of their range.
Status check_attribute_precision(const AttributePrecision& precision);

}  // namespace crease
