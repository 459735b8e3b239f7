// How finely attribute values are kept: what --normal-bits, --texcoord-bits and --color-bits ask
// for.
//
//   BuildOptions options;
//   options.attributes.normal_bits = 12;
//
// Values are snapped once, before simplification, as positions are; from there on they are exact.
#pragma once

#include <cstdint>

namespace crease {

enum class NormalCoding : std::uint8_t {
  Octahedral,  // bits a component, 8 to 16
  Deering,     // G03's sextants: bits an angle, 4 to 12; 6 are its 17 bits a normal
};

inline constexpr int kExactBits = 0;  // values as they are, floats

struct AttributePrecision {
  NormalCoding normal_coding = NormalCoding::Octahedral;
  // Files of version 1 hold floats, so that coarser values would save nothing. With 10 bits normals
  // are off by 0.16 degrees at most, and shading that grows with the cosine by 0.7 of a step of an
  // 8-bit display (docs/attributes.md).
  int normal_bits = kExactBits;
  // Over the range of each component: off by at most its 2^-(bits + 1). Values that already lie on
  // a lattice as coarse, or are few, are kept exactly.
  int texcoord_bits = kExactBits;
  int color_bits = kExactBits;
};

}  // namespace crease
