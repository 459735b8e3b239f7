#include "codec/encode_lattices.h"

#include "base/assert.h"
#include "base/bytes.h"

namespace crease {

std::vector<std::byte> encode_lattices(std::span<const LayerCoding> codings) {
  ByteWriter out;
  for (const LayerCoding& coding : codings) {
    for (const NumberLattice& lattice : coding.components) {
      CREASE_ASSERT(lattice.grain >= 1 && lattice.grain <= kMostGrain);
      out.f32(lattice.divisor);
      out.u32(static_cast<std::uint32_t>(lattice.low));
      out.u32(static_cast<std::uint32_t>(lattice.high));
      out.u16(static_cast<std::uint16_t>(lattice.palette.size()));
      out.u16(static_cast<std::uint16_t>(lattice.grain - 1));
      out.f32s(lattice.palette);
    }
  }
  return out.take();
}

}  // namespace crease
