#include "spill/file_ranges.h"

#include "base/assert.h"

#include <algorithm>
#include <iterator>

namespace crease::spill {

std::uint64_t FileRanges::take(std::uint64_t size) {
  size = (size + kPage - 1) / kPage * kPage;
  used_ += size;
  const auto fitting = free_.lower_bound({size, 0});
  if (fitting == free_.end()) {
    // A free range at the end is too small, and becomes part of this one.
    std::uint64_t offset = end_;
    if (!pieces_.empty() && std::prev(pieces_.end())->second.is_free) {
      offset = std::prev(pieces_.end())->first;
      drop_free(std::prev(pieces_.end()));
    }
    end_ = offset + size;
    pieces_[offset] = {size};
    return offset;
  }
  const auto piece = pieces_.find(fitting->second);
  const std::uint64_t offset = piece->first;
  const Piece whole = piece->second;
  drop_free(piece);
  pieces_[offset] = {size};
  const std::uint64_t rest = whole.size - size;
  if (rest > 0) add_free(offset + size, {rest, true, std::min(whole.stale, rest)});
  return offset;
}

Range FileRanges::give_back(std::uint64_t offset) {
  const auto piece = pieces_.find(offset);
  CREASE_ASSERT(piece != pieces_.end() && !piece->second.is_free);
  used_ -= piece->second.size;
  const auto [start, joined] = join_neighbours(piece, piece->second.size);
  if (joined.stale < kStale) {
    add_free(start, joined);
    return {};
  }
  pieces_[start] = {joined.size};
  return {start, joined.size};
}

void FileRanges::give_back_clean(std::uint64_t offset) {
  const auto piece = pieces_.find(offset);
  CREASE_ASSERT(piece != pieces_.end() && !piece->second.is_free);
  const auto [start, joined] = join_neighbours(piece, 0);
  add_free(start, joined);
}

std::pair<std::uint64_t, FileRanges::Piece> FileRanges::join_neighbours(Pieces::iterator piece,
                                                                        std::uint64_t stale) {
  std::uint64_t offset = piece->first;
  Piece joined = {piece->second.size, true, stale};
  const auto add = [&](Pieces::iterator neighbour) {
    joined.size += neighbour->second.size;
    joined.stale += neighbour->second.stale;
    drop_free(neighbour);
  };
  const auto next = std::next(piece);
  if (next != pieces_.end() && next->second.is_free) add(next);
  if (piece != pieces_.begin() && std::prev(piece)->second.is_free) {
    offset = std::prev(piece)->first;
    add(std::prev(piece));
  }
  pieces_.erase(piece);
  return {offset, joined};
}

void FileRanges::add_free(std::uint64_t offset, const Piece& piece) {
  pieces_[offset] = piece;
  free_.insert({piece.size, offset});
}

void FileRanges::drop_free(Pieces::iterator piece) {
  free_.erase({piece->second.size, piece->first});
  pieces_.erase(piece);
}

}  // namespace crease::spill
