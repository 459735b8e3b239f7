// Corner normals made from the geometry, completed where a file lacks some, and joined where they
// are one but for noise.
//
//   mesh.layers.push_back(generate_normals(mesh, {.max_angle_deg = 30}));
//   join_normals(*mesh.normals(), mesh, 1.0);
//
// A sector is the corners of one vertex that soft edges connect; it has one normal, the mean of its
// triangles' normals weighted by their angle at the vertex. An edge between two triangles that run
// through it in the same direction is hard: one of them is inside out.
#pragma once

#include "crease/mesh.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace crease {

// Coplanar up to rounding: generated normals that differ by less are one, so that a flat wall of
// many triangles has one normal.
inline constexpr double kCoplanarDeg = 0.01;

// Which edges are soft. Edges inside a face of the source always are. Those of more than 16
// triangles, copies counted once, never are.
struct SoftEdges {
  double max_angle_deg = 30;  // between the triangles' normals; 180: all edges
  std::span<const std::uint32_t> smoothing_group{};   // per triangle. If given, soft iff both sides
                                                      // are in one group other than 0
  std::span<const std::uint32_t> face_of_triangle{};  // the source's polygons; empty: triangles
};

// One unit normal a triangle, the same for all triangles of a face. A triangle without area takes
// its neighbour's across its longest edges; if there is none, +z.
std::vector<Vec3d> face_normals(const Mesh& mesh, std::span<const std::uint32_t> face_of_triangle);

// How much of the creases is fragments: of the vertices at edges sharper than `angle_deg`, the
// share with one such edge only, where a crease just ends. Real creases seldom end; noise does at
// once.
double loose_crease_share(const Mesh& mesh, double angle_deg);

// A normal layer, welded. Time O(n log valence), memory 80 bytes a triangle while it runs.
AttributeLayer generate_normals(const Mesh& mesh, const SoftEdges& soft);

// Corners of `given` that have kNoAttribute get the given normal of their sector that is nearest to
// the sector's own, else the sector's own. Returns how many corners those were.
std::size_t complete_normals(AttributeLayer& given, const Mesh& mesh, const SoftEdges& soft);

// Joins normals that differ by noise, so that noise is no crease and no smooth surface becomes
// faceted:
// (1) a smooth patch (triangles connected through vertices where their normals differ by no more
//     than `angle_deg`) that spans no more than that as a whole is a flat side: it gets one normal;
// (2) elsewhere, values that meet at a vertex and differ by no more than `angle_deg` become their
//     mean, gathered around the most used ones; no joined set spans more than `angle_deg`.
// Where every vertex has one normal, (2) changes nothing: curved surfaces keep their normals.
// Corners that shared a normal share one afterwards. Returns the number of (vertex, normal) pairs
// that changed. Welds the layer.
std::size_t join_normals(AttributeLayer& normals, const Mesh& mesh, double angle_deg);

}  // namespace crease
