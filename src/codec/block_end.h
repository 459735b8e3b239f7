// Both ends of a block, and how the fine ends of one band become the coarse ends of the next finer
// one: every triangle is labelled with the patch that goes on with it.
#pragma once

#include "codec/patch_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace crease::codec {

// A vertex is the same wherever it is met: the block whose split or root made it, and its number at
// that block's fine end.
struct VertexName {
  std::uint32_t block = 0, vertex = 0;
  bool operator==(const VertexName&) const = default;
};

// Triangle `triangle` of the fine end `end`.
struct TriangleSource {
  std::uint32_t end = 0, triangle = 0;
};

struct CoarseEnd {
  PatchMesh mesh;
  std::vector<VertexName> names;        // per vertex
  std::vector<TriangleSource> sources;  // per triangle
};

struct FineEnd {
  PatchMesh mesh;
  std::vector<VertexName> names;      // per vertex
  std::vector<std::uint32_t> labels;  // per triangle: patch of the next finer band
};

// What the patches of a band start from: the triangles with their label, by fine end and there in
// order; vertices in the order in which the triangles name them. Labels that are not below
// `patch_count` are left out. Time linear.
std::vector<CoarseEnd> sort_by_label(std::span<const FineEnd* const> ends,
                                     std::uint32_t patch_count);
std::vector<CoarseEnd> sort_by_label(std::span<const FineEnd> ends, std::uint32_t patch_count);

// What patch `label` alone starts from. `ends`: those of the band before that have triangles of it,
// in the file's order; `sources` count among them.
CoarseEnd coarse_end_of(std::span<const FineEnd* const> ends, std::uint32_t label);

}  // namespace crease::codec
