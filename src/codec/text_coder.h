// Names one after the other, which mostly begin as the one before them did and go on in ways that
// were seen (docs/format.md, "Names"). One body for both directions, as coded_numbers.h.
#pragma once

#include "codec/coded_numbers.h"
#include "codec/mixed_bit.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace crease::codec {

template <class Coder>
class TextCoder {
 public:
  explicit TextCoder(Coder& coder) : coder_(coder) {}

  // `most`: bytes that it may have; longer ones are cut, and failed() says so.
  std::string code(std::string_view text, std::size_t most) {
    const std::uint32_t length_told = after(length_, text.size(), before_.size());
    const std::size_t length = std::min<std::size_t>(length_told, most);
    is_wrong_ |= length < length_told;
    const std::uint32_t shared_told = after(shared_, shared_with_before(text), shared_before_);
    const std::size_t shared = std::min({std::size_t(shared_told), length, before_.size()});
    is_wrong_ |= shared < shared_told;
    std::string coded = before_.substr(0, shared);
    for (std::size_t i = shared; i < length && !failed(); ++i) {
      coded += code_byte(i < text.size() ? text[i] : '\0', coded, i == shared);
    }
    shared_before_ = shared;
    coded.shrink_to_fit();  // it may be of any length
    before_ = coded;
    return coded;
  }

  bool failed() const { return coder_.failed() || is_wrong_; }

 private:
  static constexpr int kContexts = 3, kTableBits = 16;

  std::uint32_t after(SignedModel& model, std::size_t value, std::size_t expected) {
    return code_after(coder_, model, static_cast<std::uint32_t>(value),
                      static_cast<std::uint32_t>(expected));
  }

  std::size_t shared_with_before(std::string_view text) const {
    const std::size_t most = std::min(text.size(), before_.size());
    std::size_t shared = 0;
    while (shared < most && text[shared] == before_[shared]) ++shared;
    return shared;
  }

  // What stands before it, and what the name before has in its place.
  char code_byte(char value, std::string_view so_far, bool is_first) {
    std::uint32_t last_four = 0;
    for (std::size_t i = so_far.size() - std::min<std::size_t>(so_far.size(), 4); i < so_far.size();
         ++i) {
      last_four = last_four << 8 | static_cast<std::uint8_t>(so_far[i]);
    }
    const std::uint32_t above =
        so_far.size() < before_.size() ? static_cast<std::uint8_t>(before_[so_far.size()]) : 0;
    const std::array<std::uint32_t, kContexts> contexts{
        last_four & 0xffff, last_four, (last_four & 0xff) << 9 | above << 1 | (is_first ? 1u : 0u)};
    const auto bits = static_cast<std::uint8_t>(value);
    std::uint32_t node = 1;
    for (int b = 7; b >= 0; --b) {
      std::array<AdaptiveBit*, kContexts> inputs{};
      for (std::size_t c = 0; c < kContexts; ++c) inputs[c] = &tables_[c][slot(contexts[c], node)];
      MixedBit<kContexts> bit(inputs, weights_[is_first]);
      node = 2 * node + coder_.bit(bit, (bits >> b & 1) != 0);
    }
    return static_cast<char>(node & 0xff);
  }

  static std::uint32_t slot(std::uint32_t context, std::uint32_t node) {
    return (context * 0x9e3779b1u + node * 0x85ebca6bu) >> (32 - kTableBits);
  }

  Coder& coder_;
  std::string before_;
  std::size_t shared_before_ = 0;
  bool is_wrong_ = false;
  SignedModel length_, shared_;
  std::array<std::vector<AdaptiveBit>, kContexts> tables_{
      std::vector<AdaptiveBit>(1u << kTableBits), std::vector<AdaptiveBit>(1u << kTableBits),
      std::vector<AdaptiveBit>(1u << kTableBits)};
  std::array<MixingWeights<kContexts>, 2> weights_;
};

}  // namespace crease::codec
