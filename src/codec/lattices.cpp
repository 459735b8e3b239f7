#include "codec/lattices.h"

#include "base/bytes.h"

#include <cmath>

namespace crease {

namespace {

constexpr std::int32_t kMostCode = 1 << 24;  // exact as a float

bool is_lattice(const NumberLattice& lattice) {
  if (lattice.low > lattice.high || lattice.low < -kMostCode || lattice.high > kMostCode) {
    return false;
  }
  if (lattice.grain < 1 || lattice.low % lattice.grain != 0 || lattice.high % lattice.grain != 0) {
    return false;
  }
  if (lattice.palette.empty()) return std::isfinite(lattice.divisor) && lattice.divisor > 0;
  for (std::size_t i = 0; i < lattice.palette.size(); ++i) {
    if (!std::isfinite(lattice.palette[i])) return false;
    if (i > 0 && !(lattice.palette[i - 1] < lattice.palette[i])) return false;
  }
  return lattice.palette.size() == std::size_t((lattice.high - lattice.low) / lattice.grain) + 1;
}

// The largest quotient must be finite as well.
bool has_finite_values(const NumberLattice& lattice) {
  return std::isfinite(lattice.value(lattice.low)) && std::isfinite(lattice.value(lattice.high));
}

NumberLattice decode_lattice(ByteReader& in) {
  NumberLattice lattice;
  lattice.divisor = in.f32();
  lattice.low = static_cast<std::int32_t>(in.u32());
  lattice.high = static_cast<std::int32_t>(in.u32());
  const std::uint32_t entries = in.u16();
  lattice.grain = in.u16() + 1;
  if (entries > in.remaining() / 4) {
    lattice = {};
    lattice.divisor = 0;  // no lattice
    return lattice;
  }
  for (std::uint32_t i = 0; i < entries; ++i) lattice.palette.push_back(in.f32());
  return lattice;
}

LayerCoding::Kind kind_of(AttributeCoding coding) {
  switch (coding) {
    case AttributeCoding::Floats:
      return LayerCoding::Kind::Exact;
    case AttributeCoding::Lattice:
      return LayerCoding::Kind::Lattice;
    case AttributeCoding::Octahedral:
      return LayerCoding::Kind::Octahedral;
    case AttributeCoding::Sextant:
      return LayerCoding::Kind::Sextant;
  }
  return LayerCoding::Kind::Exact;
}

}  // namespace

Result<std::vector<LayerCoding>> decode_codings(std::span<const LayerSchema> layers,
                                                std::span<const std::byte> tables) {
  ByteReader in(tables);
  std::vector<LayerCoding> codings;
  for (const LayerSchema& layer : layers) {
    LayerCoding& coding = codings.emplace_back();
    coding.kind = kind_of(layer.coding);
    coding.bits = layer.bits;
    if (coding.kind != LayerCoding::Kind::Lattice) continue;
    for (int k = 0; k < layer.dimension; ++k) {
      NumberLattice& lattice = coding.components.emplace_back(decode_lattice(in));
      if (in.truncated() || !is_lattice(lattice) || !has_finite_values(lattice)) {
        return fail(Error::BadFormat,
                    "model tables: a lattice of layer '" + layer.name + "' is none");
      }
    }
  }
  if (in.remaining() != 0) return fail(Error::BadFormat, "model tables: bytes behind the lattices");
  return codings;
}

}  // namespace crease
