// Any bytes are a Failure or arrays that can be walked over all levels. Checksums are not looked
// at, or nothing would come past them; the same bytes go through the door with checksums as well.
#include "codec/decode_file.h"
#include "crease/file.h"
#include "crease/progressive_mesh.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace crease;
  const auto bytes = std::as_bytes(std::span(data, size));
  (void)decode_crease(bytes, {});
  const Result<CreaseFile> file = decode_file(bytes, {}, Checksums::Ignore);
  if (!file.ok()) return 0;

  ProgressiveMesh pm(file->arrays);
  const std::size_t count = pm.contraction_count();
  const std::size_t step = std::max<std::size_t>(1, count / 16);
  for (std::size_t n = 0; n <= count; n += step) {
    pm.set_applied(n);
    if (!check_mesh(pm.extract()).ok()) std::abort();
  }
  for (std::size_t n = count + 1; n-- > 0;) pm.set_applied(n);
  pm.set_error(1);
  pm.set_triangle_count(pm.full_triangle_count() / 2);
  if (!check_mesh(pm.extract()).ok()) std::abort();
  return 0;
}
