// Blocks decode to what was encoded: every band's mesh, corner for corner.
#include "codec/decode_block.h"
#include "codec/encoded_model.h"
#include "crease/import.h"
#include "crease/simplify.h"
#include "pipeline/encode_blocks.h"
#include "pipeline/snap_attributes.h"
#include "support/mesh_zoo.h"
#include "support/random_contractions.h"
#include "support/sanitized.h"
#include "support/shared_data.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>

namespace crease {
namespace {

using codec::BlockCoding;
using codec::FineEnd;
using codec::PatchMesh;

// A triangle without its numbers, turned so that it comes first in the order of its corners.
using Corner = std::vector<std::int32_t>;
using Described = std::vector<Corner>;

void describe(const PatchMesh& mesh, const BlockCoding& coding, std::vector<Described>& all) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Described corners;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3i& p = mesh.positions[mesh.triangles[t][c]];
      Corner corner{p.x, p.y, p.z, std::int32_t(mesh.category[t]), mesh.derived[t]};
      for (std::size_t l = 0; l < coding.layers.size(); ++l) {
        if (coding.layers[l].is_normal && mesh.derived[t]) continue;
        const codec::CodedValue& value = mesh.values[l][3 * t + c];
        corner.insert(corner.end(), value.begin(), value.end());
      }
      corners.push_back(std::move(corner));
    }
    // Corners may be equal, so all three ways to turn it are looked at.
    Described least = corners;
    for (int turn = 0; turn < 2; ++turn) {
      std::rotate(corners.begin(), corners.begin() + 1, corners.end());
      least = std::min(least, corners);
    }
    all.push_back(std::move(least));
  }
}

// Decodes band after band and holds each beside its plans.
void check_blocks(const Mesh& mesh, const ContractionSequence& sequence,
                  std::span<const LayerCoding> codings) {
  const BlockCoding coding = block_coding(mesh, codings);
  const std::vector<BandPlans> plans = plan_blocks(mesh, sequence, codings);
  const std::vector<CodedBlock> blocks = *encode_blocks(plans, coding);
  std::vector<FineEnd> ends;
  std::size_t next = 0, splits = 0;
  for (std::uint32_t band = 0; band < plans.size(); ++band) {
    const std::uint32_t patches = std::uint32_t(plans[band].plans.size());
    std::vector<codec::CoarseEnd> starts = codec::sort_by_label(ends, patches);
    std::vector<FineEnd> next_ends;
    std::vector<Described> decoded, expected;
    for (std::uint32_t p = 0; p < patches; ++p, ++next) {
      REQUIRE(plans.size() - 1 - blocks[next].facts.band == band);
      REQUIRE(blocks[next].facts.patch == p);
      for (BlockId dependency : blocks[next].dependencies) {
        REQUIRE(index_of(dependency) < next);
      }
      Result<codec::DecodedBlock> block =
          codec::decode_block(blocks[next].bytes, std::uint32_t(next), coding,
                              blocks[next].limits(), std::move(starts[p]));
      REQUIRE(block.ok());
      CHECK(block->end.labels.size() == block->end.mesh.triangles.size());
      splits += block->splits.size();
      describe(block->end.mesh, coding, decoded);
      describe(plans[band].plan(p).fine, coding, expected);
      next_ends.push_back(std::move(block->end));
    }
    ends = std::move(next_ends);
    std::sort(decoded.begin(), decoded.end());
    std::sort(expected.begin(), expected.end());
    REQUIRE(decoded == expected);
  }
  CHECK(splits == sequence.contractions.size());
  CHECK(ends.size() == plans.back().plans.size());
}

void check_simplified(Mesh mesh, std::uint32_t patch_triangles, int bits,
                      const AttributePrecision& precision) {
  const Grid grid = make_grid(mesh, {.length = 0, .bits = bits});
  snap(mesh, grid);
  const std::vector<LayerCoding> codings = codings_of(mesh, precision);
  snap_to_codings(mesh, codings);
  auto sequence = simplify(
      mesh, grid,
      {.patch_triangles = patch_triangles, .threads = 1, .record_bands = true, .progress = {}});
  REQUIRE(sequence.ok());
  snap_new_values(*sequence, mesh, codings);
  check_blocks(mesh, *sequence, codings);
}

}  // namespace

TEST_CASE("blocks of simplified meshes decode to every band's mesh") {
  for (const ZooMesh& zoo : mesh_zoo()) {
    INFO(zoo.name);
    for (const std::uint32_t patch_triangles : {200u, 8000u}) {
      check_simplified(zoo.mesh, patch_triangles, 14, kCoarsePrecision);
      check_simplified(zoo.mesh, patch_triangles, 24, kExactPrecision);
    }
  }
}

TEST_CASE("blocks of real models decode to every band's mesh") {
  for (const std::string name :
       {"cad/fandisk.off", "city/delft_36k.obj.zst", "attributes/corset.glb"}) {
    const std::filesystem::path path = shared_model(name);
    if (path.empty() || !std::filesystem::exists(path)) continue;
    if (kSanitized && name != "attributes/corset.glb") continue;
    INFO(name);
    Result<Imported> in = import_mesh(path, {});
    REQUIRE(in.ok());
    check_simplified(std::move(in->mesh), 8000, 14, kCoarsePrecision);
  }
}

TEST_CASE("blocks of random contractions of random complexes decode to what was encoded") {
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    INFO(seed);
    Mesh mesh = random_complex(seed, 4 + seed % 40, 4 + seed * 7 % 120);
    if (has_isolated_vertex(mesh)) continue;
    const Grid grid = make_grid(mesh, {.length = 0, .bits = 14});
    snap(mesh, grid);
    ContractionSequence sequence = random_contractions(mesh, grid, {.seed = seed});
    make_one_band(mesh, sequence);
    check_blocks(mesh, sequence, codings_of(mesh, kExactPrecision));
  }
}

TEST_CASE("harmed blocks decode to an error or to a block within the limits") {
  Mesh mesh = random_complex(5, 30, 80);
  const Grid grid = make_grid(mesh, {.length = 0, .bits = 10});
  snap(mesh, grid);
  ContractionSequence sequence = random_contractions(mesh, grid, {.seed = 5});
  REQUIRE(!has_isolated_vertex(mesh));
  make_one_band(mesh, sequence);
  const std::vector<LayerCoding> codings = codings_of(mesh, kExactPrecision);
  const BlockCoding coding = block_coding(mesh, codings);
  const std::vector<CodedBlock> blocks =
      *encode_blocks(plan_blocks(mesh, sequence, codings), coding);
  REQUIRE(blocks.size() == 2);

  const auto decode = [&](std::size_t block, std::span<const std::byte> bytes,
                          codec::CoarseEnd start) {
    Result<codec::DecodedBlock> decoded = codec::decode_block(
        bytes, std::uint32_t(block), coding, blocks[block].limits(), std::move(start));
    if (!decoded.ok()) return false;
    const PatchMesh& end = decoded->end.mesh;
    CHECK(end.positions.size() <= blocks[block].limits().vertices);
    CHECK(end.triangles.size() <= blocks[block].limits().triangles);
    std::size_t outside = 0;
    for (const codec::Corners& corners : end.triangles) {
      outside += std::size_t(
          std::ranges::count_if(corners, [&](auto v) { return v >= end.positions.size(); }));
    }
    CHECK(outside == 0);
    return true;
  };
  for (std::size_t block = 0; block < 2; ++block) {
    codec::CoarseEnd start;
    if (block == 1) {
      Result<codec::DecodedBlock> base =
          codec::decode_block(blocks[0].bytes, 0, coding, blocks[0].limits(), {});
      REQUIRE(base.ok());
      start = codec::sort_by_label(std::span(&base->end, 1), 1)[0];
    }
    const std::vector<std::byte>& good = blocks[block].bytes;
    CHECK(decode(block, good, start));
    // Limits below what there is are kept as well, down to less than the coarse end has.
    for (std::uint32_t less = 1; less <= blocks[block].limits().vertices; ++less) {
      const codec::BlockLimits limits{blocks[block].limits().vertices - less,
                                      blocks[block].limits().triangles};
      CHECK(!codec::decode_block(good, std::uint32_t(block), coding, limits, start).ok());
    }
    for (std::uint32_t less = 1; less <= blocks[block].limits().triangles; ++less) {
      const codec::BlockLimits limits{blocks[block].limits().vertices,
                                      blocks[block].limits().triangles - less};
      CHECK(!codec::decode_block(good, std::uint32_t(block), coding, limits, start).ok());
    }
    std::size_t refused = 0;
    for (std::size_t length = 0; length < good.size(); length += kHarmStep) {
      refused += !decode(block, std::span(good).first(length), start);
    }
    if (good.size() > 100) CHECK(refused > good.size() / kHarmStep / 2);
    for (std::size_t bit = 0; bit < 8 * good.size(); bit += kHarmStep) {
      std::vector<std::byte> bad = good;
      bad[bit / 8] ^= std::byte(1u << bit % 8);
      decode(block, bad, start);
    }
  }
}

TEST_CASE("what a block starts from counts against its limits") {
  // A block without splits: nothing but what it starts from is there.
  codec::CoarseEnd start;
  codec::BlockPlan plan;
  plan.fine.positions = {{0, 0, 0}, {5, 0, 0}, {0, 5, 0}, {5, 5, 0}};
  plan.fine.triangles = {{0, 1, 2}, {1, 3, 2}};
  plan.fine.category = {0, 0};
  plan.fine.derived = {0, 0};
  plan.labels = {0, 0};
  start.mesh = plan.fine;
  start.names = {{0, 0}, {0, 1}, {0, 2}, {0, 3}};
  const std::vector<std::uint32_t> triangles{0, 1}, vertices{0, 1, 2, 3};
  const codec::EncodedBlock block = codec::encode_block(plan, 1, {}, start, triangles, vertices);
  const auto decodes = [&](const codec::BlockLimits& limits) {
    return codec::decode_block(block.bytes, 1, {}, limits, start).ok();
  };
  CHECK(decodes({4, 2}));
  CHECK(!decodes({3, 2}));
  CHECK(!decodes({4, 1}));
}

}  // namespace crease
