// Attribute values are snapped before simplification, as positions are, so that a file with the
// codes of what is left is exact. The passes of snap_attributes() in crease/build.h:
//
//   const std::vector<LayerCoding> codings = codings_of(mesh, {.normal_bits = 12});
//   snap_to_codings(mesh, codings);
//   Result<ContractionSequence> sequence = simplify(mesh, grid, {});
//   snap_new_values(*sequence, mesh, codings);                // what simplification blended
//
// Corners that share a value go on sharing it. Values that meet at a vertex and are now equal to
// the bit become one, everywhere: an edge that nobody can see is no crease. Equal values that do
// not meet stay apart. To join them all, as import does, would make triangles of smooth surfaces
// flat wherever the mesh is finer than the codes, and what is flat keeps its normal (DB03, rule b).
#pragma once

#include "codec/layer_coding.h"
#include "crease/attribute_precision.h"
#include "crease/build.h"
#include "crease/contraction.h"
#include "crease/mesh.h"

#include <span>
#include <vector>

namespace crease {

// One a layer. Normals get direction codes, texture coordinates and colours a lattice for each
// component. Other and categorical layers stay as they are.
std::vector<LayerCoding> codings_of(const Mesh& mesh, const AttributePrecision& precision);

// In place. Afterwards every value of a layer is one of its coding, and two corners at one vertex
// share a value iff it is equal. Zero-length normals stay. Snapping twice is
// snapping once. Time O(corners log valence), 250 ns a normal.
std::vector<SnappedLayer> snap_to_codings(Mesh& mesh, std::span<const LayerCoding> codings);

// The sequence's new values, likewise, one by one: ids stay. The errors of the contractions that
// show them, and of all that follow at that vertex, grow by how far they moved.
void snap_new_values(ContractionSequence& sequence, const Mesh& snapped,
                     std::span<const LayerCoding> codings);

}  // namespace crease
