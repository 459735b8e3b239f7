// FILE of the command line: a .crease here or at a URL, or any mesh file.
//
//   Result<Mesh> mesh = load_mesh("city.crease", {}, common);      // full resolution of either
//   Result<ModelFile> file = open_model("city.obj", {}, common);   // blocks of either
//   Result<Model> model = file->load({.triangles = 10'000});       // reads what that needs
#pragma once

#include "cli/command.h"
#include "crease/adaptive_mesh.h"
#include "crease/build.h"
#include "crease/file.h"
#include "crease/import.h"
#include "crease/progressive_mesh.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace crease::cli {

// Command line options that say how a mesh file is read and built.
struct ReadOptions {
  std::string normals = "keep";
  double same_normal_deg = 0;
  std::string texture_folder;  // empty: none besides the model's own
  std::string precision;       // empty: the library's default
  std::string placement = "optimal";
  std::string normal_coding = "octahedral";
  std::string normal_bits, texcoord_bits, color_bits;  // empty: the library's default
};

// --normals, --same-normal and --textures, for commands that read meshes.
void add_import_options(CLI::App& command, ReadOptions& options);
// Those, --precision, --placement and the attributes' bits, for commands that build.
void add_build_options(CLI::App& command, ReadOptions& options);

Result<ImportOptions> import_options(const ReadOptions& options, const Common& common);
Result<BuildOptions> build_options(const ReadOptions& options, const Common& common);

// Tells in the report that few vertices make the grid coarse for all, and what can be done.
void tell_strays(Imported& imported, const Precision& precision);

// What to decode of a file.
struct Detail {
  std::optional<std::size_t> triangles{};  // levels of so many and fewer; none: all
  bool is_one_level = false;               // the finest of those alone
  std::optional<ViewParameters> view{};    // the blocks that its cut depends on
  bool is_mesh_only = false;               // the finest mesh of these blocks, and no level of it
  // Without their names, which lie at the file's end, the mesh has no parts.
  bool part_names = true;
};

// The coarsest band whose fine end has more triangles, or the finest: what is finer is not needed.
// Where a band's coarse end has exactly as many, it may go on for a while without taking any away,
// as where loose cards join, and the finest level of so many is within it.
std::uint16_t finest_band_for(const ModelFacts& facts, std::size_t triangles);

struct Model {
  DecodedModel decoded;
  std::uint64_t bytes_read = 0;  // of the file, for this model

  // For levels. Takes the decoded model's memory as well.
  ProgressiveMesh levels() const;
};

class ModelFile {
 public:
  Result<Model> load(const Detail& detail = {}) const;
  // Of `materials`, read now: those in the file, and for others files beside it. What is missing is
  // logged. For meshes that load() gave and for draw lists.
  Result<std::vector<ImageFile>> images(std::span<const Material> materials) const;
  // The format allows files without; nothing can be done with them here.
  Status check_normals() const;
  const BlockFile& blocks() const { return blocks_; }
  std::size_t triangle_count() const {
    return static_cast<std::size_t>(blocks_.facts().triangle_count);
  }
  bool is_remote() const;  // on a host
  std::uint64_t bytes_to_open() const { return bytes_to_open_; }
  // All that came from a host until now. Of a file here, which may be read again and again, how
  // much of it that is.
  std::uint64_t bytes_read() const;
  std::string name() const;                           // without folders or host
  bool was_built() const { return !built_.empty(); }  // FILE was a mesh, built on the fly
  const std::optional<ImportReport>& imported() const { return imported_; }  // of such a mesh

 private:
  friend Result<ModelFile> open_model(const std::filesystem::path& path, const ReadOptions& options,
                                      const Common& common);
  ModelFile(BlockFile blocks, std::vector<std::byte> built, const Common& common);

  std::vector<std::byte> built_;  // what blocks_ reads, or empty
  std::optional<ImportReport> imported_;
  std::string texture_folder_;
  BlockFile blocks_;
  std::uint64_t read_to_open_;   // of the source
  std::uint64_t bytes_to_open_;  // as they are told
  const Common* common_;
};

// SCHEME://..., of which http and https are read; such a FILE is a .crease.
bool is_url(const std::filesystem::path& path);

// Told from the first bytes, whatever the name. False as well when the file cannot be read.
bool is_crease_file(const std::filesystem::path& path);

// Threads and limits as the command line has them.
DecodeOptions decode_options(const Common& common);

Result<ModelFile> open_model(const std::filesystem::path& path, const ReadOptions& options,
                             const Common& common);
// To measure and to draw: of a .crease without parts. `report`, where not null, is filled where a
// mesh file was imported.
Result<Mesh> load_mesh(const std::filesystem::path& path, const ReadOptions& options,
                       const Common& common, ImportReport* report = nullptr);

}  // namespace crease::cli
