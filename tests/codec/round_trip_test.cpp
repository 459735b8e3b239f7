#include "codec/small_file.h"
#include "crease/progressive_mesh.h"
#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <cstring>

namespace crease {
namespace {

template <typename T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

bool same(const ProgressiveLayer& a, const ProgressiveLayer& b) {
  return a.name == b.name && a.role == b.role && a.interpolation == b.interpolation &&
         a.dimension == b.dimension && a.storage == b.storage && same_bits(a.values, b.values) &&
         a.row_of_triangle == b.row_of_triangle && a.indices == b.indices;
}

bool same(const PackedContractions& a, const PackedContractions& b) {
  return a.kept == b.kept && a.headers == b.headers && a.deltas == b.deltas &&
         same_bits(a.wide, b.wide) && a.corners == b.corners && a.own == b.own &&
         a.block_ends == b.block_ends && a.blocks == b.blocks && same_bits(a.errors, b.errors);
}

bool same(const ProgressiveArrays& a, const ProgressiveArrays& b) {
  if (a.layers.size() != b.layers.size()) return false;
  for (std::size_t l = 0; l < a.layers.size(); ++l) {
    if (!same(a.layers[l], b.layers[l])) return false;
  }
  return a.grid == b.grid && a.placement == b.placement && a.full == b.full &&
         a.positions == b.positions && a.indices == b.indices && a.normal_name == b.normal_name &&
         same_bits(a.normals, b.normals) && a.fn_normals == b.fn_normals &&
         a.nsn_normals == b.nsn_normals && a.material_of_triangle == b.material_of_triangle &&
         a.part_of_triangle == b.part_of_triangle && a.materials == b.materials &&
         a.parts == b.parts && same(a.contractions, b.contractions);
}

void check_round_trip(const ProgressiveArrays& arrays) {
  const std::vector<std::byte> bytes = encode_crease(arrays, kBands);
  const Result<CreaseFile> file = decode_crease(bytes, {});
  REQUIRE_MESSAGE(file.ok(), (file.ok() ? "" : file.failure().message));
  CHECK(same(*file->arrays, arrays));
  CHECK(validate_crease(bytes).empty());
  CHECK(encode_crease(*file->arrays, kBands) == bytes);

  CHECK(file->info.version == 1);
  CHECK(file->info.bytes == bytes.size());
  REQUIRE(file->info.bands.size() == kBands.size());
  for (std::size_t i = 0; i < kBands.size(); ++i) {
    CHECK(file->info.bands[i].patches == kBands[i].patches);
    CHECK(file->info.bands[i].contractions == kBands[i].contractions);
    CHECK(file->info.bands[i].triangles_after == kBands[i].triangles_after);
    CHECK(file->info.bands[i].surface_error == kBands[i].surface_error);
  }
  std::uint64_t end = 32 + 32 * file->info.sections.size();
  for (const FileInfo::Section& section : file->info.sections) {
    CHECK(section.offset == end);
    end += section.bytes;
  }
  CHECK(end == bytes.size());
}

TEST_CASE("what is encoded is decoded, to the bit") {
  for (const ZooMesh& z : mesh_zoo()) {
    CAPTURE(z.name);
    Mesh mesh = z.mesh;
    const Grid grid = make_grid(mesh, {});
    snap(mesh, grid);
    for (Placement placement : {Placement::Endpoint, Placement::Optimal}) {
      check_round_trip(*build_progressive_arrays(
          mesh, random_contractions(mesh, grid, {.seed = 2, .placement = placement})));
    }
  }
  for (std::uint64_t seed = 0; seed < 20; ++seed) check_round_trip(*small_arrays(seed));
}

TEST_CASE("section names say what info counts") {
  const Result<CreaseFile> file = decode_crease(encode_crease(*small_arrays(), kBands), {});
  REQUIRE(file.ok());
  std::vector<std::string> names;
  for (const FileInfo::Section& section : file->info.sections) names.push_back(section.name);
  const auto has = [&names](const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const char* name : {"schema", "materials", "parts", "bands", "positions", "triangle indices",
                           "normals", "layer 0", "layer 1 values", "deltas", "contraction kept",
                           "contraction corners", "attribute changes", "errors"}) {
    CAPTURE(name);
    CHECK(has(name));
  }
}

}  // namespace
}  // namespace crease
