// Wedges and attributes of the input's vertices: where the attribute hierarchies begin.
#pragma once

#include "assemble/vertex_forest.h"
#include "crease/mesh.h"
#include "crease/mesh_hierarchy.h"
#include "mesh/corners_around.h"

#include <cstdint>
#include <vector>

namespace crease {

// The attributes of one layer at all input vertices, one after the other: at vertex v those from
// first_of_vertex[v] on, in the order of their relative indices, which is that of their regions.
struct LeafAttributes {
  struct Attribute {
    AttributeId id{};            // in the input
    std::uint32_t region = 0;    // the smallest smooth region of its triangles
    std::uint32_t corner = 0;    // its first one: tells apart attributes of one region
    bool is_face_value = false;  // some triangle has it at all three corners
  };
  std::vector<std::uint32_t> first_of_vertex;  // vertex_count + 1
  std::vector<Attribute> attributes;
  std::vector<std::uint32_t> of_wedge;  // index into attributes, for every wedge
};

struct LeafWedges {
  std::vector<WedgeId> of_corner;  // 3 per input triangle
  std::vector<LeafAttributes> layers;
};

// Numbers the wedges as the forest's leaves are arranged; fills root_wedges and
// second_wedge.
LeafWedges find_wedges(const Mesh& snapped, const VertexForest& forest, VertexHierarchy& hierarchy);

}  // namespace crease
