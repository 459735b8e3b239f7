// The hard edges of what is drawn, and its borders.
//
//   GroupLines one = lines_of(block.draw_list(), ranges);        // once per group of a block
//   CreaseLines rest = join_rims(rims_of_all_that_is_shown);     // whenever that changes
//
//   CreaseLines all = crease_lines(mesh.draw_list());            // a list that stands alone
//
// An edge is hard where the corner normals of two of its triangles differ by more than
// kSameNormalDeg at one of its ends or both; with one triangle it is a border.
//
// Blocks: within a group of a block all is known from the block alone. Of an edge on the rim of a
// group a block knows one side only; the other side is a group of this or another block, and which
// one depends on the cut. But a cut runs along edges that both sides have, and a vertex has the
// same floats in all blocks (crease/block_mesh.h), so the rims of all groups that are shown, joined
// by their ends' positions, tell hard edges, smooth ones and borders of the mesh apart. What this
// does not see: an edge with two triangles in one group and a third one in another shows the third
// one's side as a border.
#pragma once

#include "crease/draw_list.h"
#include "render/draw_ranges.h"

#include <array>
#include <span>
#include <vector>

namespace crease {

// Stored normals are off by some hundredths of a degree, those that are derived from vertices on a
// grid by more; nobody sees an edge of less.
inline constexpr float kSameNormalDeg = 1;

struct Line3f {
  Vec3f from, to;  // less the list's origin
};

// An edge, and the normals that its triangle has there.
struct RimEdge {
  std::array<Vec3f, 2> ends, normals;  // the lesser position first
};

struct GroupLines {
  std::vector<Line3f> hard;
  std::vector<RimEdge> rim;
};

struct CreaseLines {
  std::vector<Line3f> hard, borders;
};

// Of some triangles of a list. Time and memory linear in triangles and positions.
GroupLines lines_of(const DrawList& list, const DrawRanges& ranges);

// Of the edges that several groups have. Time O(n log n) of the rims' edges.
CreaseLines join_rims(std::span<const std::span<const RimEdge>> rims);

// Positions are vertices here: no two have one place, or they are apart on purpose.
CreaseLines crease_lines(const DrawList& list);

}  // namespace crease
