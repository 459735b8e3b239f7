// Any bytes are a Failure or a file that says the same when it is written again. They go through
// the door as they are, and once more with right checksums, or nothing would come past them.
#include "codec/container_files.h"
#include "codec/repair_checksums.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

namespace {

using namespace crease;

void open_and_read(const std::vector<std::byte>& bytes) {
  const Result<BlockFile> file = BlockFile::open(memory_source(bytes));
  if (!file.ok()) {
    if (file.failure().message.empty()) std::abort();
    return;
  }
  const Result<std::uint32_t> complete = file->complete_blocks();
  if (complete.ok() && *complete > file->block_count()) std::abort();
  const std::vector<std::string> wrong = file->validate();
  if (!wrong.empty()) {
    if (wrong.front().empty()) std::abort();
    return;
  }
  if (*complete != file->block_count() || !is_written_again(*file)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto given = std::as_bytes(std::span(data, size));
  std::vector<std::byte> bytes(given.begin(), given.end());
  open_and_read(bytes);
  repair_checksums(bytes);
  open_and_read(bytes);
  return 0;
}
