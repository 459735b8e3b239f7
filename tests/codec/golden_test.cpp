// Models as they were once written: later programs read them, and as long as the codec is the
// present one, write the newest again to the byte, with every compiler.
#include "codec/encoded_model.h"
#include "support/described_mesh.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace crease {
namespace {

std::filesystem::path golden_path(const char* name) {
  return std::filesystem::path(__FILE__).parent_path() / "golden" / name;
}

void check_holds(const std::filesystem::path& path, const Mesh& mesh) {
  const Result<BlockFile> file = open_crease(path);
  REQUIRE_MESSAGE(file.ok(), (file.ok() ? "" : file.failure().message));
  CHECK(validate_crease(*file).empty());
  const Result<DecodedModel> model = decode_model(*file);
  REQUIRE(model.ok());
  CHECK((described(model->mesh) == described(mesh)));
}

TEST_CASE("the golden model is read, and written to the byte") {
  const std::filesystem::path path = golden_path("model_10.crease");
  const EncodedCase c = small_case(5);
  if (std::getenv("CREASE_WRITE_GOLDEN") != nullptr) REQUIRE(write_crease(path, c.bytes).ok());
  check_holds(path, c.mesh);

  std::ifstream in(path, std::ios::binary);
  const std::vector<char> golden{std::istreambuf_iterator<char>(in), {}};
  REQUIRE(c.bytes.size() == golden.size());
  CHECK(std::equal(c.bytes.begin(), c.bytes.end(), golden.begin(),
                   [](std::byte a, char b) { return static_cast<char>(a) == b; }));
}

TEST_CASE("a golden model whose blocks learned at other rates is read") {
  check_holds(golden_path("model_6.crease"), small_case(5).mesh);
}

// Else the fuzzer never gets behind what older blocks are refused by.
TEST_CASE("the seeds of the file's fuzzer are files of now") {
  const std::filesystem::path tests = std::filesystem::path(__FILE__).parent_path().parent_path();
  std::size_t count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(tests.parent_path() / "fuzz" / "seeds" / "fuzz_file")) {
    if (entry.path().extension() != ".crease") continue;  // what once broke something
    CAPTURE(entry.path().filename().string());
    ++count;
    const Result<BlockFile> file = open_crease(entry.path());
    REQUIRE_MESSAGE(file.ok(), (file.ok() ? "" : file.failure().message));
    CHECK(validate_crease(*file).empty());
  }
  CHECK(count == 5);
}

}  // namespace
}  // namespace crease
