// Any bytes are a Failure or a block within the limits, and so is what is decoded from where that
// ends. The first byte says how the attributes are coded, the second where the second block begins.
#include "codec/decode_block.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

namespace {

using namespace crease;
using namespace crease::codec;

constexpr BlockLimits kLimits{2000, 4000};

void require_within_limits(const PatchMesh& mesh) {
  if (mesh.positions.size() > kLimits.vertices || mesh.triangles.size() > kLimits.triangles) {
    std::abort();
  }
  for (const Corners& corners : mesh.triangles) {
    for (const std::uint32_t v : corners) {
      if (v >= mesh.positions.size()) std::abort();
    }
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) {
      std::abort();
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const std::span<const std::byte> bytes = std::as_bytes(std::span(data, size)).subspan(2);
  BlockCoding coding;
  if (data[0] & 1) {
    coding.layers.push_back({.dimension = 2, .is_normal = true, .octahedral_bits = 10});
  }
  if (data[0] & 2) coding.layers.push_back({.dimension = 2});
  if (data[0] & 4) coding.layers.push_back({.dimension = 1, .is_raw = true});
  if (data[0] & 8) coding.material_count = 7;
  if (data[0] & 16) coding.part_count = 70'000;
  if (data[0] & 32) coding.rates = kRatesBefore;
  const std::size_t first = bytes.size() * data[1] / 256;
  Result<DecodedBlock> base = decode_block(bytes.first(first), 0, coding, kLimits, {});
  if (!base.ok()) return 0;
  require_within_limits(base->end.mesh);
  std::vector<CoarseEnd> starts = sort_by_label(std::span(&base->end, 1), 1);
  const Result<DecodedBlock> next =
      decode_block(bytes.subspan(first), 1, coding, kLimits, std::move(starts[0]));
  if (next.ok()) require_within_limits(next->end.mesh);
  return 0;
}
