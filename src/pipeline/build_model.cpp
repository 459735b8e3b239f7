#include "codec/model_schema.h"
#include "crease/block_file.h"
#include "crease/build.h"
#include "crease/byte_source.h"
#include "parallel/parallel.h"
#include "pipeline/encode_model.h"
#include "pipeline/join_equal_values.h"
#include "pipeline/snap_attributes.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace crease {

namespace {

// What was written is what a reader takes, so that no build ends well with a file that nothing
// opens. Blocks are not decoded: that takes far longer, and crease validate does it.
Status check_readable(std::span<const std::byte> bytes) {
  const Result<BlockFile> file = BlockFile::open(memory_source(bytes, "the file that was built"));
  if (!file.ok()) return file.failure();
  const std::vector<std::string> wrong = file->validate();
  if (!wrong.empty()) return fail(Error::Invalid, wrong.front());
  const Result<codec::ModelSchema> schema = codec::read_schema(*file);
  if (!schema.ok()) return fail(Error::Invalid, schema.failure().message);
  return Done{};
}

bool goes_on(const BuildOptions& options, const char* stage, double done) {
  return !options.simplify.progress || options.simplify.progress(stage, done);
}

}  // namespace

Result<Built> build_model(Mesh mesh, const BuildOptions& options) {
  const Failure interrupted = fail(Error::Interrupted, "interrupted");
  if (mesh.normals() == nullptr) {
    return fail(Error::Invalid, "the mesh has no normal layer, which simplification needs");
  }
  if (const Status sound = check_mesh(mesh); !sound.ok()) return sound.failure();
  if (std::uint64_t(mesh.parts.size()) * std::max<std::size_t>(1, mesh.materials.size()) >> 32 !=
      0) {
    return fail(Error::NotSupported, std::to_string(mesh.parts.size()) + " parts of " +
                                         std::to_string(mesh.materials.size()) +
                                         " materials: more pairs than 32 bits can tell apart");
  }
  const Status precise = check_precision(mesh, options.precision);
  if (!precise.ok()) return precise.failure();
  const Status in_range = check_attribute_precision(options.attributes);
  if (!in_range.ok()) return in_range.failure();
  const Grid grid = make_grid(mesh, options.precision);
  Built built;
  built.grid_step = grid.step;
  built.position_error_max = snap(mesh, grid);
  const std::vector<LayerCoding> codings = codings_of(mesh, options.attributes);
  built.snapped = snap_to_codings(mesh, codings);
  SimplifyOptions simplify_options = options.simplify;
  simplify_options.record_bands = true;
  Result<ContractionSequence> sequence = simplify(mesh, grid, simplify_options, &built.statistics);
  if (!sequence.ok()) return sequence.failure();
  snap_new_values(*sequence, mesh, codings);
  join_equal_values(*sequence, mesh, codings);
  if (!goes_on(options, "encode", 0)) return interrupted;
  MemorySink sink;
  const Result<EncodedModel> encoded = run_on(options.simplify.threads, [&] {
    return encode_model(mesh, *sequence, codings, sink, options.simplify.progress);
  });
  if (!encoded.ok()) return encoded.failure();
  built.blocks = encoded->blocks;
  built.file_bytes = sink.take();
  if (const Status readable = check_readable(built.file_bytes); !readable.ok()) {
    return readable.failure();
  }
  if (!goes_on(options, "encode", 1)) return interrupted;
  return built;
}

}  // namespace crease
