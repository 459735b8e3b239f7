// Distinct index types, so that a vertex index cannot land in a triangle array.
//
//   VertexId v{3};  positions[index_of(v)]
#pragma once

#include <cstddef>
#include <cstdint>

namespace crease {

enum class VertexId : std::uint32_t {};
enum class TriangleId : std::uint32_t {};
enum class AttributeId : std::uint32_t {};  // a value of one attribute layer
enum class MaterialId : std::uint32_t {};
enum class PartId : std::uint32_t {};
enum class BlockId : std::uint32_t {};  // a block of a file, in the order in which they lie

template <typename Id>
constexpr std::size_t index_of(Id id) {
  return static_cast<std::size_t>(static_cast<std::uint32_t>(id));
}

inline constexpr std::uint32_t kNone = 0xffffffffu;  // "no index", in arrays that need one
inline constexpr AttributeId kNoAttribute{kNone};

}  // namespace crease
