#include "stream/kept_bytes.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace crease::stream {

void KeptBytes::keep(std::uint64_t offset, std::span<const std::byte> bytes) {
  if (bytes.empty() || bytes.size() > limit_) return;
  const auto next = pieces_.lower_bound(offset);
  if (next != pieces_.end() && next->first - offset < bytes.size()) return;
  if (next != pieces_.begin()) {
    const auto& [begin, before] = *std::prev(next);
    if (offset - begin < before.bytes.size()) return;
  }
  pieces_.emplace(offset, Piece{{bytes.begin(), bytes.end()}, next_number_++});
  total_ += bytes.size();
  while (total_ > limit_) {
    const auto oldest = std::min_element(
        pieces_.begin(), pieces_.end(),
        [](const auto& a, const auto& b) { return a.second.number < b.second.number; });
    total_ -= oldest->second.bytes.size();
    pieces_.erase(oldest);
  }
}

std::optional<std::vector<std::byte>> KeptBytes::take(const FileRange& range) {
  auto at = pieces_.upper_bound(range.offset);
  if (at == pieces_.begin()) return std::nullopt;
  --at;
  const std::uint64_t size = at->second.bytes.size(), before = range.offset - at->first;
  if (before >= size || range.bytes > size - before) return std::nullopt;
  const Piece piece = std::move(at->second);
  pieces_.erase(at);
  const std::span<const std::byte> all = piece.bytes;
  const auto part = [&](std::uint64_t first, std::uint64_t end) {
    const auto some =
        all.subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(end - first));
    return std::vector<std::byte>(some.begin(), some.end());
  };
  const std::uint64_t end = before + range.bytes;
  if (before > 0) pieces_.emplace(range.offset - before, Piece{part(0, before), piece.number});
  if (end < size) {
    pieces_.emplace(range.offset + range.bytes, Piece{part(end, size), piece.number});
  }
  total_ -= range.bytes;
  return part(before, end);
}

}  // namespace crease::stream
