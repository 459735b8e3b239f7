// No file grows unnoticed: tests/sizes.csv has what the models took when somebody last meant it to
// change. After a change on purpose, `bench/sizes --write` writes it anew, in a commit of its own.
#include "crease/import.h"
#include "pipeline/sized_file.h"
#include "support/normals_alone.h"
#include "support/sanitized.h"
#include "support/shared_data.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>

namespace crease {
namespace {

// Larger ones are for bench/sizes to watch.
constexpr std::size_t kMostTriangles = kSanitized ? 8'000 : 40'000;

const std::vector<SizeRow>& watched() {
  static const std::vector<SizeRow> rows = read_sizes(CREASE_SIZES);
  return rows;
}

void check_size(const SizeRow& row, const Mesh& mesh) {
  CAPTURE(row.model);
  CAPTURE(static_cast<int>(row.placement));
  CAPTURE(row.with_normals);
  CHECK(mesh.triangle_count() == row.triangles);
  const std::size_t bytes =
      encode_sized(simplify_sized(mesh, row.placement, row.with_normals)).size();
  CHECK(bytes > 0);
  CHECK(double(bytes) <= 1.01 * double(row.bytes));
}

TEST_CASE("no file of the tests' own models is more than 1 % larger than it was") {
  for (const std::string& name : own_models()) {
    CAPTURE(name);
    const auto is_of_it = [&](const SizeRow& row) { return row.model == "own:" + name; };
    CHECK(std::count_if(watched().begin(), watched().end(), is_of_it) == 4);
    for (const SizeRow& row : watched()) {
      if (is_of_it(row) && row.triangles <= kMostTriangles) check_size(row, own_model(name));
    }
  }
}

TEST_CASE("no file of a small shared model is more than 1 % larger than it was") {
  int found = 0;
  for (const SizeRow& row : watched()) {
    if (row.source == "-" || row.triangles > kMostTriangles) continue;
    const std::filesystem::path path = shared_model(row.source);
    if (path.empty()) continue;
    ++found;
    CAPTURE(row.model);
    const Result<NormalPolicy> normals = parse_normal_policy(row.import);
    REQUIRE(normals.ok());
    Result<Imported> in = import_mesh(path, {.normals = *normals, .progress = {}});
    REQUIRE(in.ok());
    check_size(row, normals_alone(std::move(in->mesh)));
  }
  MESSAGE(found, " files of shared models");
}

}  // namespace
}  // namespace crease
