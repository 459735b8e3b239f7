// A draw list as vertices and indices, for engines that draw no other way: a vertex for all corners
// that have position (the same of the list), normal, colour, texture coordinates and material in
// common.
//
//   const IndexedArrays level = indexed_arrays(progressive_mesh.draw_list());
//   upload(level.positions, level.normals, level.indices);
//   for (const MaterialRun& run : level.runs) draw(run.material, run.triangles);
//
// Of a BlockMesh each block is laid out once, and a frame chooses among its triangles:
//
//   whenever a block has been decoded:
//     arrays_of[block->id()] = indexed_arrays(*block);
//   every frame:
//     for (const ShownRange& shown : mesh.shown()) {
//       draw(arrays_of[shown.block->id()], triangles_of(shown));
//     }
//     for (const ShownCut& cut : mesh.shown_cuts()) {
//       if (is_new(cut.revision)) arrays_of_cut[cut.revision] = indexed_arrays(cut.list);
//       draw(arrays_of_cut[cut.revision]);
//     }
//
// The three parts of a draw list need fewer bytes (README), and of a level only its changes are
// uploaded; here each change makes the arrays anew. Threads: pure, call from any.
#pragma once

#include "crease/draw_changes.h"
#include "crease/draw_list.h"
#include "crease/shading.h"
#include "crease/vec.h"

#include <array>
#include <cstdint>
#include <vector>

namespace crease {

class ResidentBlock;
struct ShownRange;

// Consecutive triangles of one material.
struct MaterialRun {
  std::uint32_t material = 0;  // of the draw list's; 0 where it has none
  Range triangles;
};

// Which one of the draw list a triangle is, in its part.
struct ListedTriangle {
  TriangleKind kind{};
  std::uint32_t number = 0;
};

struct IndexedArrays {
  Vec3d origin;                              // positions are relative to it, so that floats suffice
  std::vector<Vec3f> positions;              // vertex_count, model units less origin
  std::vector<Vec3f> normals;                // vertex_count
  std::vector<std::array<float, 4>> colors;  // vertex_count, RGBA 0..1 as in DrawPart; or empty
  std::vector<std::array<float, 2>> texcoords;  // vertex_count, v up; or empty
  std::vector<std::uint32_t> materials;         // vertex_count, or empty
  std::vector<std::uint32_t> indices;           // 3 * triangle_count
  std::vector<MaterialRun> runs;                // all triangles, in order
  std::vector<ListedTriangle> listed;           // triangle_count: for part_of()

  std::size_t vertex_count() const { return positions.size(); }
  std::size_t triangle_count() const { return indices.size() / 3; }
};

// Triangles by material, then as the list has them: SN, FN, NSN. Vertices in the order of
// triangles, none without. Colours are there if the list has any, likewise texture coordinates and
// materials. `list` is one that the library has made. Owns what it returns. Time O(corners +
// materials), 17 to 92 ns a triangle; memory beside the result: 24 bytes a triangle, 4 a position
// and 4 a vertex.
IndexedArrays indexed_arrays(const DrawList& list);

// The same group by group, in each by material: so what is shown of a block are consecutive
// triangles.
IndexedArrays indexed_arrays(const ResidentBlock& block);
Range triangles_of(const ShownRange& shown);

}  // namespace crease
