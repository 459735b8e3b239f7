#include "opened.h"

#include "crease/build.h"
#include "crease/file.h"

#include <utility>

namespace crease::bench {

Result<Opened> open_built(Mesh mesh) {
  Result<Built> built = build_model(std::move(mesh), {});
  if (!built.ok()) return built.failure();
  const std::size_t bytes = built->file_bytes.size();
  const Result<BlockFile> file = BlockFile::open(memory_source(std::move(built->file_bytes)));
  if (!file.ok()) return file.failure();
  Result<DecodedModel> model = decode_model(*file);
  if (!model.ok()) return model.failure();
  return Opened{*std::move(model), bytes};
}

}  // namespace crease::bench
