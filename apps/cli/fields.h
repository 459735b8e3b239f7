// What the library measured and counted, as --json fields (docs/cli.md) and as lines.
#pragma once

#include "cli/command.h"
#include "crease/compare.h"
#include "crease/contraction.h"
#include "crease/export.h"
#include "crease/import.h"

#include <filesystem>
#include <string>
#include <vector>

namespace crease::cli {

Json to_json(const LevelError& error);
Json to_json(const Comparison& comparison);
Json to_json(const ImportReport& report);

// What a file that was written does not say: fields of its command, and a line each, for the log.
Json to_json(const ExportReport& report);
std::vector<std::string> lines_of(const ExportReport& report, const std::filesystem::path& file);

// "color      mean 0.012, 95 % below 0.03, max 0.4"
std::string line_of(const AttributeDeviation& attribute);

// error_measured of `extract`: a Comparison of the full mesh with a level.
Json measured_json(const Comparison& comparison);

// Where the normals come from, and one line for each ugly thing.
std::string lines_of(const ImportReport& report);

// The larger of the two one-sided distances.
double hausdorff(const Comparison& comparison);

}  // namespace crease::cli
