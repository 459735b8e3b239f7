#include "codec/decode_block.h"

#include "codec/metering_decoder.h"
#include "codec/range_decoder.h"

#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace crease::codec {

namespace {

// Whether those that a coarser block is said to have made may be: no two vertices are one, or their
// triangles would have no third corner in the next band.
bool are_names(std::span<const VertexName> names, std::size_t coarse_count, std::uint32_t block) {
  bool any = false;
  for (std::size_t v = coarse_count; v < names.size(); ++v) {
    if (names[v] == VertexName{block, static_cast<std::uint32_t>(v)}) continue;
    if (names[v].block >= block) return false;
    any = true;
  }
  if (!any) return true;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sorted;
  for (const VertexName& name : names) sorted.emplace_back(name.block, name.vertex);
  std::sort(sorted.begin(), sorted.end());
  return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
}

template <class Decoder>
Result<DecodedBlock> decode(Decoder& decoder, std::uint32_t block, const BlockCoding& coding,
                            const BlockLimits& limits, CoarseEnd start) {
  NoGuide guide;
  BlockCoder coder(decoder, guide, coding, limits, std::move(start.mesh));
  const auto bad = [block](const char* what) {
    return fail(Error::BadFormat, "block " + std::to_string(block) + ": " + what);
  };
  if (!coder.run()) return bad("its bytes are not a block");
  const std::size_t coarse_count = start.names.size();
  DecodedBlock decoded{coder.take_end(block, std::move(start.names)), coder.take_splits()};
  if (!are_names(decoded.end.names, coarse_count, block)) {
    return bad("a vertex has a name that is another's");
  }
  return decoded;
}

}  // namespace

Result<DecodedBlock> decode_block(std::span<const std::byte> bytes, std::uint32_t block,
                                  const BlockCoding& coding, const BlockLimits& limits,
                                  CoarseEnd start, StreamBits* bits) {
  if (bits) {
    MeteringDecoder decoder(bytes, *bits);
    return decode(decoder, block, coding, limits, std::move(start));
  }
  RangeDecoder decoder(bytes);
  return decode(decoder, block, coding, limits, std::move(start));
}

}  // namespace crease::codec
