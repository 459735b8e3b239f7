// What a blocking source keeps of what was transferred: pieces by where they lie, up to a number of
// bytes. Those that were read go first, then the oldest.
//
// Threads: one at a time.
#pragma once

#include "crease/byte_source.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace crease::http {

class TransferredBytes {
 public:
  explicit TransferredBytes(std::uint64_t max_bytes) : max_bytes_(max_bytes) {}

  void put(std::uint64_t offset, std::vector<std::byte> bytes);
  bool has(const FileRange& range) const { return find(range) != pieces_.end(); }
  // The first bytes of a range, as many as one piece holds; valid until the next put().
  std::span<const std::byte> begin_of(const FileRange& range) const;
  // False, and nothing is copied, where one piece does not hold all of it.
  bool read(std::uint64_t offset, std::span<std::byte> into);
  // The piece that begins there, if there is one.
  void mark_read(std::uint64_t offset);

  // Of pieces that nobody has read yet.
  std::uint64_t unread_bytes() const { return unread_bytes_; }
  std::uint64_t max_bytes() const { return max_bytes_; }

 private:
  struct Piece {
    std::vector<std::byte> bytes;
    std::uint64_t number = 0;  // of put()
    bool was_read = false;
  };
  using Pieces = std::map<std::uint64_t, Piece>;  // by offset

  // The piece that begins there or before, if there is one.
  Pieces::const_iterator before(std::uint64_t offset) const;
  Pieces::const_iterator find(const FileRange& range) const;
  void drop(Pieces::const_iterator piece);

  const std::uint64_t max_bytes_;
  Pieces pieces_;
  // In the order in which they go: (is unread, number) to offset.
  std::map<std::pair<bool, std::uint64_t>, std::uint64_t> order_;
  std::uint64_t next_number_ = 0, bytes_ = 0, unread_bytes_ = 0;
};

}  // namespace crease::http
