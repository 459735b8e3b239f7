// `extract --levels`: a chain of levels for engines, as one GLB per level with a manifest, or as
// one GLB whose node carries MSFT_lod.
#pragma once

#include "cli/command.h"
#include "crease/progressive_mesh.h"

#include <cstddef>
#include <filesystem>
#include <vector>

namespace crease::cli {

struct LodChainOptions {
  int levels = 0;     // 0: no chain
  double step = 0.5;  // triangles of a level beside the one before
  bool one_glb = false;
  bool strict = false;  // write nothing where there are fewer levels, or one has more triangles
};

void add_chain_options(CLI::App& command, LodChainOptions& options);

// What extract_chain() writes at most.
std::vector<std::filesystem::path> files_of_chain(const std::filesystem::path& output,
                                                  const LodChainOptions& options);

// Writes city_0.glb, city_1.glb, ... and city.json for the output city.glb; with one_glb city.glb.
// Every level is measured against the full mesh, when `samples` is not 0.
// Each has the images.
Result<Report> extract_chain(ProgressiveMesh& mesh, const std::vector<ImageFile>& images,
                             const std::filesystem::path& output, const LodChainOptions& options,
                             std::size_t samples, const Common& common);

}  // namespace crease::cli
