#include "base/bytes.h"
#include "codec/checksum.h"
#include "codec/decode_file.h"
#include "codec/small_file.h"
#include "crease/progressive_mesh.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <cstring>
#include <random>

namespace crease {
namespace {

using Bytes = std::vector<std::byte>;

// As a renderer would: every level there and back, some of them extracted.
void walk(const ProgressiveArraysPtr& arrays) {
  ProgressiveMesh pm(arrays);
  pm.set_applied(pm.contraction_count());
  pm.set_triangle_count(pm.full_triangle_count() / 2);
  CHECK(check_mesh(pm.extract()).ok());
  pm.set_error(0.5f);
  pm.set_applied(0);
  CHECK(check_mesh(pm.extract()).ok());
}

TEST_CASE("a file cut anywhere is refused") {
  const Bytes whole = encode_crease(*small_arrays(), kBands);
  for (std::size_t cut = 0; cut < whole.size(); ++cut) {
    const Bytes part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(cut));
    const Result<CreaseFile> got = decode_crease(part, {});
    REQUIRE(!got.ok());
    CHECK(!got.failure().message.empty());
    CHECK(!validate_crease(part).empty());
    if (cut >= 10) CHECK(got.failure().error != Error::NotCrease);
  }
}

TEST_CASE("every flipped bit is noticed") {
  const Bytes whole = encode_crease(*small_arrays(), kBands);
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    Bytes flipped = whole;
    flipped[bit / 8] ^= std::byte(1 << (bit % 8));
    CAPTURE(bit);
    REQUIRE(!decode_crease(flipped, {}).ok());
  }
}

TEST_CASE("bytes behind the end are refused") {
  Bytes longer = encode_crease(*small_arrays(), kBands);
  longer.push_back({});
  REQUIRE(!decode_crease(longer, {}).ok());
}

TEST_CASE("flipped bits under right checksums give a failure or a mesh that can be walked") {
  std::size_t accepted = 0, refused = 0;
  for (Placement placement : {Placement::Endpoint, Placement::Optimal}) {
    const Bytes whole = encode_crease(*small_arrays(7, placement), kBands);
    // Under a sanitizer every third bit, so that each byte has two or three of its bits flipped.
    for (std::size_t bit = 0; bit < 8 * whole.size(); bit += kSanitized ? 3 : 1) {
      Bytes flipped = whole;
      flipped[bit / 8] ^= std::byte(1 << (bit % 8));
      const Result<CreaseFile> got = decode_file(flipped, {}, Checksums::Ignore);
      got.ok() ? ++accepted : ++refused;
      if (got.ok()) walk(got->arrays);
    }
  }
  CHECK(accepted > 100);  // low bits of positions and the like
  CHECK(refused > 100);
}

TEST_CASE(
    "several random words under right checksums give a failure or a mesh that can be walked") {
  std::mt19937_64 random(1);
  const Bytes whole = encode_crease(*small_arrays(5), kBands);
  for (int trial = 0; trial < 20'000; ++trial) {
    Bytes harmed = whole;
    for (std::uint64_t i = 0; i < 1 + random() % 3; ++i) {
      const std::size_t at = 32 + random() % (whole.size() - 36);
      const auto word = static_cast<std::uint32_t>(random() % 3 == 0 ? random() : random() % 20);
      std::memcpy(&harmed[at], &word, 4);
    }
    const Result<CreaseFile> got = decode_file(harmed, {}, Checksums::Ignore);
    if (got.ok()) walk(got->arrays);
  }
}

TEST_CASE("a failure names the section and its place") {
  Bytes harmed = encode_crease(*small_arrays(), kBands);
  const Result<CreaseFile> file = decode_crease(harmed, {});
  REQUIRE(file.ok());
  for (const FileInfo::Section& section : file->info.sections) {
    Bytes other = harmed;
    other[static_cast<std::size_t>(section.offset)] ^= std::byte(1);
    const Result<CreaseFile> got = decode_crease(other, {});
    REQUIRE(!got.ok());
    CHECK(got.failure().error == Error::BadChecksum);
    CHECK(got.failure().message.find("'" + section.name + "' at byte " +
                                     std::to_string(section.offset)) != std::string::npos);
  }
}

TEST_CASE("other files, newer versions and too large ones are told apart") {
  const Bytes whole = encode_crease(*small_arrays(), kBands);
  const auto error_of = [](const Bytes& bytes, DecodeLimits limits = {}) {
    const Result<CreaseFile> got = decode_crease(bytes, limits);
    return got.ok() ? Error{} : got.failure().error;
  };
  CHECK(error_of({}) == Error::NotCrease);
  Bytes other = whole;
  other[1] = std::byte('c');
  CHECK(error_of(other) == Error::NotCrease);
  Bytes newer = whole;
  newer[8] = std::byte(3);
  CHECK(error_of(newer) == Error::VersionTooNew);
  newer[8] = std::byte(2);
  CHECK(error_of(newer) == Error::NotSupported);
  CHECK(error_of(whole, {.max_bytes = whole.size() - 1}) == Error::OverLimit);
  CHECK(error_of(whole, {.max_bytes = whole.size()}) == Error{});
}

TEST_CASE("a validation lists every wrong section") {
  Bytes harmed = encode_crease(*small_arrays(), kBands);
  const Result<CreaseFile> file = decode_crease(harmed, {});
  REQUIRE(file.ok());
  const auto& sections = file->info.sections;
  harmed[static_cast<std::size_t>(sections[4].offset)] ^= std::byte(1);
  harmed[static_cast<std::size_t>(sections.back().offset + sections.back().bytes - 4)] ^=
      std::byte(1);
  CHECK(validate_crease(harmed).size() >= 2);
}

}  // namespace
}  // namespace crease
