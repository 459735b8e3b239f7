// Bytes of a file that came along with others and may be asked for later: what lies between the
// ranges of a request, and ranges that nobody wants any more by the time they come.
//
// Given out once: who asks again has found something wrong with them.
// Memory: at most `limit` bytes; what has been there for longest goes first.
#pragma once

#include "crease/byte_source.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

namespace crease::stream {

class KeptBytes {
 public:
  explicit KeptBytes(std::uint64_t limit) : limit_(limit) {}

  // Unless some of them are there.
  void keep(std::uint64_t offset, std::span<const std::byte> bytes);
  // All of the range, if they came together. Time O(log pieces), and what is left is copied.
  std::optional<std::vector<std::byte>> take(const FileRange& range);
  std::uint64_t bytes() const { return total_; }

 private:
  struct Piece {
    std::vector<std::byte> bytes;
    std::uint64_t number = 0;  // the lower, the longer it has been there
  };
  std::map<std::uint64_t, Piece> pieces_;  // by offset; none overlaps the next one
  std::uint64_t limit_, total_ = 0, next_number_ = 0;
};

}  // namespace crease::stream
