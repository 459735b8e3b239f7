// Which triangles of a draw list are meant.
#pragma once

#include "crease/draw_changes.h"
#include "crease/draw_list.h"

#include <cstddef>

namespace crease {

// Triangles of the three parts.
struct DrawRanges {
  Range sn, fn, nsn;
  std::size_t triangle_count() const { return std::size_t(sn.count) + fn.count + nsn.count; }
};

inline DrawRanges all_of(const DrawList& list) {
  const auto all = [](const DrawPart& part) {
    return Range{0, std::uint32_t(part.triangle_count())};
  };
  return {all(list.sn), all(list.fn), all(list.nsn)};
}

}  // namespace crease
