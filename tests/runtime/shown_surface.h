// What a BlockMesh draws, looked at as triangles and nothing else: for checks that trust none of
// its own lists.
#pragma once

#include "crease/block_mesh.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace crease {

// Edges of what is drawn that no triangle goes along the other way. A model without open borders is
// shown without crack and hole iff there are none, whatever the cut: each cut's triangles are
// images of the model's, and the images of edges that meet meet.
// Time O(n log n) and 84 bytes a triangle that is shown.
std::size_t open_edges(const BlockMesh& mesh);

// Of all that is drawn of a block when it is shown whole. Equal for equal blocks.
std::uint64_t drawn_checksum(const ResidentBlock& block);

// Those of all blocks of a sound file, decoded one after the other as they lie there. Memory: that
// of all blocks. Fails where it is not sound.
Result<std::vector<std::uint64_t>> drawn_checksums(const BlockFile& file);

// Of the blocks that are shown, or of which a cut is, those that are not the file's.
std::size_t wrong_blocks(const BlockMesh& mesh, std::span<const std::uint64_t> checksums);

}  // namespace crease
