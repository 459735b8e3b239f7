#include "crease/progressive_arrays.h"
#include "hierarchy/packed_contraction.h"

#include <algorithm>
#include <vector>

namespace crease {

std::uint32_t hierarchy_depth(const ProgressiveArrays& arrays) {
  const PackedContractions& packed = arrays.contractions;
  std::vector<std::uint32_t> depth_of_slot(arrays.full.vertices());
  // The slot that a contraction removes is the last active one of its section.
  std::uint32_t sn_end = arrays.full.sn_vertices;
  std::uint32_t nsn_end = static_cast<std::uint32_t>(arrays.full.vertices());
  std::size_t wide = 0;
  std::uint32_t deepest = 0;
  for (std::size_t i = 0; i < packed.count(); ++i) {
    const PackedHeader header = unpack_header(packed.headers[i]);
    const std::uint32_t removed = (header.removed_is_nsn ? nsn_end : sn_end) - 1;
    std::uint32_t& kept = depth_of_slot[packed.kept[i]];
    kept = std::max(kept, depth_of_slot[removed]) + 1;
    deepest = std::max(deepest, kept);
    const SectionCounts& lost = header.is_wide ? packed.wide[wide++].lost : header.lost;
    sn_end -= lost.sn_vertices;
    nsn_end -= lost.nsn_vertices;
  }
  return deepest;
}

}  // namespace crease
