// A file is the model that was encoded: at full resolution, at both ends of every band, and on
// every cut along block borders, whatever the threads.
#include "codec/encoded_model.h"
#include "crease/build.h"
#include "crease/build_hierarchy.h"
#include "crease/import.h"
#include "crease/threads.h"
#include "support/described_mesh.h"
#include "support/mesh_builder.h"
#include "support/mesh_zoo.h"
#include "support/sanitized.h"
#include "support/shared_data.h"

#include <doctest/doctest.h>

#include <iterator>
#include <random>
#include <set>

namespace crease {
namespace {

// By the definition: the contractions of all blocks but these, one by one.
DescribedMesh expected_cut(const EncodedCase& c, const BlockFile& file,
                           const std::set<std::pair<std::uint32_t, std::uint32_t>>& decoded) {
  ContractionSequence rest = c.sequence;
  rest.contractions.clear();
  std::size_t next = 0;
  for (std::uint32_t b = 0; b < c.sequence.bands.size(); ++b) {
    for (std::uint32_t i = 0; i < c.sequence.bands[b].contraction_count; ++i, ++next) {
      if (decoded.contains({b, c.sequence.patch_of_contraction[next]})) continue;
      rest.contractions.push_back(c.sequence.contractions[next]);
    }
  }
  CHECK(file.facts().bands.size() == c.sequence.bands.size());
  const Level level = apply_contractions(c.mesh, rest, rest.contractions.size());
  return described(mesh_of_level(c.mesh, rest, level));
}

DescribedMesh expected_bands(const EncodedCase& c, std::size_t finest_band) {
  std::size_t count = 0;
  for (std::size_t b = 0; b < finest_band; ++b) count += c.sequence.bands[b].contraction_count;
  return described(
      mesh_of_level(c.mesh, c.sequence, apply_contractions(c.mesh, c.sequence, count)));
}

DecodedModel decoded(const BlockFile& file, const DecodeOptions& options = {}) {
  Result<DecodedModel> model = decode_model(file, options);
  REQUIRE_MESSAGE(model.ok(), (model.ok() ? "" : model.failure().message));
  const Status valid = check_contractions(model->mesh, model->sequence);
  CHECK_MESSAGE(valid.ok(), (valid.ok() ? "" : valid.failure().message));
  return *std::move(model);
}

bool same(const DecodedModel& a, const DecodedModel& b) {
  if (described(a.mesh) != described(b.mesh) || a.blocks != b.blocks ||
      a.sequence.contractions.size() != b.sequence.contractions.size() ||
      a.sequence.changes != b.sequence.changes || a.sequence.derived != b.sequence.derived ||
      a.sequence.new_values != b.sequence.new_values) {
    return false;
  }
  for (std::size_t i = 0; i < a.sequence.contractions.size(); ++i) {
    const Contraction &x = a.sequence.contractions[i], &y = b.sequence.contractions[i];
    if (x.removed != y.removed || x.kept != y.kept || x.position != y.position ||
        x.error.surface != y.error.surface || x.change_count != y.change_count) {
      return false;
    }
  }
  return true;
}

std::size_t missing_from(const DescribedMesh& whole, const DescribedMesh& part) {
  DescribedMesh missing;
  std::set_difference(whole.begin(), whole.end(), part.begin(), part.end(),
                      std::back_inserter(missing));
  return missing.size();
}

void check_bands(const EncodedCase& c) {
  const BlockFile file = opened(c.bytes);
  const DecodedModel whole = decoded(file);
  REQUIRE((described(whole.mesh) == described(c.mesh)));
  CHECK(whole.mesh.vertex_count() == file.facts().vertex_count);
  if (!has_isolated_vertex(c.mesh)) CHECK(whole.mesh.vertex_count() == c.mesh.vertex_count());
  CHECK(whole.mesh.materials == c.mesh.materials);
  CHECK(whole.mesh.parts == c.mesh.parts);
  CHECK(whole.sequence.contractions.size() == c.sequence.contractions.size());
  CHECK(validate_crease(file).empty());
  std::size_t count = 0;
  for (std::uint16_t b = 0; b < file.facts().bands.size(); ++b) {
    INFO("band ", b);
    const DescribedMesh expected = expected_bands(c, b);
    CHECK((described(decoded(file, {.finest_band = b}).mesh) == expected));
    const DescribedMesh level = described(mesh_of_level(
        whole.mesh, whole.sequence, apply_contractions(whole.mesh, whole.sequence, count)));
    CHECK(level.size() == expected.size());
    CHECK(missing_from(expected, level) == 0);
    count += file.facts().bands[b].contractions;
  }
  const Result<MeshHierarchy> hierarchy = build_hierarchy(whole.mesh, whole.sequence, {});
  REQUIRE(hierarchy.ok());
  const Status sound = check_hierarchy(*hierarchy);
  CHECK_MESSAGE(sound.ok(), (sound.ok() ? "" : sound.failure().message));
  const Result<HardEdges> edges = check_hard_edges(*hierarchy);
  CHECK_MESSAGE(edges.ok(), (edges.ok() ? "" : edges.failure().message));
}

void check_subsets(const EncodedCase& c, std::uint64_t seed) {
  const BlockFile file = opened(c.bytes);
  std::mt19937_64 random(seed);
  for (int trial = 0; trial < (kSanitized ? 3 : 8); ++trial) {
    const std::uint64_t share = random() % 100;
    std::set<std::uint32_t> wanted;
    for (std::uint32_t b = 0; b < file.block_count(); ++b) {
      if (random() % 100 < share) wanted.insert(b);
    }
    const DecodeOptions options{.wants = [&](const BlockEntry& entry) {
      return wanted.contains(static_cast<std::uint32_t>(index_of(entry.id)));
    }};
    const DecodedModel model = decoded(file, options);
    std::set<std::pair<std::uint32_t, std::uint32_t>> there;
    for (const BlockId id : model.blocks) {
      const Result<DirectoryPage> page = file.read_page(page_of(id));
      REQUIRE(page.ok());
      there.insert({page->block(id).facts.band, page->block(id).facts.patch});
    }
    CHECK((described(model.mesh) == expected_cut(c, file, there)));
    for (const int threads : {2, 7}) {
      DecodeOptions on_threads = options;
      on_threads.for_each = loop_on_threads(threads);
      CHECK(same(decoded(file, on_threads), model));
    }
  }
}

TEST_CASE("a file has every band's mesh, corner for corner") {
  for (const ZooMesh& zoo : mesh_zoo()) {
    INFO(zoo.name);
    check_bands(simplified_case(zoo.mesh, 200, 14, kCoarsePrecision));
    check_bands(simplified_case(zoo.mesh, 8000, 24, kExactPrecision, Placement::Endpoint));
    if (!kSanitized) {
      AttributePrecision deering = kCoarsePrecision;
      deering.normal_coding = NormalCoding::Deering;
      deering.normal_bits = 6;
      check_bands(simplified_case(zoo.mesh, 200, 14, deering));
    }
  }
}

// More normals at the tip, or at the two ends of an edge, than a decoder keeps apart between bands.
TEST_CASE("files of hubs with hundreds of values") {
  check_bands(simplified_case(cone(300, 2), 8000, 14, kCoarsePrecision));
  MeshBuilder book;
  const VertexId low = book.vertex({0, 0, 0}), high = book.vertex({0, 0, 1});
  for (int page = 0; page < 300; ++page) {
    const double angle = 0.01 * page;
    const VertexId out = book.vertex({std::cos(angle), std::sin(angle), 0.4 + 0.0003 * page});
    book.flat_triangle({low, high, out});
  }
  check_bands(simplified_case(book.take(), 8000, 16, kExactPrecision));
}

std::size_t normals_at(const Mesh& mesh, const Vec3d& position) {
  std::set<std::vector<float>> normals;
  for (std::size_t corner = 0; corner < 3 * mesh.triangle_count(); ++corner) {
    const VertexId v = mesh.triangles[corner / 3][corner % 3];
    if (length(mesh.positions[index_of(v)] - position) > 0.1) continue;
    const auto normal = mesh.layers[0].value(mesh.layers[0].of_corner[corner]);
    normals.insert({normal.begin(), normal.end()});
  }
  return normals.size();
}

//   w----u----v    p-q-u links what p and q have, but the record leaves it apart. Then s comes to
//   them,
//    \  / \  /     and what stands there is what it is at the coarse end.
//     p--q--s
//        d--v
TEST_CASE("normals that a collapsed triangle links and the coarse end has apart stay apart") {
  MeshBuilder b;
  const VertexId p = b.vertex({0, 0, 0}), q = b.vertex({1, 0, 0}), s = b.vertex({2, 0, 0}),
                 u = b.vertex({1, 2, 0.5}), d = b.vertex({1, -2, 0.5}), v = b.vertex({4, 0, 1}),
                 w = b.vertex({-2, 1, 0});
  const AttributeId at_p = b.normal({0, 0.2, 1}), at_q = b.normal({0, -0.2, 1}),
                    at_s = b.normal({0.3, -0.2, 1}), at_u = b.normal({0, 0.3, 1}),
                    at_d = b.normal({0, -0.3, 1}), at_v = b.normal({0.4, 0, 1}),
                    at_w = b.normal({-0.4, 0, 1});
  b.triangle({p, q, u}, {at_p, at_q, at_u});
  b.triangle({q, s, u}, {at_q, at_s, at_u});
  b.triangle({w, p, u}, {at_w, at_p, at_u});
  b.triangle({d, v, q}, {at_d, at_v, at_q});
  b.triangle({s, v, u}, {at_s, at_v, at_u});
  Mesh mesh = b.take();
  ContractionSequence sequence;
  sequence.grid = make_grid(mesh, {.bits = 8});
  snap(mesh, sequence.grid);
  sequence.new_values.resize(1);
  for (const VertexId removed : {q, s}) {
    Contraction c;
    c.kept = p;
    c.removed = removed;
    c.position = sequence.grid.nearest(mesh.positions[index_of(p)]);
    sequence.contractions.push_back(c);
  }
  sequence.contractions[1].change_count = 1;
  sequence.changes = {{0, at_s, at_q}};
  make_one_band(mesh, sequence);
  const std::vector<LayerCoding> codings = codings_of(mesh, kExactPrecision);
  const EncodedCase c = encoded_case(std::move(mesh), std::move(sequence), codings);
  check_bands(c);
  const DecodedModel model = decoded(opened(c.bytes));
  const Mesh between =
      mesh_of_level(model.mesh, model.sequence, apply_contractions(model.mesh, model.sequence, 1));
  CHECK(normals_at(between, {0, 0, 0}) == 2);
  const auto coarse = [](const Mesh& finest, const ContractionSequence& all) {
    return described(mesh_of_level(finest, all, apply_contractions(finest, all, 2)));
  };
  CHECK((coarse(model.mesh, model.sequence) == coarse(c.mesh, c.sequence)));
}

TEST_CASE("any closed subset of blocks is the cut that the definition has there") {
  std::uint64_t seed = 0;
  for (const ZooMesh& zoo : mesh_zoo()) {
    INFO(zoo.name);
    check_subsets(simplified_case(zoo.mesh, 100, 14, kCoarsePrecision), ++seed);
  }
}

TEST_CASE("files of real models") {
  for (const std::string name :
       {"cad/fandisk.off", "city/delft_36k.obj.zst", "attributes/corset.glb",
        "attributes/pirate.obj.zst", "cad/hoppe_mechpart.obj.zst"}) {
    const std::filesystem::path path = shared_model(name);
    if (path.empty() || !std::filesystem::exists(path)) continue;
    if (kSanitized && name != "cad/fandisk.off") continue;
    INFO(name);
    Result<Imported> in = import_mesh(path, {});
    REQUIRE(in.ok());
    const EncodedCase c = simplified_case(std::move(in->mesh), 4000, 14, kCoarsePrecision);
    check_bands(c);
    if (!kSanitized) check_subsets(c, 3);
  }
}

TEST_CASE("files of random contractions of random complexes") {
  for (std::uint64_t seed = 1; seed <= (kSanitized ? 40 : 150); ++seed) {
    INFO(seed);
    Mesh mesh = random_complex(seed, 4 + seed % 40, 4 + seed * 7 % 120);
    if (has_isolated_vertex(mesh)) continue;
    const Grid grid = make_grid(mesh, {.length = 0, .bits = 14});
    snap(mesh, grid);
    ContractionSequence sequence = random_contractions(mesh, grid, {.seed = seed});
    make_one_band(mesh, sequence);
    const std::vector<LayerCoding> codings = codings_of(mesh, kExactPrecision);
    check_bands(encoded_case(std::move(mesh), std::move(sequence), codings));
  }
}

TEST_CASE("the bits of the streams are what the payloads take") {
  const EncodedCase c = simplified_case(mesh_zoo().front().mesh, 200, 14, kCoarsePrecision);
  const BlockFile file = opened(c.bytes);
  const DecodedModel model = decoded(file, {.count_bits = true});
  double bits = 0;
  for (const StreamBits& b : model.bits) {
    bits += b.roots + b.flags + b.shapes + b.positions + b.categories + b.values + b.labels;
  }
  CHECK(bits <= 8 * double(model.payload_bytes) + 1);
  CHECK(bits >= 8 * double(model.payload_bytes) - 40 * double(model.blocks.size()));
  CHECK(model.bits.size() == file.facts().bands.size() + 1);
}

TEST_CASE("fewer bands are fewer bytes read") {
  const Result<Built> built = build_model(smooth_sphere(60, 90), {});
  REQUIRE(built.ok());
  std::uint64_t before = built->file_bytes.size() + 1;
  for (std::uint16_t b = 0; b < built->statistics.bands.size(); b += 3) {
    const BlockFile file = opened(built->file_bytes);
    const DecodedModel model = decoded(file, {.finest_band = b});
    CHECK(model.payload_bytes < before);
    CHECK(file.source().bytes_read() <= built->file_bytes.size() + 65'536);  // the head's read
    CHECK((b == 0) == (model.error.surface == 0));
    before = model.payload_bytes;
  }
}

}  // namespace
}  // namespace crease
