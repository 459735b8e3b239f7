// What a directory page says of its blocks: numbers after what the block before them has, and
// adaptive bits (docs/format.md, "Entries"). One body for both directions, as coded_numbers.h.
#pragma once

#include "codec/coded_numbers.h"
#include "codec/container.h"
#include "codec/decode_block.h"
#include "codec/errors_model.h"
#include "crease/block_file.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace crease::codec {

// Of a block, beside where it lies and the checksum of its payload.
struct PageEntry {
  BlockFacts facts;
  std::uint32_t bytes = 0;  // of the payload
};

template <class Coder>
class PageCoder {
 public:
  PageCoder(Coder& coder, const ModelFacts& model)
      : coder_(coder), layer_count_(model.layers.size()) {
    before_.facts.band = static_cast<std::uint16_t>(model.bands.size());
  }

  // The next block. Its sphere and its errors are as rounded_up() has them.
  PageEntry code(const PageEntry& entry) {
    PageEntry coded;
    const BlockFacts &facts = entry.facts, &before = before_.facts;
    code_place_in_file(facts, coded.facts);
    code_counts(facts, coded.facts);
    const std::uint64_t each = std::max(before.splits, 1u), now = std::max(coded.facts.splits, 1u);
    const std::uint64_t expected = before_.bytes * now / each;
    coded.bytes = code_after(bytes_, entry.bytes, static_cast<std::uint32_t>(expected));
    code_sphere(facts, coded.facts);
    coded.facts.coarse = coarse_.code(coder_, facts.coarse);
    coded.facts.fine = fine_.code(coder_, facts.fine);
    before_ = coded;
    return coded;
  }

  // How many blocks it needs; then each of them, ascending.
  std::uint32_t code_dependency_count(std::uint32_t count) {
    is_first_dependency_ = true;
    return code_magnitude(coder_, dependency_count_, count);
  }
  std::uint32_t code_dependency(std::uint32_t id) {
    if (is_first_dependency_) {
      dependency_ = first_dependency_ = code_after(first_, id, first_dependency_);
    } else {
      dependency_ += 1 + code_magnitude(coder_, gap_, id - dependency_ - 1);
    }
    is_first_dependency_ = false;
    return dependency_;
  }

  // Something came that no writer writes.
  bool failed() const { return coder_.failed() || is_wrong_ || coarse_.failed() || fine_.failed(); }

 private:
  std::uint32_t code_after(SignedModel& model, std::uint32_t value, std::uint32_t expected) {
    return codec::code_after(coder_, model, value, expected);
  }
  std::uint32_t code_limited(SignedModel& model, std::uint32_t value, std::uint32_t expected,
                             std::uint32_t most) {
    const std::uint32_t coded = code_after(model, value, expected);
    is_wrong_ |= coded > most;
    return std::min(coded, most);
  }

  void code_place_in_file(const BlockFacts& facts, BlockFacts& coded) {
    const BlockFacts& before = before_.facts;
    coded.band = static_cast<std::uint16_t>(code_limited(band_, facts.band, before.band, 0xffff));
    const bool is_next = has_before_ && coded.band == before.band;
    coded.patch = code_after(patch_, facts.patch, is_next ? before.patch + 1 : 0);
    has_before_ = true;
  }

  void code_counts(const BlockFacts& facts, BlockFacts& coded) {
    const BlockFacts& before = before_.facts;
    coded.splits = code_after(splits_, facts.splits, before.splits);
    coded.triangles_coarse =
        code_after(triangles_coarse_, facts.triangles_coarse, before.triangles_coarse);
    // Most splits add two triangles, and half as many vertices as triangles are usual.
    const std::uint32_t fine = coded.triangles_coarse + 2 * coded.splits;
    const std::uint32_t fine_before = before.triangles_coarse + 2 * before.splits;
    coded.triangles_fine = code_after(triangles_fine_, facts.triangles_fine,
                                      fine + before.triangles_fine - fine_before);
    coded.vertices =
        code_after(vertices_, facts.vertices,
                   coded.triangles_fine / 2 + before.vertices - before.triangles_fine / 2);
    const std::uint64_t memory =
        codec::decoded_bytes({coded.vertices, coded.triangles_fine}, layer_count_);
    coded.decoded_bytes =
        code_after(decoded_bytes_, facts.decoded_bytes, static_cast<std::uint32_t>(memory));
  }

  void code_sphere(const BlockFacts& facts, BlockFacts& coded) {
    const BlockFacts& before = before_.facts;
    coded.radius = format::radius_of_code(
        code_limited(radius_, format::code_of_radius(facts.radius),
                     format::code_of_radius(before.radius), format::kMaxRadiusCode));
    const int shift = format::sphere_shift(coded.radius);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<int>(k);
      const auto in_steps = [&](const BlockFacts& of) {
        return static_cast<std::uint32_t>(of.center[axis] >> shift);
      };
      const std::uint32_t steps = code_after(center_[k], in_steps(facts), in_steps(before));
      coded.center[axis] = static_cast<std::int32_t>(steps << shift);
    }
  }

  Coder& coder_;
  std::size_t layer_count_;
  PageEntry before_;  // at first none: all is 0, but the band
  bool has_before_ = false, is_wrong_ = false;
  std::uint32_t first_dependency_ = 0, dependency_ = 0;  // the last block's first; the last one
  bool is_first_dependency_ = true;

  SignedModel band_, patch_, splits_, triangles_coarse_, triangles_fine_, vertices_;
  SignedModel decoded_bytes_, bytes_, radius_, first_;
  std::array<SignedModel, 3> center_;
  ErrorsModel coarse_, fine_;
  MagnitudeModel dependency_count_, gap_;
};

}  // namespace crease::codec
