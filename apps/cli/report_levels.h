// The levels that a report shows: what they are made of, how far they are off, what they look like.
#pragma once

#include "cli/level.h"
#include "cli/model.h"
#include "crease/camera.h"
#include "crease/decode_model.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace crease::cli {

struct ReportLevel {
  std::string name;  // "original", "20 %"
  std::size_t triangles = 0, vertices = 0;
  std::size_t sn_triangles = 0, fn_triangles = 0, nsn_triangles = 0;
  StoppedBy stopped_by = StoppedBy::Triangles;
  std::uint64_t bytes_needed = 0;      // of the file, from its start
  LevelError recorded;                 // what the file says
  std::optional<Comparison> measured;  // none: of the original, and where nothing is measured
  std::vector<std::byte> png;          // empty where nothing can draw
};

struct ReportLevelOptions {
  std::vector<double> ratios;  // of the triangles, below 1; the original comes first in any case
  std::size_t samples = 50'000;
  int width_px = 640, height_px = 480;
  Vec3d up{0, 0, 1};
  std::optional<Camera> view{};  // else all of the model
};

struct ReportLevels {
  std::vector<ReportLevel> levels;           // finest first; none twice
  std::vector<std::uint64_t> bytes_of_band;  // that its coarse end needs, finest band first
  double diagonal = 0;                       // of the model's box, model units
  std::string no_pictures;                   // why there are none
};

// Measures and draws one level after the other. Memory: one level at a time beside the model.
Result<ReportLevels> make_report_levels(const ModelFile& file, const Mesh& full,
                                        const ProgressiveArraysPtr& arrays,
                                        const ReportLevelOptions& options, const Common& common);

}  // namespace crease::cli
