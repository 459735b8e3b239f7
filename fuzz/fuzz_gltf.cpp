// Any bytes are a Failure or a mesh that holds its promises and can be written as GLB. Bytes with a
// zero in them also go in as the JSON and the binary chunk of a GLB whose lengths are right, or a
// change of length would stop nearly every mutation at the header.
#include "crease/export.h"
#include "crease/import.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <vector>

namespace {

using namespace crease;

void import_and_export(std::span<const std::byte> bytes) {
  const Result<Imported> in = import_bytes(bytes, "fuzz.glb", {});
  if (!in.ok()) {
    if (in.failure().message.empty()) std::abort();
    return;
  }
  if (!check_mesh(in->mesh).ok()) std::abort();
  const auto written = export_bytes(in->mesh, ".glb");
  if (!written.ok()) std::abort();
  // Positions that floats cannot tell apart may leave nothing; what is left is a mesh.
  const Result<Imported> back = import_bytes(*written, "written.glb", {});
  if (back.ok() ? !check_mesh(back->mesh).ok() : back.failure().error != Error::NoTriangles) {
    std::abort();
  }
}

std::string u32(std::size_t value) {
  std::string bytes;
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 0xff);
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  import_and_export(std::as_bytes(std::span(data, size)));
  const std::uint8_t* zero = std::find(data, data + size, std::uint8_t(0));
  if (zero == data + size) return 0;
  const std::string json(data, zero), binary(zero + 1, data + size);
  const std::string glb = "glTF" + u32(2) + u32(28 + json.size() + binary.size()) +
                          u32(json.size()) + "JSON" + json + u32(binary.size()) +
                          std::string("BIN\0", 4) + binary;
  import_and_export(std::as_bytes(std::span(glb)));
  return 0;
}
