#include "view/streamed_model.h"

#include "crease/build.h"

#include <doctest/doctest.h>

#include <algorithm>

namespace crease {

StreamedModel streamed_model(const Mesh& mesh, std::uint32_t patch_triangles) {
  BuildOptions options;
  options.simplify.patch_triangles = patch_triangles;
  options.simplify.threads = 1;
  Result<Built> built = build_model(mesh, options);
  REQUIRE(built.ok());
  StreamedModel model{std::move(built->file_bytes), mesh.positions[0], mesh.positions[0]};
  for (const Vec3d& p : mesh.positions) {
    for (int i = 0; i < 3; ++i) {
      model.low[i] = std::min(model.low[i], p[i]);
      model.high[i] = std::max(model.high[i], p[i]);
    }
  }
  return model;
}

BlockStreamer StreamedModel::stream() const {
  const Result<BlockFile> file = BlockFile::open(memory_source(bytes));
  REQUIRE(file.ok());
  Result<BlockStreamer> streamer =
      BlockStreamer::open(*file, async_memory_source(bytes), {.decode_threads = 0});
  REQUIRE(streamer.ok());
  return *std::move(streamer);
}

void finish(BlockStreamer& streamer, const BlockViewParameters& parameters) {
  for (int frames = 0; !streamer.update(parameters).is_complete; ++frames) {
    REQUIRE(frames < 100'000);
    streamer.wait(std::chrono::milliseconds(20));
  }
}

}  // namespace crease
