// What the library measured and counted, as --json fields (DESIGN 9) and as lines.
#pragma once

#include "cli/command.h"
#include "crease/compare.h"
#include "crease/contraction.h"
#include "crease/file.h"
#include "crease/import.h"

#include <cstddef>
#include <string>

namespace crease::cli {

Json to_json(const LevelError& error);
Json to_json(const Comparison& comparison);
Json to_json(const ImportReport& report);
Json to_json(const FileInfo::Band& band);

// error_measured of `extract`: a Comparison of the full mesh with a level.
Json measured_json(const Comparison& comparison);

// Where the normals come from, and one line for each ugly thing.
std::string lines_of(const ImportReport& report);

// In this first file a block is a (band, patch): DESIGN 1.
std::size_t block_count(const FileInfo& info);

struct BitsPerVertex {
  double total = 0, connectivity = 0, positions = 0, attributes = 0;
};
BitsPerVertex bits_per_vertex(const FileInfo& info, std::size_t vertex_count);

// The larger of the two one-sided distances.
double hausdorff(const Comparison& comparison);

}  // namespace crease::cli
