// Rows of integers come back as they were, whatever their range.
#include "codec/packed_records.h"

#include <doctest/doctest.h>

#include <bit>
#include <random>
#include <vector>

namespace crease::codec {
namespace {

TEST_CASE("packed rows are read as they were written, and take few bits where they are near") {
  std::mt19937 random(3);
  for (const std::uint32_t spread : {1u, 7u, 1000u, 0xffffffffu}) {
    std::vector<PackedRecords<3>::Record> rows(257);
    for (auto& row : rows) {
      for (std::uint32_t& column : row) {
        const std::uint32_t from = spread == 0xffffffffu ? 0 : std::uint32_t(-3);
        column = from + std::uint32_t(random() % spread);  // on both sides of zero
      }
    }
    const auto row_of = [&](std::size_t i) { return rows[i]; };
    const PackedRecords<3> packed(rows.size(), row_of, true);
    const RepeatedRecords<3> repeated(rows.size(), row_of, true);
    REQUIRE(packed.size() == rows.size());
    REQUIRE(repeated.size() == rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      CHECK(packed[i] == rows[i]);
      CHECK(repeated[i] == rows[i]);
    }
    const auto bits = static_cast<std::size_t>(std::bit_width(spread - 1));
    CHECK(packed.bytes() <= rows.size() * 3 * bits / 8 + 24);
  }
  CHECK(PackedRecords<1>(0, [](std::size_t) { return PackedRecords<1>::Record{}; }).size() == 0);
}

TEST_CASE("a row that comes often is kept once") {
  const auto row_of = [](std::size_t i) {
    return RepeatedRecords<4>::Record{std::uint32_t(i % 4) * 0x40000000u, 1, 2, 3};
  };
  const RepeatedRecords<4> repeated(4000, row_of);
  for (std::size_t i = 0; i < 4000; ++i) CHECK(repeated[i] == row_of(i));
  CHECK(repeated.bytes() < 4000 * 2 / 8 + 100);
}

}  // namespace
}  // namespace crease::codec
