#include "http/transferred_bytes.h"

#include <algorithm>
#include <iterator>

namespace crease::http {

TransferredBytes::Pieces::const_iterator TransferredBytes::before(std::uint64_t offset) const {
  const auto behind = pieces_.upper_bound(offset);
  return behind == pieces_.begin() ? pieces_.end() : std::prev(behind);
}

std::span<const std::byte> TransferredBytes::begin_of(const FileRange& range) const {
  const auto piece = before(range.offset);
  if (piece == pieces_.end()) return {};
  const std::span<const std::byte> bytes = piece->second.bytes;
  const std::uint64_t begin = range.offset - piece->first;
  if (begin >= bytes.size()) return {};
  const std::uint64_t count = std::min<std::uint64_t>(range.bytes, bytes.size() - begin);
  return bytes.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(count));
}

TransferredBytes::Pieces::const_iterator TransferredBytes::find(const FileRange& range) const {
  const auto piece = before(range.offset);
  if (piece == pieces_.end()) return piece;
  const std::uint64_t begin = range.offset - piece->first;
  const std::uint64_t there = piece->second.bytes.size();
  return begin <= there && range.bytes <= there - begin ? piece : pieces_.end();
}

void TransferredBytes::put(std::uint64_t offset, std::vector<std::byte> bytes) {
  if (bytes.empty() || bytes.size() > max_bytes_ || has({offset, bytes.size()})) return;
  if (const auto shorter = pieces_.find(offset); shorter != pieces_.end()) drop(shorter);
  while (bytes_ + bytes.size() > max_bytes_) drop(pieces_.find(order_.begin()->second));
  bytes_ += bytes.size();
  unread_bytes_ += bytes.size();
  order_.emplace(std::pair(true, next_number_), offset);
  pieces_.emplace(offset, Piece{std::move(bytes), next_number_++, false});
}

bool TransferredBytes::read(std::uint64_t offset, std::span<std::byte> into) {
  const auto found = find({offset, into.size()});
  if (found == pieces_.end()) return false;
  const auto begin =
      found->second.bytes.begin() + static_cast<std::ptrdiff_t>(offset - found->first);
  std::copy_n(begin, into.size(), into.begin());
  mark_read(found->first);
  return true;
}

void TransferredBytes::mark_read(std::uint64_t offset) {
  const auto found = pieces_.find(offset);
  if (found == pieces_.end() || found->second.was_read) return;
  Piece& piece = found->second;
  piece.was_read = true;
  unread_bytes_ -= piece.bytes.size();
  order_.erase({true, piece.number});
  order_.emplace(std::pair(false, piece.number), offset);
}

void TransferredBytes::drop(Pieces::const_iterator piece) {
  bytes_ -= piece->second.bytes.size();
  if (!piece->second.was_read) unread_bytes_ -= piece->second.bytes.size();
  order_.erase({!piece->second.was_read, piece->second.number});
  pieces_.erase(piece);
}

}  // namespace crease::http
