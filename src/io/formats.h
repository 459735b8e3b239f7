// The formats, one reader and one writer each; import.cpp and export.cpp choose among them.
#pragma once

#include "crease/mesh.h"
#include "crease/progress.h"
#include "crease/result.h"
#include "crease/vec.h"
#include "io/raw_mesh.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace crease {

// A file to read, unpacked already.
struct Source {
  std::span<const std::byte> bytes;
  std::string name;                               // begins every message: "NAME:LINE: reason"
  const std::filesystem::path* folder = nullptr;  // files it refers to lie here; null: ignore them
  const ProgressCallback* progress = nullptr;     // may be null or empty

  // The bytes as characters.
  std::string_view text() const {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
};

// "NAME:17: reason" and "NAME: byte 4096: reason".
Failure fail_at_line(Error error, const Source& source, std::size_t line,
                     const std::string& reason);
Failure fail_at_byte(Error error, const Source& source, std::size_t offset,
                     const std::string& reason);

// Finite, and small enough that squares and cubes of it are: a coordinate that can be meant.
inline constexpr double kMaxCoordinate = 1e30;
bool is_position(const Vec3d& p);
// What is wrong with one that is none: "not finite" or "beyond 1e30".
const char* fault_of(const Vec3d& p);

// The longest side of a model that has triangles, at least: errors and steps of a grid over it are
// floats, and stay so.
inline constexpr double kMinExtent = 1e-30;
// Between these, squares of them are floats as well, which a view compares.
inline constexpr double kLeastSeen = 1e-20, kMostSeen = 1e18;

Result<RawMesh> read_obj(const Source& source);
Result<RawMesh> read_ply(const Source& source);
Result<RawMesh> read_stl(const Source& source);
Result<RawMesh> read_off(const Source& source);
Result<RawMesh> read_gltf(const Source& source);      // .gltf, .glb, .b3dm, told by the first bytes
Result<RawMesh> read_cityjson(const Source& source);  // CityJSON and CityJSONSeq

// The header of an STL written here; behind it, what was taken off all positions: " less X Y Z".
inline constexpr std::string_view kStlHeader = "binary STL, written by crease";
inline constexpr std::string_view kStlLess = " less";
// The layer of its facets' attribute bytes.
inline constexpr std::string_view kStlAttribute = "stl_attribute";

// `mtl_name` is the material library that the OBJ refers to; empty: none.
std::vector<std::byte> write_obj(const Mesh& mesh, std::string_view mtl_name);
// `image_files`: what the mesh's images are called in the library; likewise in a PLY, if they are
// written beside it.
std::vector<std::byte> write_mtl(const Mesh& mesh, std::span<const std::string> image_files);
std::vector<std::byte> write_ply(const Mesh& mesh, std::span<const std::string> image_files = {});
std::vector<std::byte> write_stl(const Mesh& mesh);
Result<std::vector<std::byte>> write_glb(const Mesh& mesh);

}  // namespace crease
