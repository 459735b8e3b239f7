// Any bytes are a Failure or a mesh that holds its promises.
#include "crease/import.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace crease;
  const Result<Imported> in =
      import_bytes(std::as_bytes(std::span(data, size)), "fuzz.city.json", {});
  if (in.ok() ? !check_mesh(in->mesh).ok() : in.failure().message.empty()) std::abort();
  return 0;
}
