// docs/format.md, "Entries": what a directory page says of its blocks; "Bands".
#pragma once

#include "plain_decoder/bits.h"
#include "plain_decoder/container.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace plain {

// "Errors".
class ErrorsReader {
 public:
  Errors read(RangeDecoder& in);

 private:
  struct Kind {
    std::array<AdaptiveBit, 2> is_zero;
    Signed difference;
    bool was_zero = true;
    std::uint32_t last = 0;
  };
  std::array<Kind, 4> kinds_;
};

// "Bands": of a model with so many triangles.
std::vector<Band> read_bands(std::span<const std::byte> bytes, std::size_t count,
                             std::uint64_t triangles);

class EntryReader {
 public:
  EntryReader(std::span<const std::byte> bytes, const Head& head);

  // The next one: its facts, and the bytes of its payload.
  Entry entry();
  // And of that one, which is block `id`, the blocks that it needs.
  std::vector<std::uint32_t> dependencies(std::uint32_t id);

  bool is_at_end() const { return in_.is_at_end(); }

 private:
  std::uint32_t after(Signed& model, std::uint32_t expected);
  void sphere(Entry& e);

  RangeDecoder in_;
  std::uint32_t layers_;
  Entry before_;
  bool has_before_ = false;
  std::uint32_t first_dependency_ = 0, radius_code_ = 0;
  Signed band_, patch_, splits_, coarse_triangles_, fine_triangles_, vertices_, memory_, bytes_;
  Signed radius_, first_;
  std::array<Signed, 3> centre_;
  ErrorsReader coarse_, fine_;
  Magnitude count_, gap_;
};

}  // namespace plain
