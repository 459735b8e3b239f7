// The codec and the plain decoder, which was written from the documents, find the same in every
// block.
#include "codec/checksum.h"
#include "codec/decode_block.h"
#include "codec/documented_file.h"
#include "codec/encoded_model.h"
#include "codec/lattices.h"
#include "codec/layer_values.h"
#include "crease/import.h"
#include "plain_decoder/checksum.h"
#include "plain_decoder/difference_test.h"
#include "plain_decoder/model.h"
#include "plain_decoder/values.h"
#include "support/mesh_zoo.h"
#include "support/sanitized.h"
#include "support/shared_data.h"
#include "support/village.h"

#include <doctest/doctest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <random>

namespace crease {
namespace {

using codec::CoarseEnd;
using codec::DecodedBlock;
using codec::FineEnd;

// What the codec knows of a file: every block, and what it started from.
struct CodecModel {
  std::vector<BlockEntry> entries;
  codec::BlockCoding coding;
  std::vector<LayerCoding> codings;
  std::vector<CoarseEnd> coarse;
  std::vector<DecodedBlock> blocks;
  std::vector<std::vector<std::byte>> payloads;
};

CodecModel decoded_by_codec(const BlockFile& file) {
  CodecModel model;
  model.codings = *decode_codings(file.facts().layers, *file.read_tables());
  model.coding = block_coding(file.facts().layers, model.codings, file.read_materials()->size(),
                              file.read_parts()->size());
  if (file.head().version < 10) model.coding.rates = codec::kRatesBefore;
  for (std::uint32_t p = 0; p < file.page_count(); ++p) {
    const Result<DirectoryPage> page = file.read_page(p);
    REQUIRE(page.ok());
    model.entries.insert(model.entries.end(), page->blocks.begin(), page->blocks.end());
  }
  std::vector<FineEnd> ends;
  for (std::size_t b = 0; b < model.entries.size();) {
    const std::uint16_t band = model.entries[b].facts.band;
    const bool is_base = band == file.facts().bands.size();
    std::vector<CoarseEnd> starts =
        codec::sort_by_label(ends, is_base ? 1 : file.facts().bands[band].patches);
    ends.clear();
    for (; b < model.entries.size() && model.entries[b].facts.band == band; ++b) {
      const BlockFacts& facts = model.entries[b].facts;
      model.payloads.push_back(*file.read_block(model.entries[b]));
      model.coarse.push_back(starts[facts.patch]);
      Result<DecodedBlock> block =
          codec::decode_block(model.payloads.back(), std::uint32_t(b), model.coding,
                              {facts.vertices, facts.triangles_fine}, model.coarse.back());
      REQUIRE_MESSAGE(block.ok(), (block.ok() ? "" : block.failure().message));
      ends.push_back(block->end);
      model.blocks.push_back(*std::move(block));
    }
  }
  return model;
}

void check_facts(const BlockFile& file, const CodecModel& codec_model,
                 const plain::Container& container) {
  const ModelFacts& facts = file.facts();
  CHECK(container.head.vertices == facts.vertex_count);
  CHECK(container.head.triangles == facts.triangle_count);
  CHECK(container.head.step == facts.grid.step);
  for (int k = 0; k < 3; ++k) CHECK(container.head.origin[std::size_t(k)] == facts.grid.origin[k]);
  CHECK(container.head.grid_bits == facts.grid_bits);
  CHECK(container.head.up == static_cast<std::uint8_t>(facts.up));
  REQUIRE(container.head.layers.size() == facts.layers.size());
  for (std::size_t l = 0; l < facts.layers.size(); ++l) {
    CHECK(container.head.layers[l].name == facts.layers[l].name);
    CHECK(int(container.head.layers[l].interpolation) == int(facts.layers[l].interpolation));
  }
  const std::vector<Material> materials = *file.read_materials();
  REQUIRE(container.materials.size() == materials.size());
  for (std::size_t i = 0; i < materials.size(); ++i) {
    CHECK(container.materials[i].name == materials[i].name);
    CHECK(container.materials[i].colour == materials[i].base_color);
    CHECK(container.materials[i].texture == materials[i].base_color_texture);
    CHECK(container.materials[i].cutoff == materials[i].alpha_cutoff);
    CHECK(container.materials[i].double_sided == materials[i].double_sided);
    CHECK(container.materials[i].blended == materials[i].is_blended);
  }
  CHECK(container.part_names == *file.read_parts());
  const std::vector<ImageFile> images = *file.read_images();
  REQUIRE(container.images.size() == images.size());
  for (std::size_t i = 0; i < images.size(); ++i) {
    CHECK(container.images[i].name == images[i].name);
    CHECK((container.images[i].bytes == *images[i].bytes));
  }
  REQUIRE(container.head.bands.size() == facts.bands.size());
  for (std::size_t b = 0; b < facts.bands.size(); ++b) {
    CHECK(container.head.bands[b].contractions == facts.bands[b].contractions);
    CHECK(container.head.bands[b].errors[2] == facts.bands[b].error.degrees);
  }
  REQUIRE(container.entries.size() == codec_model.entries.size());
  for (std::size_t b = 0; b < container.entries.size(); ++b) {
    const plain::Entry& entry = container.entries[b];
    const BlockEntry& expected = codec_model.entries[b];
    CHECK(entry.offset == expected.offset);
    CHECK(entry.memory == expected.facts.decoded_bytes);
    CHECK(entry.radius == expected.facts.radius);
    CHECK(entry.coarse[0] == expected.facts.coarse.surface);
    CHECK(entry.fine[3] == expected.facts.fine.texture);
    const DirectoryPage page = *file.read_page(page_of(expected.id));
    const std::span<const BlockId> needs = page.dependencies_of(expected.id);
    REQUIRE(entry.needs.size() == needs.size());
    for (std::size_t i = 0; i < needs.size(); ++i) CHECK(entry.needs[i] == index_of(needs[i]));
  }
}

// The numbers that codes stand for, bit by bit: of the finest blocks.
void check_values(const BlockFile& file, const CodecModel& codec_model, const plain::Model& model) {
  if (model.blocks.empty()) return;
  const plain::End& end = model.blocks.back().fine;
  for (std::size_t l = 0; l < end.codes.size(); ++l) {
    const std::uint32_t dimension = file.facts().layers[l].dimension;
    const LayerValues values(codec_model.codings[l], dimension);
    std::size_t different = 0;
    // A sextant makes its tables anew for each value, so not all of them.
    const std::size_t step = 1 + end.codes[l].size() / 500;
    for (std::size_t c = 0; c < end.codes[l].size(); c += step) {
      std::vector<float> expected(dimension);
      values.read(codec::CodedValue{end.codes[l][c]}, expected);
      const std::vector<float> got =
          plain::value_of(end.codes[l][c], model.schema.layers[l], model.lattices[l]);
      REQUIRE(got.size() == expected.size());
      different += std::memcmp(got.data(), expected.data(), 4 * got.size()) != 0;
    }
    CHECK(different == 0);
  }
}

// How many blocks there are, all of them equal.
std::size_t check_file(const std::vector<std::byte>& bytes) {
  const BlockFile file = opened(bytes);
  const CodecModel expected = decoded_by_codec(file);
  std::optional<plain::Model> model;
  try {
    model = plain::decode_model(bytes);
  } catch (const plain::Refused& refused) {
    FAIL(std::string(refused.what()));
  }
  check_facts(file, expected, model->container);
  REQUIRE(model->blocks.size() == expected.blocks.size());
  for (std::size_t b = 0; b < expected.blocks.size(); ++b) {
    INFO("block ", b);
    const CoarseEnd& coarse = expected.coarse[b];
    REQUIRE(difference(coarse.mesh, coarse.names, expected.coding, model->coarse[b]) == "");
    REQUIRE(difference(expected.blocks[b], expected.coding, model->blocks[b]) == "");
  }
  check_values(file, expected, *model);
  return model->blocks.size();
}

std::vector<std::byte> file_bytes(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  const std::vector<char> all{std::istreambuf_iterator<char>(in), {}};
  std::vector<std::byte> bytes;
  for (const char c : all) bytes.push_back(static_cast<std::byte>(c));
  return bytes;
}

AttributePrecision precision_of(int normal_bits, NormalCoding coding = NormalCoding::Octahedral) {
  AttributePrecision precision = kCoarsePrecision;
  precision.normal_bits = normal_bits;
  precision.normal_coding = coding;
  return precision;
}

std::filesystem::path golden(const char* name) {
  return std::filesystem::path(__FILE__).parent_path() / "../codec/golden" / name;
}

TEST_CASE("the plain decoder finds what the codec does, in small models of every kind") {
  struct Way {
    std::uint32_t patch_triangles;
    int bits;
    AttributePrecision precision;
    Placement placement;
  };
  const std::vector<Way> ways{
      {200, 14, precision_of(10), Placement::Optimal},
      {8000, 24, kExactPrecision, Placement::Endpoint},
      {100, 12, precision_of(6, NormalCoding::Deering), Placement::Optimal},
      {400, 10, precision_of(8), Placement::Endpoint},
      {300, 16, precision_of(12), Placement::Optimal},
      {1000, 20, precision_of(16), Placement::Endpoint},
      {500, 8, precision_of(4, NormalCoding::Deering), Placement::Endpoint},
  };
  std::size_t blocks = 0, number = 0;
  for (const ZooMesh& zoo : mesh_zoo()) {
    INFO(zoo.name);
    ++number;
    for (std::size_t w = 0; w < ways.size(); ++w) {
      if (kSanitized && w != number % ways.size()) continue;
      INFO("way ", w);
      const Way& way = ways[w];
      blocks += check_file(
          simplified_case(zoo.mesh, way.patch_triangles, way.bits, way.precision, way.placement)
              .bytes);
    }
  }
  CHECK(blocks > (kSanitized ? 80 : 700));
}

TEST_CASE("the plain decoder finds what the codec does, in real models") {
  struct Real {
    const char* name;
    AttributePrecision precision;
    Placement placement;
  };
  for (const Real& real :
       {Real{"cad/fandisk.off", precision_of(12), Placement::Endpoint},
        Real{"attributes/corset.glb", precision_of(10), Placement::Optimal},
        Real{"attributes/cube_vertex_colours.glb", precision_of(16), Placement::Optimal},
        Real{"attributes/pirate.obj.zst", kExactPrecision, Placement::Endpoint},
        Real{"city/delft_36k.obj.zst", precision_of(8), Placement::Optimal},
        Real{"nasty/topology_bunny_nonmanifold_ascii.ply", precision_of(10), Placement::Optimal},
        Real{"attributes/materials_7.obj.zst", precision_of(6, NormalCoding::Deering),
             Placement::Optimal}}) {
    const std::filesystem::path path = shared_model(real.name);
    if (path.empty() || !std::filesystem::exists(path)) continue;
    if (kSanitized && path.filename() != "fandisk.off") continue;
    INFO(real.name);
    Result<Imported> in = import_mesh(path, {});
    REQUIRE(in.ok());
    CHECK(check_file(simplified_case(std::move(in->mesh), 4000, 14, real.precision, real.placement)
                         .bytes) > 1);
  }
}

// Some normals become zero, which is no direction but has a code.
void lose_normals(Mesh& mesh) {
  for (AttributeLayer& layer : mesh.layers) {
    if (layer.role != AttributeRole::Normal) continue;
    for (std::size_t i = 0; i + 3 <= layer.values.size(); i += 15) {
      std::fill_n(layer.values.begin() + std::ptrdiff_t(i), 3, 0.0f);
    }
  }
}

EncodedCase random_case(Mesh mesh, std::uint64_t seed, const AttributePrecision& precision,
                        int bits = 14) {
  const Grid grid = make_grid(mesh, {.length = 0, .bits = bits});
  snap(mesh, grid);
  const std::vector<LayerCoding> codings = codings_of(mesh, precision);
  snap_to_codings(mesh, codings);
  ContractionSequence sequence = random_contractions(mesh, grid, {.seed = seed});
  snap_new_values(sequence, mesh, codings);
  make_one_band(mesh, sequence);
  return encoded_case(std::move(mesh), std::move(sequence), codings);
}

TEST_CASE("the plain decoder finds what the codec does, in random contractions") {
  for (std::uint64_t seed = 1; seed <= (kSanitized ? 40 : 300); ++seed) {
    INFO(seed);
    Mesh mesh = random_complex(seed, 4 + seed % 40, 4 + seed * 7 % 120);
    if (has_isolated_vertex(mesh)) continue;
    const AttributePrecision precision =
        seed % 3 == 0 ? kExactPrecision : precision_of(8 + int(seed % 9));
    if (seed % 4 == 0) lose_normals(mesh);
    const int bits = seed % 5 == 0 ? 31 : 14;
    CHECK(check_file(random_case(std::move(mesh), seed, precision, bits).bytes) == 2);
  }
}

// Flat walls far apart: on a fine grid a place that nothing foretells is worth less than a float
// holds.
TEST_CASE("the plain decoder finds what the codec does, in boxes on fine grids") {
  for (const int bits : {20, 22, 24, 26, 28, 30}) {
    INFO(bits);
    if (kSanitized && bits != 24) continue;
    for (const int blocks : {3, 5, 8}) {
      INFO(blocks);
      check_file(
          simplified_case(city_blocks(blocks, 1), 8000, bits, kExactPrecision, Placement::Endpoint)
              .bytes);
    }
    check_file(simplified_case(village(), 8000, bits, precision_of(10)).bytes);
  }
}

// Around as many triangles as are coded by the odds of pairs, as a fan may have, and more.
TEST_CASE("the plain decoder finds what the codec does, at vertices of many triangles") {
  for (const std::uint32_t spokes : {15u, 16u, 17u, 255u, 256u, 257u, 300u, 700u}) {
    INFO(spokes);
    if (kSanitized && spokes != 16 && spokes != 257) continue;
    const Mesh fan = sector_fan(int(spokes), 2), tip = cone(int(spokes), 2);
    if (spokes < 100) {  // the simplifier takes many seconds there
      check_file(simplified_case(fan, 8000, 14, precision_of(12), Placement::Endpoint).bytes);
      check_file(simplified_case(tip, 8000, 16, precision_of(10)).bytes);
    }
    check_file(random_case(fan, spokes, kExactPrecision).bytes);
    check_file(random_case(fan, spokes + 1, precision_of(11)).bytes);
    check_file(random_case(tip, spokes + 2, precision_of(9)).bytes);
  }
  // No fans, and any places.
  for (std::uint64_t seed = 1; seed <= (kSanitized ? 2 : 12); ++seed) {
    INFO(seed);
    Mesh mesh = random_complex(seed, 4 + seed, 700 + 100 * seed);
    REQUIRE(!has_isolated_vertex(mesh));
    check_file(random_case(std::move(mesh), seed, precision_of(9)).bytes);
  }
}

TEST_CASE("the plain decoder reads the example of docs/format.md") {
  CHECK(check_file(documented_file(golden("../../../docs/format.md"))) == 2);
}

TEST_CASE("the plain decoder reads the golden files") {
  CHECK(check_file(file_bytes(golden("model_6.crease"))) == 2);
  CHECK(check_file(file_bytes(golden("model_10.crease"))) == 2);
  // The payloads of these are no blocks.
  for (const char* name :
       {"version_6.crease", "version_7.crease", "version_8.crease", "version_9.crease",
        "version_10.crease", "version_11.crease", "version_12.crease", "version_13.crease"}) {
    const plain::Bytes example = file_bytes(golden(name));
    const plain::Container container = plain::read_container(example);
    REQUIRE(!container.entries.empty());
    for (const plain::Entry& entry : container.entries) {
      CHECK(plain::read_payload(example, entry).size() == entry.bytes);
    }
    const int layout = container.head.layout;
    CHECK(container.images.size() == (layout == 7 ? 2 : layout == 8 ? 1 : 0));
  }
}

TEST_CASE("any number is a value, the same in both") {
  std::mt19937_64 random(1);
  std::vector<NumberLattice> numbers(3, {.divisor = 255, .low = -3, .high = 900, .palette = {}});
  numbers[1] = {.divisor = 1, .low = -1, .high = 2, .palette = {-2.5f, 0, 0.1f, 7}};
  numbers[2] = {.divisor = 1, .low = -15, .high = 30, .palette = {-2.5f, 0, 0.1f, 7}, .grain = 15};
  std::vector<plain::Lattice> lattices;
  for (const NumberLattice& n : numbers) {
    lattices.push_back({n.divisor, n.low, n.high, n.palette, n.grain});
  }
  const auto check = [&](const LayerCoding& coding, plain::BlockLayer::Kind kind) {
    const LayerValues values(coding, 3);
    std::size_t different = 0;
    for (int i = 0; i < 3000; ++i) {
      codec::CodedValue code{};
      const int shift = i % 33;  // from large numbers to small ones
      for (std::int32_t& c : code) c = std::int32_t(std::int64_t(random() & 0xffffffffu) >> shift);
      if (kind == plain::BlockLayer::Kind::Sextant && i % 3 != 0) {
        // On a side of the triangle or near it, where codes are not canonical.
        const std::uint32_t most = 1u << coding.bits;
        const std::uint32_t theta = std::uint32_t(random() % 4) * most / 3;
        const std::uint32_t phi = random() % 2 == 0 ? 0 : most - std::min(theta, most);
        code[0] = std::int32_t(std::uint32_t(random() % 50) << 26 | theta << 13 | phi);
      }
      std::array<float, 3> expected{};
      values.read(code, expected);
      const std::vector<float> got = plain::value_of(code, {kind, coding.bits, 3, false}, lattices);
      different += std::memcmp(got.data(), expected.data(), sizeof(expected)) != 0;
    }
    CHECK(different == 0);
  };
  using Kind = LayerCoding::Kind;
  check({.kind = Kind::Exact, .bits = 0, .components = {}}, plain::BlockLayer::Kind::Floats);
  check({.kind = Kind::Lattice, .bits = 8, .components = numbers},
        plain::BlockLayer::Kind::Lattice);
  for (const int bits : {4, 10, 16}) {
    check({.kind = Kind::Octahedral, .bits = bits, .components = {}},
          plain::BlockLayer::Kind::Octahedral);
  }
  for (const int bits : {2, 6, 12}) {
    check({.kind = Kind::Sextant, .bits = bits, .components = {}},
          plain::BlockLayer::Kind::Sextant);
  }
}

TEST_CASE("checksums of every length") {
  std::mt19937_64 random(1);
  plain::Bytes bytes;
  for (std::size_t length = 0; length < 3000; ++length) {
    if (plain::checksum(bytes) != checksum(bytes)) FAIL(length);
    bytes.push_back(static_cast<std::byte>(random()));
  }
}

std::optional<plain::Block> plainly_decoded(std::span<const std::byte> payload, std::size_t number,
                                            const plain::Model& model) {
  const plain::Entry& entry = model.container.entries[number];
  try {
    return plain::decode_block(payload, std::uint32_t(number), model.schema,
                               {entry.vertices, entry.fine_triangles}, model.coarse[number]);
  } catch (const plain::Refused&) {
    return std::nullopt;
  }
}

// Of harmed bytes as well: either both refuse them, or both find the same.
TEST_CASE("the plain decoder refuses the harmed payloads that the codec refuses") {
  std::size_t refused = 0, read = 0;
  for (const EncodedCase& c :
       {small_case(), simplified_case(hard_box(2), 40, 10, precision_of(10))}) {
    const BlockFile file = opened(c.bytes);
    const CodecModel expected = decoded_by_codec(file);
    const plain::Model model = plain::decode_model(c.bytes);
    const auto check = [&](std::size_t b, const std::vector<std::byte>& payload) {
      const BlockFacts& facts = expected.entries[b].facts;
      const Result<DecodedBlock> block =
          codec::decode_block(payload, std::uint32_t(b), expected.coding,
                              {facts.vertices, facts.triangles_fine}, expected.coarse[b]);
      const std::optional<plain::Block> other = plainly_decoded(payload, b, model);
      REQUIRE(block.ok() == other.has_value());
      if (other) CHECK(difference(*block, expected.coding, *other) == "");
      ++(other ? read : refused);
    };
    for (std::size_t b = 0; b < expected.payloads.size(); ++b) {
      INFO("block ", b);
      const std::vector<std::byte>& good = expected.payloads[b];
      for (std::size_t length = 0; length < good.size(); ++length) {
        check(b, {good.begin(), good.begin() + std::ptrdiff_t(length)});
      }
      for (std::size_t bit = 0; bit < 8 * good.size(); bit += kSanitized ? 7 : 1) {
        std::vector<std::byte> bad = good;
        bad[bit / 8] ^= std::byte(1u << bit % 8);
        check(b, bad);
      }
    }
  }
  CHECK(refused > 100);
  CHECK(read > 100);
}

TEST_CASE("the plain decoder refuses files that are cut or harmed") {
  EncodedCase small = small_case();
  small.mesh.images = {{"a.png", std::make_shared<const plain::Bytes>(5, std::byte{1})},
                       {"b.png", std::make_shared<const plain::Bytes>(9, std::byte{2})}};
  const std::vector<std::byte> good =
      encoded_case(small.mesh, small.sequence, codings_of(small.mesh, kCoarsePrecision)).bytes;
  CHECK(check_file(good) == 2);
  const auto is_refused = [](const std::vector<std::byte>& bytes) {
    try {
      plain::decode_model(bytes);
      return false;
    } catch (const plain::Refused&) {
      return true;
    }
  };
  CHECK(!is_refused(good));
  for (std::size_t length = 0; length < good.size(); ++length) {
    CHECK(is_refused({good.begin(), good.begin() + std::ptrdiff_t(length)}));
  }
  for (std::size_t byte = 0; byte < good.size(); ++byte) {
    std::vector<std::byte> bad = good;
    bad[byte] ^= std::byte(1u << byte % 8);
    CHECK(is_refused(bad));
  }
}

}  // namespace
}  // namespace crease
