// How the values of an attribute layer are written: which coding, and with what precision. The
// values of a layer that was snapped (pipeline/snap_attributes.h) are codes of it, exactly.
//
//   const LayerQuantizer quantizer(coding);
//   quantizer.snap(value);            // in place; a second time changes nothing
#pragma once

#include "codec/number_lattice.h"
#include "codec/sextant.h"
#include "mesh/octahedral.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace crease {

struct LayerCoding {
  enum class Kind : std::uint8_t {
    Exact,       // floats, bit for bit
    Octahedral,  // directions of three components
    Sextant,     // the same, Deering's coding
    Lattice,     // each component on its own
  };
  Kind kind = Kind::Exact;
  int bits = 0;                           // Octahedral: a component; Sextant: an angle
  std::vector<NumberLattice> components;  // Lattice: one a component
  bool operator==(const LayerCoding&) const = default;
};

class LayerQuantizer {
 public:
  explicit LayerQuantizer(const LayerCoding& coding);

  // The nearest value that the coding has. As many numbers as the layer has components, all finite.
  void snap(std::span<float> value) const;

 private:
  const LayerCoding& coding_;
  std::optional<OctahedralCoding> octahedral_;
  std::optional<SextantCoding> sextant_;
};

}  // namespace crease
