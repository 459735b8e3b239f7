#include "codec/decode_block.h"

#include "codec/metering_decoder.h"
#include "codec/range_decoder.h"

#include <string>

namespace crease::codec {

namespace {

template <class Decoder>
Result<DecodedBlock> decode(Decoder& decoder, std::uint32_t block, const BlockCoding& coding,
                            const BlockLimits& limits, CoarseEnd start) {
  NoGuide guide;
  BlockCoder coder(decoder, guide, coding, limits, std::move(start.mesh));
  if (!coder.run()) {
    return fail(Error::BadFormat, "block " + std::to_string(block) + ": its bytes are not a block");
  }
  return DecodedBlock{coder.take_end(block, std::move(start.names)), coder.take_splits()};
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
