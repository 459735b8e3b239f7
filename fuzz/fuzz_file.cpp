// Any bytes are a Failure or a model that holds every invariant. Checksums are made right, or
// nothing would come past them.
#include "codec/repair_checksums.h"
#include "crease/file.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace crease;
  const auto given = std::as_bytes(std::span(data, size));
  std::vector<std::byte> bytes(given.begin(), given.end());
  repair_checksums(bytes);
  const Result<BlockFile> file = BlockFile::open(memory_source(bytes));
  if (!file.ok()) return 0;
  const Result<DecodedModel> model = decode_model(*file, {.max_bytes = std::uint64_t(1) << 24});
  if (!model.ok()) return 0;
  if (!check_mesh(model->mesh).ok()) std::abort();
  if (!check_contractions(model->mesh, model->sequence).ok()) std::abort();
  return 0;
}
