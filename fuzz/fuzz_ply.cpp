#include "fuzz_import.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  crease::import_and_export({data, size}, "fuzz.ply", ".ply");
  return 0;
}
