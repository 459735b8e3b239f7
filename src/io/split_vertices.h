// A mesh as split vertices: one for every combination of position and attribute values, as PLY and
// GLB want it.
//
//   const SplitVertices split = split_vertices(mesh, layers);
//   position of split vertex s: mesh.positions[split.position[s]]
#pragma once

#include "crease/mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace crease {

struct SplitVertices {
  std::vector<std::uint32_t> of_corner;          // 3 * triangle_count: its split vertex
  std::vector<std::uint32_t> position;           // per split vertex: the mesh's vertex
  std::vector<std::vector<AttributeId>> values;  // per layer given, per split vertex

  std::size_t count() const { return position.size(); }
};

// `layers` are those that split; others are left to the caller. Order of first appearance.
// Time O(corners * layers).
SplitVertices split_vertices(const Mesh& mesh, std::span<const AttributeLayer* const> layers);

// Whether the layer has one value on each triangle: better written per face where a format can.
bool is_per_triangle(const AttributeLayer& layer);

}  // namespace crease
