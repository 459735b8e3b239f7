// What a cut shows as a mesh of its own.
#pragma once

#include "crease/mesh.h"
#include "runtime/active_cut.h"

#include <vector>

namespace crease {

// Triangles in the hierarchy's order; used vertices, in the order of their wedges, and used values
// only. Two corners share an attribute iff they have the same value of the hierarchy; a derived
// normal is one of its own.
Mesh extract_cut(const ActiveCut& cut);

// And what its triangles and vertices are in the hierarchy.
struct CutPiece {
  Mesh mesh;
  std::vector<NodeId> node_of_vertex;
  std::vector<TriangleId> id_of_triangle;  // ascending
};
CutPiece extract_piece(const ActiveCut& cut);

}  // namespace crease
