// A triangle mesh with corner attributes: DB03's four arrays, generalised to any number of layers.
//
//   mesh.positions[index_of(mesh.triangles[t][c])]                 the position of corner c of t
//   normal->of_corner[3 * t + c]                                   its normal's index
//   normal->value(normal->of_corner[3 * t + c])                    its normal
//
// Any set of triangles is a mesh: open, non-manifold, non-orientable, disconnected. Two promises:
//  (1) the three vertices of a triangle differ; import drops the others and counts them;
//  (2) every index is in range, every number finite. check_mesh() tests both.
#pragma once

#include "crease/ids.h"
#include "crease/result.h"
#include "crease/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace crease {

// How values between two given ones come about.
enum class Interpolation : std::uint8_t {
  Direction,    // unit vectors, blended on the sphere
  Linear,       // blended component by component
  Categorical,  // never blended: where the value changes, there is a crease
};

enum class AttributeRole : std::uint8_t {
  Normal,    // dimension 3, Direction. At most one layer has this role
  TexCoord,  // dimension 2, v up as in OBJ
  Color,     // dimension 3 or 4, 0..1: sRGB, as files of bytes have it, then linear alpha
  Other,     // whatever the source had; the name tells
};

// One attribute: its values and, for every corner, which value it carries. Two corners share an
// attribute iff their indices are equal, whatever the values are (DB03 section 3).
struct AttributeLayer {
  std::string name;  // "normal", "uv", "color", or the source's own word
  AttributeRole role = AttributeRole::Other;
  Interpolation interpolation = Interpolation::Linear;
  std::uint32_t dimension = 1;         // floats per value, 1 to 4
  std::vector<float> values;           // dimension * value_count()
  std::vector<AttributeId> of_corner;  // 3 * triangle_count

  std::size_t value_count() const { return dimension == 0 ? 0 : values.size() / dimension; }
  std::span<const float> value(AttributeId a) const {
    return std::span<const float>(values).subspan(index_of(a) * dimension, dimension);
  }
};

struct Material {
  std::string name{};
  std::array<float, 4> base_color{1, 1, 1, 1};  // linear RGBA
  // The name of an image that multiplies the base colour, or empty. Where no image has it, it is
  // the source's reference to one that was not found, and the base colour stands alone.
  std::string base_color_texture{};
  // The surface has holes where the alpha of its texture is below this (MASK of glTF); 0: none.
  float alpha_cutoff = 0;
  bool double_sided = false;  // a hint for who culls what faces away; crease draws both sides
  // What is behind shows through where the texture's alpha or the colours' is below 1 (BLEND of
  // glTF). Where the base colour's is, that says so by itself.
  bool is_blended = false;
  bool operator==(const Material&) const = default;
};

// An image file as the source has it, PNG or JPEG; nothing but a renderer looks inside. Its first
// row is at v = 1.
struct ImageFile {
  std::string name;                                     // unique within a mesh
  std::shared_ptr<const std::vector<std::byte>> bytes;  // not null; copies of a mesh share them
};

// The image of that name, or null. Time O(images).
const ImageFile* find_image(std::span<const ImageFile> images, std::string_view name);

using Triangle = std::array<VertexId, 3>;

// The axis of the coordinates that points up. Unknown: nobody has said so; z is then as good as
// any.
enum class UpAxis : std::uint8_t { Unknown, Y, Z };

constexpr Vec3d direction_of(UpAxis up) {
  return up == UpAxis::Y ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
}

struct Mesh {
  std::vector<Vec3d> positions;                  // vertex_count, model units
  std::vector<Triangle> triangles;               // triangle_count, counter-clockwise from outside
  std::vector<AttributeLayer> layers;            // any number, normals first if there are any
  std::vector<MaterialId> material_of_triangle;  // triangle_count, or empty: no materials
  std::vector<PartId> part_of_triangle;          // triangle_count, or empty: one part
  std::vector<Material> materials;
  std::vector<std::string> parts;  // names of objects, groups or scene nodes
  // Those that materials name, as far as they are known. Levels and cuts are extracted without.
  std::vector<ImageFile> images;
  UpAxis up = UpAxis::Unknown;

  std::size_t vertex_count() const { return positions.size(); }
  std::size_t triangle_count() const { return triangles.size(); }
  // The layer with AttributeRole::Normal, or null.
  const AttributeLayer* normals() const;
  AttributeLayer* normals();
};

// The first promise that does not hold, in words. Time O(corners).
Status check_mesh(const Mesh& mesh);

// The grid that positions are snapped to before simplification; one for the whole asset, so that
// nothing cracks. Position of a grid point g: origin + step * g, in doubles, exactly as written.
struct Grid {
  Vec3d origin;     // model units
  double step = 1;  // model units per grid unit, > 0

  Vec3d position(const Vec3i& g) const {
    return {origin.x + step * g.x, origin.y + step * g.y, origin.z + step * g.z};
  }
  Vec3i nearest(const Vec3d& p) const;
  bool operator==(const Grid&) const = default;
};

// What --precision asks for: a length, or bits over the longest side of the bounding box (1 to 30).
// Neither: the grid that the model's numbers are on already, whole millimetres or six decimals, if
// its step is longer than kDefaultBits give over the longest side without strays; so nothing is
// rounded, and files are smaller.
struct Precision {
  // Walls stay planes for the simplifier. A grid as fine as a 256th of the short edges, 14 to 18
  // bits mostly, saves a third of the file and bends them: a gear at 10 % is off by nine times as
  // much as otherwise, and a corner of many sectors loses some.
  static constexpr int kDefaultBits = 24;

  double length = 0;  // model units; 0: use bits
  int bits = 0;       // 0: as said above

  int bits_or_default() const { return bits > 0 ? bits : kDefaultBits; }
};

// The shortest step that a grid of the mesh may have: 2^-30 of the longest side, and longer where
// it lies so far from the origin that doubles tell no more apart.
double finest_step(const Mesh& mesh);

// Fails with CommandLine where a length is so long that little would be left of the mesh, more than
// a 16th of the longest side; or shorter than finest_step(), negative or no number; and where bits
// are not 0 to 30.
Status check_precision(const Mesh& mesh, const Precision& precision);

// Few vertices far from all others, as a stray triangle has them. Steps that are a share of the
// longest side are coarse for all others then.
struct Strays {
  std::size_t count = 0;
  double longest = 0, longest_without = 0;  // side of the bounding box
};

// At most a thousandth of the vertices, or three, of 64 or more, without which the longest side is
// less than a 16th. Time O(vertices).
std::optional<Strays> find_strays(const Mesh& mesh);

// The origin is the bounding box's centre, rounded to a multiple of the step, so that a grid of
// whole millimetres stays on whole millimetres.
Grid make_grid(const Mesh& mesh, const Precision& precision);

// Every position on the grid, in place; how far the farthest went, in model units. Vertices are not
// merged.
double snap(Mesh& mesh, const Grid& grid);

}  // namespace crease
