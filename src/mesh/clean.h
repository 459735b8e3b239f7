// What import drops and counts: degenerate triangles, isolated vertices, unused values, repeats.
//
//   keep_triangles(mesh, proper_triangles(mesh));
//   report.isolated_vertices = drop_isolated_vertices(mesh);
#pragma once

#include "crease/mesh.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crease {

// Per triangle: its three corners differ.
std::vector<bool> proper_triangles(const Mesh& mesh);

// Keeps triangle t iff keep[t], in every array of the mesh. Values and vertices stay.
void keep_triangles(Mesh& mesh, const std::vector<bool>& keep);

// The indices i with keep[i], ascending.
std::vector<std::uint32_t> kept_rows(const std::vector<bool>& keep);

// Vertices without a triangle. The others keep their order. Returns how many.
std::size_t drop_isolated_vertices(Mesh& mesh);

// Values that no corner uses; bit-equal ones become one (mesh/weld.h). Order of first appearance.
void weld_layer(AttributeLayer& layer);

// Triangles over the same three vertices as an earlier one, whichever way round.
std::size_t count_duplicate_triangles(const Mesh& mesh);

// Edges of two triangles alone, no repeats of each other, that both run through it the same way:
// one side of the surface becomes the other there. Time O(corners), memory 12 bytes per triangle.
std::size_t count_misoriented_edges(const Mesh& mesh);

// Whether a triangle has an area and three normals, all more than 90 degrees off the side that its
// winding says is outside; and how many do.
bool has_reversed_normals(const Mesh& mesh, const AttributeLayer& normals, std::size_t triangle);
std::size_t count_reversed_normals(const Mesh& mesh, const AttributeLayer& normals);

// Whether the three points lie on a line, as far as their coordinates can tell: the height over the
// longest side is below a few units in the last place of the largest coordinate.
bool has_no_area(const Vec3d& a, const Vec3d& b, const Vec3d& c);
std::size_t count_zero_area_triangles(const Mesh& mesh);

}  // namespace crease
