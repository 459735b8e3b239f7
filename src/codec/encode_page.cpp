#include "codec/encode_page.h"

#include "base/bytes.h"
#include "codec/checksum.h"
#include "codec/container.h"
#include "codec/page_coder.h"
#include "codec/range_encoder.h"

#include <cmath>
#include <limits>

namespace crease {

namespace {

float rounded_up(float error) {
  return format::error_of_code(format::code_of_error(error));
}

LevelError rounded_up(const LevelError& e) {
  return {rounded_up(e.surface), rounded_up(e.line), rounded_up(e.degrees), rounded_up(e.texture)};
}

// The multiple of 2^shift next to `x`, and none that is too large.
std::int32_t rounded(std::int32_t x, int shift) {
  const std::int64_t step = std::int64_t(1) << shift;
  std::int64_t nearest = (std::int64_t(x) + step / 2) >> shift << shift;
  if (nearest > std::numeric_limits<std::int32_t>::max()) nearest -= step;
  return static_cast<std::int32_t>(nearest);
}

// False: it is too large. A radius that is rounded up may need a digit more, and its centre then a
// larger step.
bool round_sphere(BlockFacts& facts) {
  const Vec3i center = facts.center;
  const std::uint32_t radius = facts.radius;
  for (int shift = format::sphere_shift(radius); shift <= format::kMaxSphereShift; ++shift) {
    double squared = 0;
    for (int k = 0; k < 3; ++k) {
      facts.center[k] = rounded(center[k], shift);
      const double aside = double(facts.center[k]) - double(center[k]);
      squared += aside * aside;
    }
    const std::uint64_t needed = radius + static_cast<std::uint64_t>(std::ceil(std::sqrt(squared)));
    const std::uint64_t steps = (needed + (std::uint64_t(1) << shift) - 1) >> shift;
    if (steps >= 2 * format::kRadiusSteps) continue;
    facts.radius = static_cast<std::uint32_t>(steps << shift);
    return true;
  }
  return false;
}

}  // namespace

std::optional<BlockFacts> rounded_up(const BlockFacts& facts) {
  BlockFacts rounded = facts;
  rounded.coarse = rounded_up(facts.coarse);
  rounded.fine = rounded_up(facts.fine);
  if (!round_sphere(rounded)) return std::nullopt;
  return rounded;
}

std::vector<std::byte> encode_page(const DirectoryPage& page, std::uint32_t number,
                                   const ModelFacts& model) {
  ByteWriter body;
  body.u32(number);
  body.u32(static_cast<std::uint32_t>(page.dependencies.size()));
  codec::RangeEncoder encoder;
  codec::PageCoder<codec::RangeEncoder> coder(encoder, model);
  for (const BlockEntry& entry : page.blocks) {
    body.u32(entry.checksum);
    coder.code({entry.facts, entry.bytes});
    const auto needed = page.dependencies_of(entry.id);
    coder.code_dependency_count(static_cast<std::uint32_t>(needed.size()));
    for (const BlockId id : needed) coder.code_dependency(static_cast<std::uint32_t>(id));
  }
  body.append(encoder.finish());
  ByteWriter out;
  out.u64(checksum(body.bytes()));
  out.append(body.bytes());
  return out.take();
}

}  // namespace crease
