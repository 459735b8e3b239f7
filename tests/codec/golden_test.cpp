// A model as it was once written: later programs read it, and as long as the codec is the present
// one, write it again to the byte, with every compiler.
#include "codec/encoded_model.h"
#include "support/described_mesh.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace crease {
namespace {

TEST_CASE("the golden model is read, and written to the byte") {
  const std::filesystem::path path =
      std::filesystem::path(__FILE__).parent_path() / "golden" / "model_2.crease";
  const EncodedCase c = small_case(5);
  if (std::getenv("CREASE_WRITE_GOLDEN") != nullptr) REQUIRE(write_crease(path, c.bytes).ok());
  const Result<BlockFile> file = open_crease(path);
  REQUIRE_MESSAGE(file.ok(), (file.ok() ? "" : file.failure().message));
  CHECK(validate_crease(*file).empty());
  const Result<DecodedModel> model = decode_model(*file);
  REQUIRE(model.ok());
  CHECK((described(model->mesh) == described(c.mesh)));

  std::ifstream in(path, std::ios::binary);
  const std::vector<char> golden{std::istreambuf_iterator<char>(in), {}};
  REQUIRE(c.bytes.size() == golden.size());
  CHECK(std::equal(c.bytes.begin(), c.bytes.end(), golden.begin(),
                   [](std::byte a, char b) { return static_cast<char>(a) == b; }));
}

}  // namespace
}  // namespace crease
