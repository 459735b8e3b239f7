// Other people's files in: OBJ, PLY, STL, OFF, glTF/GLB (also inside .b3dm), CityJSON.
//
//   Result<Imported> in = import_mesh("city.obj.xz", {});
//   if (!in.ok()) ...in.failure().message names the file, the place and the reason
//
// The result keeps hard and soft edges as the file has them: OBJ's v/vt/vn indices and smoothing
// groups are kept; formats that store split vertices (glTF, PLY, STL) are welded by bit-equal
// positions and bit-equal attribute values. Scene transforms are baked, in doubles. The images of
// materials come along, from inside a glTF or from files beside it; one that is not found is a
// note. What points up is y in glTF and z in CityJSON; elsewhere it is guessed from the shape.
// Input that cannot be meant is refused; input that is merely ugly is accepted and counted.
#pragma once

#include "crease/mesh.h"
#include "crease/progress.h"
#include "crease/result.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace crease {

// Where a mesh without normals gets them from, and whether given ones are used.
struct NormalPolicy {
  enum class Kind { Keep, Flat, Smooth, Crease };
  Kind kind = Kind::Keep;        // Keep: the file's; without any, the format's default (below)
  double crease_angle_deg = 30;  // Crease: edges sharper than this are hard
  bool operator==(const NormalPolicy&) const = default;
};
// "keep", "flat", "smooth" or "crease:ANGLE".
Result<NormalPolicy> parse_normal_policy(std::string_view text);

struct ImportOptions {
  NormalPolicy normals{};
  // Normals at one vertex that differ by no more than this, in degrees, become one (exporter noise
  // is not a crease). 0 joins bit-equal values only.
  double same_normal_deg = 0;
  // Vertices at open borders that are no farther apart than a step of this grid become one before
  // normals are made. None: than 2^-22 of the longest side, so that seams and poles close which a
  // sine has not closed.
  std::optional<Precision> precision{};
  // Where images are looked for that the model's own folder lacks, by the last part of their path.
  std::optional<std::filesystem::path> texture_folder{};
  ProgressCallback progress{};
};

// What was ugly, and what was done about it. Printed by the command line tool.
struct ImportReport {
  std::string format;   // "OBJ", "binary STL", ...
  std::string normals;  // where the normals come from, in words
  // What makes such normals of another file; none: they are the file's, or by its smoothing groups.
  std::optional<NormalPolicy> made_normals;
  UpAxis up = UpAxis::Unknown;           // Mesh::up
  bool up_is_guessed = false;            // from the shape, as the file does not say
  std::size_t polygons = 0;              // faces with more than three corners, triangulated
  std::size_t degenerate_triangles = 0;  // two equal corners: dropped
  std::size_t duplicate_triangles = 0;   // kept
  std::size_t zero_area_triangles = 0;   // kept
  std::size_t misoriented_edges = 0;     // of two triangles that both run through it one way: kept
  std::size_t reversed_normals = 0;      // triangles whose normals are against their winding: kept
  std::size_t isolated_vertices = 0;     // dropped
  std::size_t welded_vertices = 0;       // stored vertices less distinct positions
  std::size_t zero_normals = 0;          // replaced by the geometric normal
  std::size_t bad_attribute_values = 0;  // attribute values that were not finite: set to zero
  std::size_t joined_normals = 0;        // by same_normal_deg
  std::vector<std::string> notes;        // anything else worth a line: ignored elements, ...
  std::vector<std::filesystem::path> libraries;  // of materials, of an OBJ: those that were read
};

struct Imported {
  Mesh mesh;  // with a normal layer first; check_mesh() holds
  ImportReport report;
};

// Reads one file; `.zst` and `.xz` are unpacked on the way. The format is told from the name and,
// where that says nothing, from the first bytes. Formats' own default for absent normals: glTF and
// CityJSON flat; STL, PLY and OFF crease 30 degrees; OBJ smoothing groups, without them crease 30.
// Where most edges over 30 degrees are fragments, as in scans, crease 30 gives way to smooth. An
// edge inside a polygon of the file is never hard. Time O(n log n), memory about three times the
// mesh.
Result<Imported> import_mesh(const std::filesystem::path& path, const ImportOptions& options);

// The same for bytes in memory; `name` tells the format and appears in messages. Files that a glTF
// refers to are looked for beside `name` only when `folder` is given.
Result<Imported> import_bytes(std::span<const std::byte> bytes, std::string_view name,
                              const ImportOptions& options,
                              const std::filesystem::path* folder = nullptr);

// Several files as one mesh: vertices at bit-equal positions are shared, each file is a part, or
// several where it has some of its own ("wing.glb/flap"). Where a file lacks colours that another
// has it is white; where it lacks another layer, zero.
Result<Imported> import_meshes(std::span<const std::filesystem::path> paths,
                               const ImportOptions& options);

// Adds to `images` the files that materials name as their textures and it lacks, out of the first
// of `folders` that has them, and returns a note for each that is in none. A name is a path that
// does not lead out of a folder; what is not where it says is looked for in the folder itself. In
// another case it is found where nothing has its own, as Windows would. PNG and JPEG, 256 MiB each
// and 4096 of them at most. What a note says of `folders` is of the first, the model's own.
// import_mesh() does so; this is for images that a build did not find.
std::vector<std::string> find_images(std::span<const std::filesystem::path> folders,
                                     std::span<const Material> materials,
                                     std::vector<ImageFile>& images);

}  // namespace crease
