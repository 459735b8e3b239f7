// Which level of detail the command line asks for, and how far it is from the full mesh.
//
//   LevelOptions asked;  add_level_options(*command, asked);
//   Result<Chosen> chosen = choose_level(mesh, full, asked, common);   // moves `mesh` there
#pragma once

#include "cli/command.h"
#include "crease/compare.h"
#include "crease/progressive_mesh.h"

#include <cstddef>
#include <optional>
#include <string>

namespace crease::cli {

// At most one of the first three; none: full resolution.
struct LevelOptions {
  std::optional<std::size_t> triangles{};
  std::optional<double> ratio{};
  std::optional<double> error{};
  std::size_t samples = 100'000;  // to measure means and normals with, on each surface
};

void add_level_options(CLI::App& command, LevelOptions& options);

enum class StoppedBy {
  View,       // what a camera sees is right
  Triangles,  // the count asked for is reached
  Error,      // the next coarser level that was tried is off by more than asked
  Base,       // the coarsest level is good enough
  Topology,   // the coarsest level has more triangles than asked
};
const char* name_of(StoppedBy stop);

struct Chosen {
  StoppedBy stopped_by = StoppedBy::Base;
  bool target_met = true;              // but for Topology
  std::optional<Comparison> measured;  // of the level in force, with --error
};

// Why the level is not what was asked for.
std::string shortfall_of(std::size_t triangles);

// Moves `mesh` to the level asked for. With --error that is the coarsest that is nowhere further
// from `full`, both ways, than the length asked: quadrics only tell where to look.
Result<Chosen> choose_level(ProgressiveMesh& mesh, const Mesh& full, const LevelOptions& asked,
                            const Common& common);

// How far a level is from `full`.
Result<Comparison> measure_level(const Mesh& full, const Mesh& level, std::size_t samples,
                                 const Common& common);

}  // namespace crease::cli
