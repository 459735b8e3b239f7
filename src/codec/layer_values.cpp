#include "codec/layer_values.h"

#include <algorithm>
#include <bit>

namespace crease {

namespace {

// A sextant code as one number: octant and order above the two angles, 13 bits each.
constexpr int kAngleBits = 13;
constexpr std::uint32_t kAngleMask = (1u << kAngleBits) - 1;

std::int32_t packed(SextantCode c) {
  const std::uint32_t where = c.octant * 6u + c.sextant;
  return static_cast<std::int32_t>((where << kAngleBits | c.theta) << kAngleBits | c.phi);
}

SextantCode unpacked(std::int32_t bits) {
  const std::uint32_t all = static_cast<std::uint32_t>(bits);
  const std::uint32_t where = all >> 2 * kAngleBits;
  return {static_cast<std::uint8_t>(where / 6), static_cast<std::uint8_t>(where % 6),
          static_cast<std::uint16_t>(all >> kAngleBits & kAngleMask),
          static_cast<std::uint16_t>(all & kAngleMask)};
}

void write(const Vec3f& direction, std::span<float> value) {
  for (int k = 0; k < 3; ++k) value[static_cast<std::size_t>(k)] = direction[k];
}

}  // namespace

LayerValues::LayerValues(const LayerCoding& coding, std::uint32_t dimension)
    : coding_(coding), dimension_(dimension) {
  if (coding.kind == LayerCoding::Kind::Octahedral) octahedral_.emplace(coding.bits);
  if (coding.kind == LayerCoding::Kind::Sextant) sextant_.emplace(coding.bits);
}

codec::CodedValue LayerValues::code(std::span<const float> value) const {
  if (octahedral_) return codec::coded(octahedral_->encode(Vec3f{value[0], value[1], value[2]}));
  if (sextant_) return {packed(sextant_->encode(Vec3f{value[0], value[1], value[2]})), 0, 0, 0};
  codec::CodedValue code{};
  for (std::size_t k = 0; k < value.size(); ++k) {
    code[k] = coding_.kind == LayerCoding::Kind::Lattice ? coding_.components[k].nearest(value[k])
                                                         : std::bit_cast<std::int32_t>(value[k]);
  }
  return code;
}

codec::CodedValue LayerValues::nearest_code(std::span<const float> value) const {
  if (!octahedral_) return code(value);
  return codec::coded(
      octahedral_->encode(Vec3d{double(value[0]), double(value[1]), double(value[2])}));
}

void LayerValues::read(const codec::CodedValue& code, std::span<float> value) const {
  if (octahedral_) {
    const OctahedralCode c = codec::octahedral_code(code);
    const std::uint32_t most = octahedral_->max_component();
    write(octahedral_->decode({std::min(c.u, most), std::min(c.v, most)}), value);
  } else if (sextant_) {
    const SextantCode c = unpacked(code[0]);
    const bool is_one = c.octant < 8 && c.theta <= sextant_->angle_count() &&
                        c.phi <= sextant_->angle_count() && sextant_->is_canonical(c);
    write(sextant_->decode(is_one ? c : sextant_->zero()), value);
  } else {
    for (std::size_t k = 0; k < value.size(); ++k) {
      const bool lattice = coding_.kind == LayerCoding::Kind::Lattice;
      value[k] = lattice ? coding_.components[k].value(std::clamp(
                               code[k], coding_.components[k].low, coding_.components[k].high))
                         : std::bit_cast<float>(code[k]);
    }
  }
}

codec::BlockLayer LayerValues::in_block(bool is_normal) const {
  codec::BlockLayer layer{.dimension = sextant_ ? 1 : static_cast<int>(dimension_),
                          .is_normal = is_normal,
                          .octahedral_bits = octahedral_ ? coding_.bits : 0,
                          .is_raw = sextant_ || coding_.kind == LayerCoding::Kind::Exact};
  for (std::size_t k = 0; k < coding_.components.size(); ++k) {
    layer.grains[k] = coding_.components[k].grain;
  }
  return layer;
}

codec::BlockCoding block_coding(std::span<const LayerSchema> layers,
                                std::span<const LayerCoding> codings, std::size_t material_count,
                                std::size_t part_count) {
  codec::BlockCoding coding;
  for (std::size_t l = 0; l < layers.size(); ++l) {
    coding.layers.push_back(LayerValues(codings[l], layers[l].dimension)
                                .in_block(layers[l].role == AttributeRole::Normal));
  }
  coding.material_count = std::max<std::uint32_t>(1, static_cast<std::uint32_t>(material_count));
  coding.part_count = std::max<std::uint32_t>(1, static_cast<std::uint32_t>(part_count));
  return coding;
}

}  // namespace crease
