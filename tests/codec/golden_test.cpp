// A file of every version of the format, as it was once written: later programs read it, and as
// long as the version is the present one, write it again to the byte.
#include "codec/small_file.h"
#include "crease/progressive_mesh.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace crease {
namespace {

std::filesystem::path golden_path() {
  return std::filesystem::path(__FILE__).parent_path() / "golden" / "version_1.crease";
}

TEST_CASE("the golden file of version 1 is read, and written to the byte") {
  if (std::getenv("CREASE_WRITE_GOLDEN") != nullptr) {
    REQUIRE(write_crease(golden_path(), encode_crease(*small_arrays(), kBands)).ok());
  }
  const Result<CreaseFile> file = read_crease(golden_path(), {});
  REQUIRE_MESSAGE(file.ok(), (file.ok() ? "" : file.failure().message));
  CHECK(file->arrays->full.triangles() == 14);
  CHECK(file->arrays->full.vertices() == 9);
  CHECK(file->arrays->layers.size() == 3);
  CHECK(file->arrays->materials.size() == 2);
  ProgressiveMesh pm(file->arrays);
  CHECK(pm.contraction_count() == 8);
  const Mesh finest = pm.extract();
  CHECK(finest.triangle_count() == 14);
  pm.set_applied(pm.contraction_count());
  CHECK(pm.triangle_count() == 0);

  std::ifstream in(golden_path(), std::ios::binary);
  const std::vector<char> golden{std::istreambuf_iterator<char>(in), {}};
  const std::vector<std::byte> again = encode_crease(*file->arrays, file->info.bands);
  REQUIRE(again.size() == golden.size());
  CHECK(std::equal(again.begin(), again.end(), golden.begin(),
                   [](std::byte a, char b) { return static_cast<char>(a) == b; }));
}

}  // namespace
}  // namespace crease
