// The mesh under simplification: the input with every contraction of the finished bands applied.
// Patches read it and, when they are done, write their own triangles and inner vertices back; no
// two patches of a band share either, so they need no locks.
#pragma once

#include "crease/contraction.h"
#include "crease/mesh.h"
#include "hierarchy/same_value.h"
#include "hierarchy/witnesses.h"
#include "simplify/far_area.h"

#include <cstdint>
#include <span>
#include <vector>

namespace crease::simplification {

inline constexpr std::uint32_t kShared = 0xfffffffeu;  // owner of a vertex that patches share

// A part of fewer triangles than this, a leaf, a tile of a roof, has none to give.
inline constexpr std::uint32_t kCard = 4;

struct WorkLayer {
  const AttributeLayer* source = nullptr;
  int dimension = 1;
  bool blends = true;   // not categorical
  bool steers = false;  // counts in the cost: what blends, but for a number that is always the same
  bool is_direction = false;
  bool is_normal = false;
  double range = 0;        // of the input's values, the widest component's
  double importance = 1;   // of a unit of it, where it is no normal and no texture coordinate: 1
                           // of colours, whose range is 0 to 1
  double line_weight = 1;  // of an edge at whose sides it differs, as a crease; not of normals
  double length_per_unit = 0;            // what one unit of the attribute is worth as a distance,
                                         // grid units; set anew in every band
  SameValue same;                        // likewise
  std::vector<std::uint32_t> of_corner;  // 3 a triangle, input values then new ones
  std::vector<float> new_values;

  std::size_t value_count() const {
    return source->value_count() + new_values.size() / static_cast<std::size_t>(dimension);
  }
  const float* value(std::uint32_t id) const {
    const std::size_t d = static_cast<std::size_t>(dimension);
    const std::size_t input = source->value_count();
    return id < input ? source->values.data() + id * d : new_values.data() + (id - input) * d;
  }
};

// The input normals that a flat triangle stands for: with n of unit length, the area where they
// differ from n, times the square of the difference, is 2 * (area - n.sum).
struct Represented {
  Vec3f sum;  // of area * normal
  float area = 0;
};

struct WorkMesh {
  std::vector<Vec3i> positions;                 // per input vertex, grid units
  std::vector<LevelError> error_of_vertex;      // of the contractions under it, surface and line in
                                                // grid units
  std::vector<float> grown_of_vertex;           // volume that those have added, grid units^3
  std::vector<std::uint32_t> owner_of_vertex;   // patch, or kShared, or kNone; of the present band
  std::vector<std::uint32_t> vertex_of_corner;  // 3 a triangle
  std::vector<std::uint32_t> category_of_triangle;  // part * material_count + material; empty: all
                                                    // the same
  std::uint32_t material_count = 1;
  std::vector<char> derived;                  // per triangle: shows its geometric normal
  std::vector<Represented> represented;       // per triangle; empty: nothing is flat
  std::vector<char> inside_out;               // per triangle: wound against its normals, as
                                              // most of its part; empty: none is
  std::vector<std::uint32_t> part_of_vertex;  // a vertex of the part: equal for vertices that
                                              // triangles or contractions connect
  std::size_t part_count = 0;
  bool has_copies = false;                       // many of the input's triangles are there twice
  std::vector<std::uint32_t> triangles_of_part;  // by the part's vertex, at the pass's start
  std::vector<float> area_of_part;               // likewise, twice the area, grid units
  std::vector<std::uint32_t> live;               // the triangles that are left, ascending
  std::vector<WorkLayer> layers;
  Witnesses witnesses;  // of the input, or none
};

// The input, nothing contracted; `mesh` must outlive it. Who owns a vertex and what part it is of
// are left open.
WorkMesh make_work(const Mesh& mesh, const Grid& grid);

// What holds for the input as a whole; once the parts are known.
void find_inside_out(WorkMesh& work);
void find_copies(const Mesh& mesh, WorkMesh& work);

// What one patch did in one band, in its own numbering of new attribute values.
struct PatchContraction {
  double key;  // steering cost; never falls inside a patch
  Contraction contraction;
};

struct PatchResult {
  std::vector<PatchContraction> contractions;
  std::vector<AttributeChange> changes;  // ids >= kLocalValue: local new value
  std::vector<TriangleId> derived;
  std::vector<std::vector<float>> new_values;  // per layer
  std::size_t triangles_left = 0;
  FarCounts far_counts;

  // Nothing, but the memory stays.
  void clear() {
    contractions.clear();
    changes.clear();
    derived.clear();
    for (std::vector<float>& values : new_values) values.clear();
    triangles_left = 0;
    far_counts = {};
  }
};

inline constexpr std::uint32_t kLocalValue = 0x80000000u;

}  // namespace crease::simplification
