// A program's own arrays in: what an engine draws or a CAD kernel tessellates becomes a mesh as a
// file's would, welded, with its hard and soft edges.
//
//   VertexArrays arrays;                                         // spans: nothing is copied yet
//   arrays.positions = Rows<float>{&vertices[0].x, vertices.size(), sizeof(Vertex)};
//   arrays.indices = indices;
//   arrays.layers.push_back({.name = "normal",
//                            .role = AttributeRole::Normal,
//                            .dimension = 3,
//                            .values = {&vertices[0].nx, vertices.size(), sizeof(Vertex)}});
//   Result<Imported> in = import_arrays(arrays, "part 17", {});
//   Result<Built> built = build_model(std::move(in->mesh), {});
//
// A vertex that was split because its normals or texture coordinates differ becomes one again.
// Where there are no normals they are made, by `options.normals` or `made_normals`.
#pragma once

#include "crease/import.h"
#include "crease/mesh.h"
#include "crease/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace crease {

// Numbers that lie in memory row by row, each row those of one vertex or value, packed or with
// other things between them.
template <typename Number>
struct Rows {
  const Number* first = nullptr;  // caller's; read by import_arrays() alone
  std::size_t count = 0;          // rows
  std::size_t stride = 0;         // bytes from one row to the next, no less than one; 0: packed
};

// One attribute: a value a vertex or, with indices of its own as OBJ has them, a corner.
struct ArrayLayer {
  std::string name;
  AttributeRole role = AttributeRole::Other;
  Interpolation interpolation = Interpolation::Linear;  // normals are Direction whatever this says
  std::uint32_t dimension = 1;  // floats a row, 1 to 4; Normal 3, TexCoord 2, Color 3 or 4
  Rows<float> values{};         // units and ranges of AttributeRole
  Rows<std::uint8_t> bytes{};   // or these: 0 to 255 for 0 to 1, as colours mostly are
  // 3 * triangle_count, rows of `values` or `bytes`, 0xffffffff where a corner has none; empty: row
  // v is of vertex v.
  std::span<const std::uint32_t> of_corner{};
};

struct VertexArrays {
  // Three a row, model units. Doubles for what lies far from the origin.
  std::variant<Rows<float>, Rows<double>> positions{};
  // 3 * triangle_count, counter-clockwise from outside; empty: every three vertices are a triangle.
  std::span<const std::uint32_t> indices{};
  std::span<const std::uint16_t> short_indices{};         // or these
  std::vector<ArrayLayer> layers{};                       // one of them Normal, at most
  std::span<const std::uint32_t> material_of_triangle{};  // triangle_count; empty: all the first
  std::vector<Material> materials{};
  std::span<const std::uint32_t> part_of_triangle{};  // triangle_count; empty: all the first
  std::vector<std::string> parts{};                   // their names
  std::vector<ImageFile> images{};                    // that materials name
  UpAxis up = UpAxis::Unknown;                        // Unknown: guessed from the shape
  NormalPolicy made_normals{NormalPolicy::Kind::Crease, 30.0};  // where options.normals is Keep
};

// Reads the arrays before it returns. `name` begins messages; import_mesh() says what becomes of
// ugly input. Fails with BadValue for an index out of range, an array of another length than the
// others ask for, two arrays where one is asked for, rows at a null pointer or that overlap, an
// image without bytes, or a position or a material's number that is not finite, and says which and
// where; with NoTriangles where none is left. Time and memory as import_mesh().
Result<Imported> import_arrays(const VertexArrays& arrays, std::string_view name,
                               const ImportOptions& options);

}  // namespace crease
