#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include "crease/file.h"
#include "cut_check.h"
#include "runtime/block_vertices_oracle.h"
#include "runtime/shown_surface.h"

#include <malloc.h>

namespace crease::bench {

namespace {

std::size_t failed_checks = 0;

void count_failure(const doctest::AssertData& data) {
  if (data.m_failed) ++failed_checks;
}

}  // namespace

Result<CutCheck> CutCheck::open(const std::filesystem::path& path) {
  const Result<BlockFile> file = open_crease(path);
  if (!file.ok()) return file.failure();
  Result<std::vector<std::uint64_t>> checksums = drawn_checksums(*file);
  if (!checksums.ok()) return checksums.failure();
  CutCheck check;
  check.checksums_ = *std::move(checksums);
  malloc_trim(0);
  return check;
}

CutCheck::Found CutCheck::look(const BlockMesh& mesh) const {
  // What the oracle checks is counted where there is no test that could fail.
  doctest::Context context;
  context.setAsDefaultForAssertsOutOfTestCases();
  context.setAssertHandler(count_failure);
  failed_checks = 0;
  Found found;
  found.triangles = mesh.triangle_count();
  found.open_edges = crease::open_edges(mesh);
  found.wrong_blocks = crease::wrong_blocks(mesh, checksums_);
  check_by_vertex(mesh);
  found.differences = failed_checks;
  malloc_trim(0);
  return found;
}

}  // namespace crease::bench
