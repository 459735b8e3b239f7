// What a command may write to, and meshes written there.
//
//   Status fine = check_output(options.output, kMeshEndings, "levels are", {&options.file, 1});
#pragma once

#include "cli/command.h"
#include "crease/export.h"
#include "crease/mesh.h"
#include "crease/result.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace crease::cli {

inline constexpr std::string_view kMeshEndings[] = {".obj", ".ply", ".stl", ".glb"};

// ".glb" of "X.GLB".
std::string ending_of(const std::filesystem::path& path);

// All of these refuse before any work is done.

// An output whose ending is none of `endings`. Where there is one ending, a name without any, as
// pipes have it, will do. `what` begins the message: "levels are".
Status check_ending(const std::filesystem::path& output, std::span<const std::string_view> endings,
                    std::string_view what);

// One that is among the inputs, or where nothing can be written.
Status check_place(const std::filesystem::path& output,
                   std::span<const std::filesystem::path> inputs);

// Both.
Status check_output(const std::filesystem::path& output, std::span<const std::string_view> endings,
                    std::string_view what, std::span<const std::filesystem::path> inputs);

// Whether an output goes where answers are printed.
bool is_standard_output(const std::filesystem::path& output);

struct WriteOptions {
  // Which none of the files that it writes may be, an OBJ's library and images among them.
  std::vector<std::filesystem::path> inputs{};
  // What the mesh lacks already, in the words of ExportReport::left_out.
  std::vector<std::string> lost{};
};

// export_mesh(), and what the file does not say is logged.
Result<ExportReport> write_mesh(const Mesh& mesh, const std::filesystem::path& output,
                                const Common& common, const WriteOptions& options = {});

}  // namespace crease::cli
