// What every format reader fills: the file as it is, in doubles, before anything is welded.
//
//   RawMesh raw;
//   raw.positions = ...;                              // stored vertices, repeats and all
//   raw.triangles.push_back({0, 1, 2});               // polygons: see triangulate_polygon.h
//   raw.layers.push_back(texcoord_layer("uv", RawLayer::Per::Vertex));
//   return finish_import(std::move(raw), options);    // weld, drop, normals: import.cpp does this
//
// A reader promises: indices in range, positions finite (else it fails with file, place and
// reason). It need not care for: equal corners, unused vertices, bad attribute values, zero or long
// normals, missing normals, repeated positions. finish_import() settles and counts those.
#pragma once

#include "crease/ids.h"
#include "crease/import.h"
#include "crease/mesh.h"
#include "crease/vec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace crease {

// One attribute as the file stores it.
struct RawLayer {
  enum class Per : std::uint8_t {
    Corner,  // of_corner has 3 * triangle_count indices into values; kNone: no value at this corner
    Vertex,  // stored vertex v has value v
    Face,    // face f (RawMesh::face_of_triangle) has value f
  };
  std::string name;
  AttributeRole role = AttributeRole::Other;
  Interpolation interpolation = Interpolation::Linear;
  Per per = Per::Vertex;
  std::uint32_t dimension = 1;           // floats per value, 1 to 4
  std::vector<float> values;             // dimension * (values, vertices or faces)
  std::vector<std::uint32_t> of_corner;  // Per::Corner only

  std::size_t value_count() const { return values.size() / dimension; }
};

// "normal", "uv" and "color" with their roles, interpolation and dimension. Colours are linear 0..1
// (a reader decodes sRGB only where its format says so), texture coordinates have v up as in OBJ.
inline RawLayer normal_layer(RawLayer::Per per) {
  return {"normal", AttributeRole::Normal, Interpolation::Direction, per, 3, {}, {}};
}
inline RawLayer texcoord_layer(std::string name, RawLayer::Per per) {
  return {std::move(name), AttributeRole::TexCoord, Interpolation::Linear, per, 2, {}, {}};
}
inline RawLayer color_layer(RawLayer::Per per, std::uint32_t dimension) {
  return {"color", AttributeRole::Color, Interpolation::Linear, per, dimension, {}, {}};
}

// Numbers of a file that are no floats, which the values of a layer are: a whole number beyond
// 2^24, most doubles.
struct Rounded {
  std::size_t count = 0;
  double most = 0;  // that one of them is off by

  float to_float(double x) {
    const auto rounded = static_cast<float>(x);
    const double off = std::abs(static_cast<double>(rounded) - x);
    if (off > 0 && std::isfinite(off)) {  // others are bad values
      ++count;
      most = std::max(most, off);
    }
    return rounded;
  }
  void add(const Rounded& other) {
    count += other.count;
    most = std::max(most, other.most);
  }
  // For the notes of an import, if there are any.
  void tell(const std::string& layer, std::vector<std::string>& notes) const;
};

// For the notes: "2 materials are WHAT ('brick', ...)"; nothing if `which` says so of none.
void note_materials(std::span<const Material> materials, const std::vector<bool>& which,
                    const std::string& what, std::vector<std::string>& notes);

struct RawMesh {
  std::vector<Vec3d> positions;  // stored vertices, model units
  std::vector<std::array<std::uint32_t, 3>>
      triangles;  // stored vertices; polygons are triangulated
  // The source polygon of each triangle; empty: every triangle is a face of its own. The triangles
  // of one polygon share one normal where normals are flat, and no edge between them is hard.
  std::vector<std::uint32_t> face_of_triangle;
  std::vector<RawLayer> layers;                // any number; one normal layer at most, anywhere
  std::vector<std::uint32_t> smoothing_group;  // per triangle, 0 = none; empty: no such thing here
  std::vector<MaterialId> material_of_triangle;  // per triangle, or empty
  std::vector<PartId> part_of_triangle;          // per triangle, or empty
  std::vector<Material> materials;
  std::vector<std::string> parts;
  std::vector<ImageFile> images;  // from inside the file; import.cpp looks for others beside it

  UpAxis up = UpAxis::Unknown;  // as the file or its format says
  UpAxis usual_up = UpAxis::Y;  // of files in a format that does not

  // What normals are when the file has none, or lacks them at some corners, and the policy is Keep.
  // Smoothing groups, where there are any, go before this.
  NormalPolicy default_normals{NormalPolicy::Kind::Crease, 30};

  // format, polygons, notes, and bad values that never reached a layer; finish_import() adds the
  // rest.
  ImportReport report;
};

// Welds, drops, joins, fills in normals, counts: RawMesh to a mesh that holds check_mesh().
//
//  - bit-equal positions become one vertex (-0 == +0); bit-equal values of a layer become one
//  value;
//  - triangles with two equal corners and vertices without a triangle are dropped;
//  - values that are not finite become zero; normals of length zero become the geometric one;
//  - normals are made unit only if they are off by more than 1e-3, so that exact ones keep their
//  bits;
//  - a corner without a value in a layer gets zero, a corner without a normal gets one by policy;
//  - the policy of `options` overrides the file's normals unless it is Keep;
//  - normals at one vertex within options.same_normal_deg are joined (mesh/normals.h).
//
// Fails with NoTriangles if none is left; `name` begins that message. Deterministic.
Result<Imported> finish_import(RawMesh raw, const ImportOptions& options, const std::string& name);

}  // namespace crease
