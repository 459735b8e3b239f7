// Meshes out: .obj, .ply (binary little-endian), .stl (binary), .glb, told from the name.
//
//   Status done = export_mesh(mesh, "level.glb");
//
// Normals are always written. In OBJ hard edges are separate vn indices; in PLY and GLB they are
// split vertices, as those formats want. Positions are written in double precision where the format
// has text or doubles (OBJ, PLY), and in GLB as floats relative to a node translation, so that 10^6
// m offsets lose nothing visible. The mesh's images go into a GLB; beside level.obj they become
// level_wood.png and the like, which level.mtl names; PLY and STL have none. The file appears under
// its name only when it is complete.
#pragma once

#include "crease/mesh.h"
#include "crease/result.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace crease {

// Fails with NotSupported for another ending and WriteFailed with the system's reason.
Status export_mesh(const Mesh& mesh, const std::filesystem::path& path);

// The file's bytes; `extension` is ".obj", ".ply", ".stl" or ".glb".
Result<std::vector<std::byte>> export_bytes(const Mesh& mesh, std::string_view extension);

// Several levels in one GLB with MSFT_lod: a viewer that knows the extension switches between them,
// others show the finest. `screen_coverage`, one a level or empty: the share of the screen's height
// down to which the level is meant, the last one for vanishing. Materials are shared.
Result<std::vector<std::byte>> export_lod_glb(std::span<const Mesh> levels_finest_first,
                                              std::span<const double> screen_coverage);

}  // namespace crease
