#include "codec/layer_coding.h"

#include "base/assert.h"

namespace crease {

LayerQuantizer::LayerQuantizer(const LayerCoding& coding) : coding_(coding) {
  if (coding.kind == LayerCoding::Kind::Octahedral) octahedral_.emplace(coding.bits);
  if (coding.kind == LayerCoding::Kind::Sextant) sextant_.emplace(coding.bits);
}

void LayerQuantizer::snap(std::span<float> value) const {
  switch (coding_.kind) {
    case LayerCoding::Kind::Exact:
      return;
    case LayerCoding::Kind::Octahedral:
    case LayerCoding::Kind::Sextant: {
      CREASE_ASSERT(value.size() == 3);
      const Vec3f given{value[0], value[1], value[2]};
      const Vec3f n = octahedral_ ? octahedral_->decode(octahedral_->encode(given))
                                  : sextant_->decode(sextant_->encode(given));
      for (int k = 0; k < 3; ++k) value[static_cast<std::size_t>(k)] = n[k];
      return;
    }
    case LayerCoding::Kind::Lattice:
      CREASE_ASSERT(value.size() == coding_.components.size());
      for (std::size_t k = 0; k < value.size(); ++k) {
        const NumberLattice& lattice = coding_.components[k];
        value[k] = lattice.value(lattice.nearest(value[k]));
      }
      return;
  }
}

}  // namespace crease
