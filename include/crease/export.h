// Meshes out: .obj, .ply (binary little-endian), .stl (binary), .glb, told from the name.
//
//   Result<ExportReport> told = export_mesh(mesh, "level.glb");
//
// Normals are always written. In OBJ hard edges are separate vn indices; in PLY and GLB they are
// split vertices, as those formats want. Positions are written in double precision where the format
// has text or doubles (OBJ, PLY), and in GLB as floats relative to a node translation, so that 10^6
// m offsets lose nothing visible. STL has floats alone: so far out it is written elsewhere, which
// the report says. The mesh's images go into a GLB; beside level.obj and level.ply they become
// level_wood.png and the like, which level.mtl and the PLY name; STL has none. The file appears
// under its name only when it is complete.
#pragma once

#include "crease/mesh.h"
#include "crease/result.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace crease {

// What of the mesh its file does not say.
struct ExportReport {
  // Was taken off all positions: what other readers show is less this. Of an STL whose floats would
  // be off by more than a millionth of the longest side; of all others zero.
  Vec3d origin;
  double rounding = 0;  // how far positions are off at most, as STL and GLB have floats
  // What has no place there, in words: "normals", "colours 'color'", "parts (12)".
  std::vector<std::string> left_out;
};

// Fails with NotSupported for another ending and WriteFailed with the system's reason.
Result<ExportReport> export_mesh(const Mesh& mesh, const std::filesystem::path& path);
// The files that it writes: the images that lie beside, an OBJ's library, and `path`.
std::vector<std::filesystem::path> files_of_export(const Mesh& mesh,
                                                   const std::filesystem::path& path);
// Of a file with that ending. Time O(vertices).
ExportReport export_report(const Mesh& mesh, std::string_view extension);

// The file's bytes; `extension` is ".obj", ".ply", ".stl" or ".glb".
Result<std::vector<std::byte>> export_bytes(const Mesh& mesh, std::string_view extension);

// Several levels in one GLB with MSFT_lod: a viewer that knows the extension switches between them,
// others show the finest. `screen_coverage`, one a level or empty: the share of the screen's height
// down to which the level is meant, the last one for vanishing. Materials are shared.
Result<std::vector<std::byte>> export_lod_glb(std::span<const Mesh> levels_finest_first,
                                              std::span<const double> screen_coverage);

}  // namespace crease
