// What a block refines: the triangles of one patch at one end of its band.
#pragma once

#include "codec/learning_rates.h"
#include "crease/vec.h"
#include "mesh/octahedral.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace crease::codec {

// An attribute value as integers: a direction's code, a point of a lattice, the bits of floats, a
// category. Corners share an attribute iff their values are equal.
struct CodedValue : std::array<std::int32_t, 4> {
  // Two comparisons, where those of an array are a call.
  friend bool operator==(const CodedValue& a, const CodedValue& b) {
    std::uint64_t x[2], y[2];
    std::memcpy(x, a.data(), sizeof x);
    std::memcpy(y, b.data(), sizeof y);
    return ((x[0] ^ y[0]) | (x[1] ^ y[1])) == 0;
  }
};

inline CodedValue coded(OctahedralCode code) {
  return {static_cast<std::int32_t>(code.u), static_cast<std::int32_t>(code.v), 0, 0};
}
inline OctahedralCode octahedral_code(const CodedValue& value) {
  return {static_cast<std::uint32_t>(value[0]), static_cast<std::uint32_t>(value[1])};
}

using Corners = std::array<std::uint32_t, 3>;  // vertices of a triangle

// Which of the corners v is; it must be one. No branch, since nobody can tell which.
constexpr std::uint32_t corner_of(const Corners& corners, std::uint32_t v) {
  const std::uint32_t is_later = corners[0] != v;
  return is_later + (is_later & std::uint32_t(corners[1] != v));
}
// The corners after and before each.
inline constexpr std::size_t kCornerAfter[] = {1, 2, 0}, kCornerBefore[] = {2, 0, 1};

struct PatchMesh {
  std::vector<Vec3i> positions;                 // per vertex, grid units
  std::vector<Corners> triangles;               //
  std::vector<std::uint32_t> category;          // per triangle: material and part as one
  std::vector<std::vector<CodedValue>> values;  // per layer, 3 a triangle
  std::vector<char> derived;                    // per triangle: shows its geometric normal, and its
                                                // values of the normal layer have no meaning
};

// How the values of a layer are coded.
struct BlockLayer {
  int dimension = 1;        // of CodedValue
  bool is_normal = false;   // triangles may be derived
  int octahedral_bits = 0;  // u and v of an OctahedralCode, so many bits each; 0: no direction
  bool is_raw = false;      // all 32 bits of every component, with no order among them
  std::array<std::int32_t, 4> grains{1, 1, 1, 1};  // by component: NumberLattice::grain

  // Numbers that lie in order, so that what is between two is between their values.
  bool is_lattice() const { return octahedral_bits == 0 && !is_raw; }
  bool has_grain() const { return grains != std::array<std::int32_t, 4>{1, 1, 1, 1}; }
};

struct BlockCoding {
  std::vector<BlockLayer> layers;
  std::uint32_t material_count = 1, part_count = 1;  // category = part * material_count + material
  LearningRates rates{};
};

}  // namespace crease::codec
