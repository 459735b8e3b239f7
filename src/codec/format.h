// The tables of docs/format-1.md (version 1) as constants.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace crease::format {

inline constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'C', 'R', 'E', 'A', 'S', 'E', '\n'};
inline constexpr std::uint16_t kVersion = 1;
inline constexpr std::size_t kHeaderBytes = 32;
inline constexpr std::size_t kChecksumOffset = 24;
inline constexpr std::size_t kEntryBytes = 32;

enum class Kind : std::uint32_t {
  Schema = 1,
  Materials = 2,
  Parts = 3,
  Bands = 4,
  Positions = 10,
  TriangleIndices = 11,
  Normals = 12,
  FnNormals = 13,
  NsnNormals = 14,
  MaterialOfTriangle = 15,
  PartOfTriangle = 16,
  Layer = 20,
  LayerValues = 21,
  LayerRows = 22,
  LayerIndices = 23,
  Kept = 30,
  Headers = 31,
  Deltas = 32,
  Wide = 33,
  Corners = 34,
  Own = 35,
  BlockEnds = 36,
  Blocks = 37,
  Errors = 38,
};

struct KindRow {
  Kind kind;
  const char* name;
  std::size_t item_bytes;  // the section is an array of these; 0: it is not
};

inline constexpr KindRow kKinds[] = {
    {Kind::Schema, "schema", 0},
    {Kind::Materials, "materials", 0},
    {Kind::Parts, "parts", 0},
    {Kind::Bands, "bands", 16},
    {Kind::Positions, "positions", 12},
    {Kind::TriangleIndices, "triangle indices", 4},
    {Kind::Normals, "normals", 12},
    {Kind::FnNormals, "normal indices of FN triangles", 4},
    {Kind::NsnNormals, "normal indices of NSN triangles", 4},
    {Kind::MaterialOfTriangle, "materials of triangles", 4},
    {Kind::PartOfTriangle, "parts of triangles", 4},
    {Kind::Layer, "layer", 0},
    {Kind::LayerValues, "layer values", 4},
    {Kind::LayerRows, "layer rows", 4},
    {Kind::LayerIndices, "layer indices", 4},
    {Kind::Kept, "contraction kept", 4},
    {Kind::Headers, "contraction headers", 4},
    {Kind::Deltas, "deltas", 12},
    {Kind::Wide, "contraction wide counts", 24},
    {Kind::Corners, "contraction corners", 4},
    {Kind::Own, "own value changes", 4},
    {Kind::BlockEnds, "attribute change ends", 4},
    {Kind::Blocks, "attribute changes", 4},
    {Kind::Errors, "errors", 20},
};

constexpr const KindRow* find_kind(std::uint32_t kind) {
  for (const KindRow& row : kKinds) {
    if (static_cast<std::uint32_t>(row.kind) == kind) return &row;
  }
  return nullptr;
}

constexpr bool is_of_layer(Kind kind) {
  return kind >= Kind::Layer && kind <= Kind::LayerIndices;
}

}  // namespace crease::format
