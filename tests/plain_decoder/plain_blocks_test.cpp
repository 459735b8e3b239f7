// Blocks that no build makes, or none that is small: the codec's encoder writes them, and both
// decoders find the same.
#include "codec/encode_block.h"
#include "crease/ids.h"
#include "plain_decoder/difference_test.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numeric>
#include <optional>
#include <random>

namespace crease {
namespace {

using codec::DecodedBlock;

struct Shape {
  std::uint32_t vertices = 20, triangles = 60, materials = 1, parts = 1, labels = 1;
  std::int32_t extent = 1000;   // of coordinates
  std::int32_t grain = 1;       // of the lattice's second component
  bool has_directions = false;  // a second layer, of octahedral codes
};

codec::BlockPlan random_plan(std::mt19937_64& random, const Shape& shape) {
  const auto below = [&](std::uint32_t n) { return std::uint32_t(random() % n); };
  codec::BlockPlan plan;
  codec::PatchMesh& mesh = plan.fine;
  for (std::uint32_t v = 0; v < shape.vertices; ++v) {
    Vec3i p;
    for (int k = 0; k < 3; ++k) {
      p[k] = std::int32_t(std::int64_t(below(2 * std::uint32_t(shape.extent))) - shape.extent);
    }
    mesh.positions.push_back(p);
  }
  while (mesh.triangles.size() < shape.triangles) {
    const std::uint32_t a = below(shape.vertices), b = below(shape.vertices),
                        c = below(shape.vertices);
    if (a == b || b == c || c == a) continue;
    mesh.triangles.push_back({a, b, c});
    mesh.category.push_back(below(shape.materials * shape.parts));
    mesh.derived.push_back(random() % 4 == 0);
    plan.labels.push_back(below(shape.labels));
  }
  mesh.values.resize(1);
  for (std::uint32_t i = 0; i < 3 * shape.triangles; ++i) {
    const auto any = std::int32_t(random());
    const std::int32_t of_grain = any - any % shape.grain;
    mesh.values[0].push_back(
        {std::int32_t(random() % 3), random() % 2 == 0 ? any : of_grain, 0, 0});
  }
  return plan;
}

// A layer of lattice codes, of two components, and perhaps one of directions.
codec::BlockCoding coding_of(const Shape& shape) {
  codec::BlockCoding coding{{{.dimension = 2}}, shape.materials, shape.parts};
  coding.layers[0].grains[1] = shape.grain;
  if (shape.has_directions) coding.layers.push_back({.dimension = 3, .octahedral_bits = 10});
  return coding;
}
plain::BlockSchema schema_of(const Shape& shape) {
  using Kind = plain::BlockLayer::Kind;
  plain::BlockSchema schema{{{Kind::Lattice, 8, 2, false}}, shape.materials, shape.parts};
  schema.layers[0].grains[1] = shape.grain;
  if (shape.has_directions) schema.layers.push_back({Kind::Octahedral, 10, 3, false});
  return schema;
}

struct Both {
  std::optional<DecodedBlock> codec;
  std::optional<plain::Block> plain;
};

// Either both refuse the bytes, or both find the same.
Both decoded(std::span<const std::byte> bytes, std::uint32_t number, const Shape& shape,
             const codec::BlockLimits& limits, const codec::CoarseEnd& start,
             const plain::End& other_start) {
  Both both;
  Result<DecodedBlock> block = codec::decode_block(bytes, number, coding_of(shape), limits, start);
  if (block.ok()) both.codec = *std::move(block);
  try {
    both.plain = plain::decode_block(bytes, number, schema_of(shape),
                                     {limits.vertices, limits.triangles}, other_start);
  } catch (const plain::Refused&) {
  }
  REQUIRE(both.codec.has_value() == both.plain.has_value());
  if (both.codec) REQUIRE(difference(*both.codec, coding_of(shape), *both.plain) == "");
  return both;
}

// The plan as a base.
Both check_base(const codec::BlockPlan& plan, const Shape& shape) {
  const codec::EncodedBlock block = codec::encode_block(plan, 0, coding_of(shape), {}, {}, {});
  Both both = decoded(block.bytes, 0, shape, {shape.vertices, shape.triangles}, {}, {});
  REQUIRE(both.codec.has_value());
  CHECK(both.codec->end.labels == plan.labels);
  return both;
}

TEST_CASE("both decoders find more materials than a tree holds, and many parts") {
  std::mt19937_64 random(1);
  for (const std::uint32_t materials : {1u, 2u, 64u, 65u, 1000u}) {
    for (const std::uint32_t parts : {1u, 2u, 300u}) {
      INFO(materials, " ", parts);
      const Shape shape{.materials = materials, .parts = parts};
      check_base(random_plan(random, shape), shape);
    }
  }
}

TEST_CASE("both decoders find more labels than boxes are kept") {
  std::mt19937_64 random(2);
  for (const std::uint32_t labels : {2u, 256u, 257u, 600u, 4'000'000'000u}) {
    INFO(labels);
    const Shape shape{.vertices = 50, .triangles = kSanitized ? 600u : 2000u, .labels = labels};
    check_base(random_plan(random, shape), shape);
  }
}

TEST_CASE("both decoders find codes in grains and between them") {
  std::mt19937_64 random(7);
  for (const std::int32_t grain : {2, 3, 64, 65'536}) {
    INFO(grain);
    const Shape shape{.grain = grain};
    check_base(random_plan(random, shape), shape);
  }
}

TEST_CASE("both decoders find places at the ends of the grid") {
  std::mt19937_64 random(3);
  for (const std::int32_t extent : {1, 1'000'000'000, 2'147'483'647}) {
    INFO(extent);
    const Shape shape{.extent = extent};
    check_base(random_plan(random, shape), shape);
  }
}

TEST_CASE("both decoders find one of more than 65,536 vertices") {
  std::mt19937_64 random(4);
  for (const std::uint32_t vertices : {65'536u, 65'537u, kSanitized ? 70'000u : 200'000u}) {
    INFO(vertices);
    const Shape shape{.vertices = vertices, .triangles = 100};
    check_base(random_plan(random, shape), shape);
  }
}

// Corners are held against the first 256 at their vertex.
TEST_CASE("both decoders find codes that few of many corners have") {
  std::mt19937_64 random(6);
  for (int trial = 0; trial < 5; ++trial) {
    INFO(trial);
    const Shape shape{.vertices = 4, .triangles = 900};
    codec::BlockPlan plan = random_plan(random, shape);
    for (codec::CodedValue& value : plan.fine.values[0]) {
      const bool is_rare = random() % 100 == 0;
      value = {std::int32_t(is_rare ? 3 + random() % 2 : random() % 3), 0, 0, 0};
    }
    check_base(plan, shape);
  }
}

// A wheel whose first 300 triangles are flat and have one code, while the others are folded and
// have several. Its hub, the last vertex, is asked after all others.
TEST_CASE("both decoders look at the bends of the first 256 triangles") {
  constexpr std::uint32_t kSpokes = 400, kFlat = 300;
  const Shape shape{.vertices = kSpokes + 1, .triangles = kSpokes, .has_directions = true};
  codec::BlockPlan plan;
  codec::PatchMesh& mesh = plan.fine;
  mesh.values.resize(2);
  for (std::uint32_t i = 0; i < kSpokes; ++i) {
    const double angle = 2 * kPi * i / kSpokes;
    mesh.positions.push_back({std::int32_t(10'000 * std::cos(angle)),
                              std::int32_t(10'000 * std::sin(angle)),
                              i > kFlat && i % 2 == 0 ? 9'000 : 0});
    mesh.triangles.push_back({i, (i + 1) % kSpokes, kSpokes});
    mesh.category.push_back(0);
    mesh.derived.push_back(0);
    plan.labels.push_back(0);
    for (std::int32_t c = 0; c < 3; ++c) {
      const bool is_folded = i > kFlat && c < 2;
      mesh.values[0].push_back({is_folded ? std::int32_t(i) : 7, 0, 0, 0});
      mesh.values[1].push_back({is_folded ? std::int32_t(i) : 500, 510, 0, 0});
    }
  }
  mesh.positions.push_back({0, 0, 0});
  check_base(plan, shape);
}

// Block 1 starts from a part of block 0, and names vertices of the rest.
TEST_CASE("both decoders find vertices that a coarser block has made") {
  std::mt19937_64 random(5);
  std::size_t refused = 0;
  for (int trial = 0; trial < 20; ++trial) {
    INFO(trial);
    const Shape shape{.vertices = 40, .triangles = 30, .labels = 3};
    const Both base = check_base(random_plan(random, shape), shape);
    const codec::CoarseEnd start = codec::sort_by_label(std::span(&base.codec->end, 1), 3)[0];
    const plain::End other_start = plain::coarse_ends({base.plain->fine}, 3)[0];
    codec::BlockPlan plan;
    plan.fine = start.mesh;
    plan.labels.assign(start.mesh.triangles.size(), 0);
    std::vector<codec::VertexName> names(start.names.size(), {kNone, 0});
    // Of every second trial all are there once; of the others some are there already.
    for (std::uint32_t v = 0; v < shape.vertices; ++v) {
      const codec::VertexName name{0, v};
      const bool is_there =
          std::find(start.names.begin(), start.names.end(), name) != start.names.end();
      if (is_there && (trial % 2 == 0 || random() % 8 != 0)) continue;
      plan.fine.positions.push_back(base.codec->end.mesh.positions[v]);
      names.push_back(random() % 2 == 0 ? name : codec::VertexName{kNone, 0});
    }
    std::vector<std::uint32_t> triangles(start.mesh.triangles.size()), vertices(start.names.size());
    std::iota(triangles.begin(), triangles.end(), 0u);
    std::iota(vertices.begin(), vertices.end(), 0u);
    const codec::EncodedBlock block =
        codec::encode_block(plan, 1, coding_of(shape), start, triangles, vertices, names);
    const codec::BlockLimits limits{std::uint32_t(names.size()), std::uint32_t(triangles.size())};
    const Both both = decoded(block.bytes, 1, shape, limits, start, other_start);
    if (trial % 2 == 0) CHECK(both.codec.has_value());
    refused += !both.codec.has_value();
    for (std::size_t bit = 0; bit < 8 * block.bytes.size(); bit += kSanitized ? 11 : 1) {
      std::vector<std::byte> bad = block.bytes;
      bad[bit / 8] ^= std::byte(1u << bit % 8);
      decoded(bad, 1, shape, limits, start, other_start);
    }
  }
  CHECK(refused > 0);
}

}  // namespace
}  // namespace crease
