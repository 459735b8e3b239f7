// FILE of the command line: a .crease, or any mesh file.
//
//   Result<Mesh> mesh = load_mesh("city.crease", {}, common);      // full resolution of either
//   Result<Model> model = load_model("city.obj", {}, common);      // levels of either
#pragma once

#include "cli/command.h"
#include "crease/build.h"
#include "crease/file.h"
#include "crease/import.h"

#include <filesystem>
#include <optional>
#include <string>

namespace crease::cli {

// Command line options that say how a mesh file is read and built.
struct ReadOptions {
  std::string normals = "keep";
  double same_normal_deg = 0;
  std::string precision;  // empty: the library's default
  std::string placement = "optimal";
  std::string normal_coding = "octahedral";
  std::string normal_bits, texcoord_bits, color_bits;  // empty: the library's default
};

// --normals and --same-normal, for commands that read meshes.
void add_import_options(CLI::App& command, ReadOptions& options);
// Those, --precision, --placement and the attributes' bits, for commands that build.
void add_build_options(CLI::App& command, ReadOptions& options);

Result<ImportOptions> import_options(const ReadOptions& options, const Common& common);
Result<BuildOptions> build_options(const ReadOptions& options, const Common& common);

struct Model {
  CreaseFile file;
  std::optional<ImportReport> built_from;  // when FILE was a mesh and was built on the fly
};

// Told from the first bytes, whatever the name. False as well when the file cannot be read.
bool is_crease_file(const std::filesystem::path& path);

Result<Model> load_model(const std::filesystem::path& path, const ReadOptions& options,
                         const Common& common);
Result<Mesh> load_mesh(const std::filesystem::path& path, const ReadOptions& options,
                       const Common& common);

}  // namespace crease::cli
