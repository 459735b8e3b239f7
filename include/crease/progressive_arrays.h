// DB03's result as plain arrays: what a file holds and ProgressiveMesh moves in.
//
// Vertices are slots [SN | NSN], triangles [SN | FN | NSN]; in each section what lives longest
// comes first, and what a contraction removes are the last active ones, so that every level is a
// prefix of every section (DB03 8.3). All arrays are at full resolution; the packed contractions
// lead on.
//
// Slots and classes are fixed for the whole life of a progressive mesh:
// (1) An SN slot v owns a normal, normals[v] at full resolution. It may change with a contraction.
// (2) An SN triangle has three SN slots at every level and uses their own normals. It stores none.
// (3) An FN triangle has one normal on all corners at every level until it is derived
// (contraction.h).
//     That normal never changes, DB03's rule (b).
// (4) All others are NSN and store three.
// A triangle of SN vertices is thus FN or NSN from the start when some contraction gives a slot two
// normals that it cannot own both; DB03 would change its shading there. And a vertex that no SN
// triangle uses is an NSN slot even if its corners share a normal: it owns nothing.
//
// Other attributes are carried the same way, a value a vertex where that works, else by corner.
#pragma once

#include "crease/contraction.h"
#include "crease/mesh.h"
#include "crease/result.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace crease {

// How many of each section are there, or active.
struct SectionCounts {
  std::uint32_t sn_vertices = 0, nsn_vertices = 0;
  std::uint32_t sn_triangles = 0, fn_triangles = 0, nsn_triangles = 0;

  std::size_t vertices() const { return std::size_t(sn_vertices) + nsn_vertices; }
  std::size_t triangles() const { return std::size_t(sn_triangles) + fn_triangles + nsn_triangles; }
  bool operator==(const SectionCounts&) const = default;
};

// An attribute beside normals.
struct ProgressiveLayer {
  enum class Storage : std::uint8_t {
    Vertex,  // every slot owns a value; triangles that this does not suit have rows of their own
    Corner,  // an index a corner
    Face,    // an index a triangle: its corners always share one value
  };
  std::string name;
  AttributeRole role = AttributeRole::Other;
  Interpolation interpolation = Interpolation::Linear;
  std::uint32_t dimension = 1;
  Storage storage = Storage::Corner;
  std::vector<float> values;  // dimension a value. Vertex: value v is slot v's own, others follow
  // Vertex: for every triangle its row in `indices`, or kNone: it uses the slots' own values.
  // Empty: all do.
  std::vector<std::uint32_t> row_of_triangle;
  // Value indices. Corner: 3 a triangle; Face: 1 a triangle; Vertex: 3 a row.
  std::vector<std::uint32_t> indices;

  std::size_t value_count() const { return dimension == 0 ? 0 : values.size() / dimension; }
};

// The counts of a contraction that do not fit its header.
struct WideCounts {
  SectionCounts lost;
  std::uint32_t corner_changes = 0;
};

// From contraction `applied` on (number of contractions in force), the largest errors are these.
struct ErrorStep {
  std::uint32_t applied = 0;
  LevelError error;
};

// One contraction each, in order; what is of variable length lies in streams that are read with
// cursors in both directions. hierarchy/packed_contraction.h reads and makes the headers.
//
// Bytes a contraction: slot kept 4, header 4, delta 12 (Optimal only; Endpoint has DB03's
// swapVectors as a bit), corner change 4 each. Where it happens: own normal changes 12, own values
// of the other layers change 4 a component, error grows 20, counts beyond the header 24, and a
// block of 4 + 4 a group + 8 for every corner that changes an attribute index, 4 for every triangle
// that becomes derived, 4 for every touched corner (DrawList would not notice otherwise: the corner
// keeps its slot, but the slot moved under a derived triangle, or changed its colour or, where
// materials have textures, its texture coordinates).
struct PackedContractions {
  std::vector<std::uint32_t> kept;  // slot of v_s; the slot removed is the last active one
  std::vector<std::uint32_t> headers;
  std::vector<Vec3i> deltas;           // Placement::Optimal: added to the kept slot's position
  std::vector<WideCounts> wide;        // of those with the header's bit, in order
  std::vector<std::uint32_t> corners;  // 3 * triangle + corner, where the removed slot becomes kept
  std::vector<std::uint32_t> own;      // xor of float bits: normal first, then the other layers
  std::vector<std::uint32_t> block_ends;  // in `blocks`, for those with the header's bit, in order
  std::vector<std::uint32_t> blocks;
  std::vector<ErrorStep> errors;  // ascending; before the first one there is no error

  std::size_t count() const { return kept.size(); }
};

struct ProgressiveArrays {
  Grid grid;
  Placement placement = Placement::Optimal;
  SectionCounts full;                  // at full resolution
  std::vector<Vec3i> positions;        // per slot, grid units
  std::vector<std::uint32_t> indices;  // 3 slots a triangle
  std::string normal_name = "normal";
  std::vector<Vec3f> normals;             // own normals of the SN slots, then others (DB03 rebuilt)
  std::vector<std::uint32_t> fn_normals;  // 1 index a FN triangle
  std::vector<std::uint32_t> nsn_normals;           // 3 indices a NSN triangle
  std::vector<ProgressiveLayer> layers;             // beside normals
  std::vector<std::uint32_t> material_of_triangle;  // or empty
  std::vector<std::uint32_t> part_of_triangle;      // or empty
  std::vector<Material> materials;
  std::vector<std::string> parts;
  UpAxis up = UpAxis::Unknown;
  PackedContractions contractions;
};
using ProgressiveArraysPtr = std::shared_ptr<const ProgressiveArrays>;

// The first thing that is not as said above, in words. It follows every contraction, so that
// whoever moves in arrays that pass it need check nothing. Time O(arrays and records), memory about
// the arrays' own.
Status check_progressive_arrays(const ProgressiveArrays& arrays);

// Run-time bytes of the arrays at full resolution: DB03's claim in numbers. Each counts positions,
// indices and normals as a renderer needs them (12 bytes a position, 12 a normal, 4 an index), and,
// apart, the records that switch levels.
struct LinearBytes {
  std::size_t crease = 0;      // section 5: positions once, normals by kind
  std::size_t wedge = 0;       // Hoppe 1998: faces -> wedges -> vertices
  std::size_t replicated = 0;  // a vertex for every (position, normal) pair, one index buffer
  std::size_t records = 0;     // packed contractions, and normals that only coarser levels show
};
LinearBytes linear_bytes(const ProgressiveArrays& arrays);

// The longest chain of contractions, each of which has the vertex that the one before made: what a
// decoder must go through to refine one place.
std::uint32_t hierarchy_depth(const ProgressiveArrays& arrays);

}  // namespace crease
