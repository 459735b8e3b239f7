#include "crease/build.h"

#include "pipeline/snap_attributes.h"

#include <utility>

namespace crease {

namespace {

bool goes_on(const BuildOptions& options, const char* stage, double done) {
  return !options.simplify.progress || options.simplify.progress(stage, done);
}

std::vector<FileInfo::Band> bands_of(const SimplifyStatistics& statistics) {
  std::vector<FileInfo::Band> bands;
  for (const BandStatistics& band : statistics.bands) {
    bands.push_back({band.patches, band.contractions, band.triangles_after, band.surface_error});
  }
  return bands;
}

}  // namespace

Result<Built> build_model(Mesh mesh, const BuildOptions& options) {
  const Failure interrupted = fail(Error::Interrupted, "interrupted");
  const Grid grid = make_grid(mesh, options.precision);
  snap(mesh, grid);
  Built built;
  const std::vector<LayerCoding> codings = codings_of(mesh, options.attributes);
  built.snapped = snap_to_codings(mesh, codings);
  Result<ContractionSequence> sequence = simplify(mesh, grid, options.simplify, &built.statistics);
  if (!sequence.ok()) return sequence.failure();
  snap_new_values(*sequence, mesh, codings);
  if (!goes_on(options, "arrange", 0)) return interrupted;
  built.arrays = build_progressive_arrays(mesh, *sequence);
  mesh = {};
  sequence = ContractionSequence{};
  if (!goes_on(options, "encode", 0)) return interrupted;
  built.file_bytes = encode_crease(*built.arrays, bands_of(built.statistics));
  if (!goes_on(options, "encode", 1)) return interrupted;
  return built;
}

}  // namespace crease
