// Triangles of a cut that lie folded over. Any splits make a cut without a crack, yet where a
// vertex is split and those around it are not, triangles may face away from the surface: on a flat
// one at no distance from it, so that no error tells of them.
#pragma once

#include "runtime/active_cut.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace crease {

struct Folds {
  std::size_t count = 0;  // of triangles that face away from all normals that they show
  // Of each the corner that stands for the widest part of the input, in ascending order, once: to
  // be split. Less than `count` where corners are shared, or are vertices of the input.
  std::vector<std::uint32_t> slots;
};

// `faces_away`: per triangle of the hierarchy, whether it does so in the input, and is no fold; or
// empty. Derived triangles show the side that they have. Time O(active triangles).
Folds find_folds(const ActiveCut& cut, std::span<const char> faces_away);

}  // namespace crease
