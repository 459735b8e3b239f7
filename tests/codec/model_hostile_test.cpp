// Bytes that are not what a build wrote: an error that says where, or a model that holds every
// invariant.
#include "codec/encode_lattices.h"
#include "codec/encoded_model.h"
#include "codec/lattices.h"
#include "codec/repair_checksums.h"
#include "crease/build_hierarchy.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <random>

namespace crease {
namespace {

using Bytes = std::vector<std::byte>;

// Whether it is a model; what is one must be whole.
bool is_model(const Bytes& bytes) {
  const Result<BlockFile> file = BlockFile::open(memory_source(bytes));
  if (!file.ok()) {
    CHECK(!file.failure().message.empty());
    return false;
  }
  const Result<DecodedModel> model = decode_model(*file, {.max_bytes = 1 << 24});
  if (!model.ok()) {
    CHECK(!model.failure().message.empty());
    return false;
  }
  CHECK(check_mesh(model->mesh).ok());
  const Status valid = check_contractions(model->mesh, model->sequence);
  CHECK_MESSAGE(valid.ok(), (valid.ok() ? "" : valid.failure().message));
  return true;
}

TEST_CASE("a file cut anywhere is refused, and coarser blocks that are there are read") {
  const EncodedCase c = small_case();
  // Behind the finest block there are only names, without which there is a model without parts.
  const std::uint64_t blocks_end = opened(c.bytes).head().parts.range.offset;
  REQUIRE(blocks_end < c.bytes.size());
  for (std::size_t cut = 0; cut < c.bytes.size(); ++cut) {
    const Bytes part(c.bytes.begin(), c.bytes.begin() + static_cast<std::ptrdiff_t>(cut));
    CHECK(is_model(part) == (cut >= blocks_end));
  }
  const Bytes most(c.bytes.begin(), c.bytes.begin() + std::ptrdiff_t(blocks_end) - 1);
  const Result<DecodedModel> coarse = decode_model(opened(most), {.finest_band = 1});
  REQUIRE(coarse.ok());
  CHECK(coarse->mesh.parts.empty());
  CHECK(coarse->mesh.part_of_triangle.empty());
}

TEST_CASE("every flipped bit is found by validate") {
  const EncodedCase c = small_case();
  for (std::size_t bit = 0; bit < 8 * c.bytes.size(); bit += kHarmStep) {
    Bytes flipped = c.bytes;
    flipped[bit / 8] ^= std::byte(1 << (bit % 8));
    CAPTURE(bit);
    const Result<BlockFile> file = BlockFile::open(memory_source(flipped));
    REQUIRE((!file.ok() || !validate_crease(*file).empty()));
  }
}

TEST_CASE("flipped bits under right checksums give a failure or a model that is whole") {
  std::size_t accepted = 0, refused = 0;
  for (const std::uint64_t seed : {5u, 30u}) {
    const EncodedCase c = small_case(seed);
    for (std::size_t bit = 0; bit < 8 * c.bytes.size(); bit += kHarmStep) {
      Bytes flipped = c.bytes;
      flipped[bit / 8] ^= std::byte(1 << (bit % 8));
      repair_checksums(flipped);
      CAPTURE(bit);
      is_model(flipped) ? ++accepted : ++refused;
    }
  }
  CHECK(accepted > 100);
  CHECK(refused > 100);
}

TEST_CASE("several random bytes under right checksums give a failure or a model that is whole") {
  std::mt19937_64 random(1);
  const EncodedCase c = small_case(8);
  for (int trial = 0; trial < (kSanitized ? 2'000 : 10'000); ++trial) {
    Bytes harmed = c.bytes;
    for (std::uint64_t i = 0; i < 1 + random() % 4; ++i) {
      harmed[32 + random() % (harmed.size() - 32)] = std::byte(random());
    }
    repair_checksums(harmed);
    is_model(harmed);
  }
}

TEST_CASE("a failure names the block") {
  const EncodedCase c = small_case();
  const BlockFile file = opened(c.bytes);
  const Result<DirectoryPage> page = file.read_page(0);
  REQUIRE(page.ok());
  for (const BlockEntry& entry : page->blocks) {
    Bytes harmed = c.bytes;
    harmed[static_cast<std::size_t>(entry.offset)] ^= std::byte(1);
    const Result<DecodedModel> model = decode_model(opened(harmed));
    REQUIRE(!model.ok());
    CHECK(model.failure().error == Error::BadChecksum);
    CHECK(model.failure().message.find("block " + std::to_string(index_of(entry.id))) !=
          std::string::npos);
  }
}

TEST_CASE("a lattice whose ends or entries are not those of its grain is refused") {
  const std::vector<LayerSchema> layers{
      {"uv", AttributeRole::TexCoord, Interpolation::Linear, 1, AttributeCoding::Lattice, 12}};
  const auto is_read = [&](NumberLattice lattice) {
    const std::vector<LayerCoding> codings{{LayerCoding::Kind::Lattice, 12, {std::move(lattice)}}};
    const Result<std::vector<LayerCoding>> read = decode_codings(layers, encode_lattices(codings));
    if (read.ok()) CHECK(*read == codings);
    return read.ok();
  };
  CHECK(is_read({.divisor = 64, .low = -8, .high = 64, .palette = {}, .grain = 8}));
  CHECK(!is_read({.divisor = 64, .low = -7, .high = 64, .palette = {}, .grain = 8}));
  CHECK(!is_read({.divisor = 64, .low = -8, .high = 63, .palette = {}, .grain = 8}));
  CHECK(is_read({.divisor = 1, .low = 0, .high = 16, .palette = {1, 2, 4}, .grain = 8}));
  CHECK(!is_read({.divisor = 1, .low = 0, .high = 16, .palette = {1, 2}, .grain = 8}));
  CHECK(!is_read({.divisor = 1, .low = 0, .high = 16, .palette = {1, 2, 4, 5}, .grain = 8}));
  CHECK(!is_read({.divisor = 1, .low = 0, .high = 16, .palette = {1, 4, 2}, .grain = 8}));
  CHECK(is_read({.divisor = 1, .low = 0, .high = 1 << 20, .palette = {}, .grain = 1 << 16}));
}

TEST_CASE("no more memory than allowed") {
  const EncodedCase c = small_case();
  const Result<DecodedModel> model = decode_model(opened(c.bytes), {.max_bytes = 1000});
  REQUIRE(!model.ok());
  CHECK(model.failure().error == Error::OverLimit);
}

}  // namespace
}  // namespace crease
