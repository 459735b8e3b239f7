// By vertex inside resident blocks, against the definition: whatever blocks and hierarchies have
// come, and however the view went, what is shown is one cut.
#include "codec/checksum.h"
#include "crease/block_view.h"
#include "crease/build_hierarchy.h"
#include "crease/decode_model.h"
#include "crease/import.h"
#include "runtime/block_mesh_impl.h"
#include "runtime/block_mesh_oracle.h"
#include "runtime/block_vertices_oracle.h"
#include "runtime/draw_values.h"
#include "runtime/extract_cut.h"
#include "runtime/view_error.h"
#include "support/described_mesh.h"
#include "support/drawn_triangles.h"
#include "support/mesh_zoo.h"
#include "support/random_contractions.h"
#include "support/sanitized.h"
#include "support/shared_data.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <random>
#include <set>

namespace crease {
namespace {

// What arrives of a file, as far as one asks.
struct Arrivals {
  explicit Arrivals(const BlockFile& f, BlockMesh m) : file(f), mesh(std::move(m)) {}

  bool load(const BlockEntry& entry) {
    const std::optional<BlockDecodeJob> job = mesh.decode_job(entry.id);
    if (!job) return false;
    const Result<std::vector<std::byte>> payload = file.read_block(entry);
    REQUIRE(payload.ok());
    Result<ResidentBlockPtr> block = job->run(*payload);
    REQUIRE_MESSAGE(block.ok(), (block.ok() ? "" : block.failure().message));
    mesh.insert(*std::move(block));
    return true;
  }
  bool make(BlockId id) {
    const std::optional<BlockHierarchyJob> job = mesh.hierarchy_job(id);
    REQUIRE(job.has_value());
    mesh.insert(job->run());
    return true;
  }
  // Until nothing is missing.
  void load_all(const BlockViewParameters& parameters) {
    for (;;) {
      mesh.update(parameters);
      const std::vector<BlockEntry> missing(mesh.missing().begin(), mesh.missing().end());
      const std::vector<BlockId> hierarchies(mesh.missing_hierarchies().begin(),
                                             mesh.missing_hierarchies().end());
      if (missing.empty() && hierarchies.empty() && mesh.has_arrived()) return;
      for (const BlockEntry& entry : missing) load(entry);
      for (const BlockId id : hierarchies) make(id);
    }
  }

  // What another one knows: errors depend on it.
  void load_as(const Arrivals& other) {
    const std::uint32_t blocks = other.mesh.impl().graph.size();
    for (std::uint32_t b = 0; b < blocks; ++b) {
      const BlockEntry& entry = other.mesh.impl().graph.entry(b);
      if (other.mesh.is_resident(entry.id) && !mesh.is_resident(entry.id)) load(entry);
    }
    for (std::uint32_t b = 0; b < blocks; ++b) {
      if (other.mesh.hierarchy(BlockId{b}) && !mesh.hierarchy(BlockId{b})) make(BlockId{b});
    }
  }

  const BlockFile& file;
  BlockMesh mesh;
};

Arrivals opened_arrivals(const BlockFile& file) {
  Result<BlockMesh> mesh = BlockMesh::open(file);
  REQUIRE(mesh.ok());
  while (const std::optional<std::uint32_t> page = mesh->next_page()) {
    const Result<DirectoryPage> read = file.read_page(*page);
    REQUIRE(read.ok());
    REQUIRE(mesh->add_page(*read).ok());
  }
  Result<std::vector<std::string>> names = file.read_parts();
  REQUIRE(names.ok());
  mesh->set_part_names(*std::move(names));
  return Arrivals(file, *std::move(mesh));
}

BlockViewParameters random_vertex_view(const Mesh& mesh, std::mt19937_64& random) {
  BlockViewParameters parameters = random_view(mesh, random);
  parameters.by_vertex = true;
  parameters.view.hysteresis = random() % 2 ? 1 : 1.25;
  parameters.view.silhouette_weight = random() % 4 ? 1 : 2;
  parameters.view.coarse_backfaces = random() % 8 == 0;
  return parameters;
}

// Blocks and hierarchies come in any order, some are dropped, the mode changes to and fro.
void check_walk(const EncodedCase& c, std::uint64_t seed) {
  if (c.mesh.vertex_count() == 0) return;
  const BlockFile file = opened(c.bytes);
  Arrivals arrivals = opened_arrivals(file);
  BlockMesh& mesh = arrivals.mesh;
  std::mt19937_64 random(seed);
  std::size_t all = 0;
  for (int trial = 0; trial < (kSanitized ? 4 : 16); ++trial) {
    BlockViewParameters parameters = random_vertex_view(c.mesh, random);
    if (random() % 3 == 0) parameters.max_bytes = all / 4 + all * (random() % 100) / 100;
    parameters.by_vertex = random() % 6 != 0;
    for (std::size_t steps = random() % 6 + 1; steps > 0; --steps) {
      mesh.update(parameters);
      const std::span<const BlockEntry> missing = mesh.missing();
      if (!missing.empty()) arrivals.load(missing[random() % missing.size()]);
      for (const BlockId id : std::vector<BlockId>(mesh.missing_hierarchies().begin(),
                                                   mesh.missing_hierarchies().end())) {
        if (random() % 2) arrivals.make(id);
      }
    }
    mesh.update(parameters);
    all = std::max(all, mesh.resident_bytes());
    if (mesh.is_refined(BlockId{0})) check_by_vertex(mesh);
  }
}

// The same view gives the same of the same blocks, whatever was shown before.
void check_views_by_vertex(const EncodedCase& c, std::uint64_t seed) {
  if (c.mesh.vertex_count() == 0) return;
  const BlockFile file = opened(c.bytes);
  Arrivals walked = opened_arrivals(file);
  std::mt19937_64 random(seed);
  for (int trial = 0; trial < (kSanitized ? 2 : 6); ++trial) {
    BlockViewParameters parameters = random_vertex_view(c.mesh, random);
    parameters.view.hysteresis = 1;
    walked.load_all(parameters);
    check_by_vertex(walked.mesh);
    const std::size_t blocks = check_nothing_is_wrong(walked.mesh, parameters.view);
    CHECK(blocks == walked.mesh.impl().cut.size());
    const BlockUpdate again = walked.mesh.update(parameters);
    CHECK(again.evaluated + again.splits + again.merges == 0);
    const DescribedMesh shown = described(walked.mesh.extract());
    const std::size_t triangles = walked.mesh.triangle_count();
    Arrivals fresh = opened_arrivals(file);
    fresh.load_all(parameters);
    fresh.load_as(walked);
    fresh.load_all(parameters);
    CHECK((described(fresh.mesh.extract()) == shown));
    parameters.by_vertex = false;
    walked.load_all(parameters);
    CHECK(walked.mesh.shown_cuts().empty());
    CHECK(walked.mesh.triangle_count() >= triangles);
    check_shown(file, walked.mesh, wanted_blocks(file, parameters.view));
    parameters.by_vertex = true;
    walked.load_all(parameters);
    CHECK((described(walked.mesh.extract()) == shown));
  }
}

TEST_CASE("by vertex, whatever has come, what is shown is one cut") {
  std::uint64_t seed = 0;
  for (const ZooMesh& zoo : mesh_zoo()) {
    INFO(zoo.name);
    check_walk(simplified_case(zoo.mesh, 100, 14, kCoarsePrecision), ++seed);
  }
}

TEST_CASE("by vertex, a view gets what is seen to be wrong, whatever was shown before") {
  std::uint64_t seed = 100;
  for (const ZooMesh& zoo : mesh_zoo()) {
    INFO(zoo.name);
    check_views_by_vertex(simplified_case(zoo.mesh, 100, 14, kCoarsePrecision), ++seed);
  }
}

// The triangles of ranges, by block, part and number.
std::set<std::array<std::size_t, 3>> triangles_of(std::span<const ShownRange> ranges) {
  std::set<std::array<std::size_t, 3>> all;
  for (const ShownRange& range : ranges) {
    const std::array<Range, 3> parts{range.sn, range.fn, range.nsn};
    for (std::size_t p = 0; p < 3; ++p) {
      for (std::uint32_t t = 0; t < parts[p].count; ++t) {
        CHECK(all.insert({index_of(range.block->id()), p, parts[p].first + t}).second);
      }
    }
  }
  return all;
}

TEST_CASE("by block, what is left out of a frame is beside its view") {
  const EncodedCase c = simplified_case(smooth_sphere(40, 60), 1000, 14, kCoarsePrecision);
  const BlockFile file = opened(c.bytes);
  const Vec3d& origin = file.facts().grid.origin;
  Arrivals arrivals = opened_arrivals(file);
  std::mt19937_64 random(5);
  std::size_t kept = 0, left_out = 0;
  for (int trial = 0; trial < (kSanitized ? 6 : 30); ++trial) {
    BlockViewParameters parameters = random_view(c.mesh, random);
    arrivals.load_all(parameters);
    const Camera& camera = parameters.view.camera;
    const auto all = triangles_of(arrivals.mesh.shown());
    const auto in_view = triangles_of(shown_in_view(arrivals.mesh.shown(), origin, camera));
    const ViewError error(parameters.view, file.facts().grid);
    for (const auto& triangle : all) {
      if (in_view.contains(triangle)) {
        ++kept;
        continue;
      }
      ++left_out;
      const DrawList list = arrivals.mesh.resident(BlockId(triangle[0]))->draw_list();
      const DrawPart& part = triangle[1] == 0 ? list.sn : triangle[1] == 1 ? list.fn : list.nsn;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3f& p = list.positions[part.indices[3 * triangle[2] + k]];
        if (parameters.view.coarse_outside) CHECK(error.inside(p.x, p.y, p.z) < 1e-4f);
      }
    }
    for (const auto& triangle : in_view) CHECK(all.contains(triangle));
  }
  CHECK(kept > 100);
  CHECK(left_out > 100);
}

// Bands of one patch each, of about `size` contractions. A band can only contract vertices that
// have triangles where it begins; the sequence ends where there is another one.
void make_bands(const Mesh& mesh, ContractionSequence& sequence, std::size_t size) {
  std::vector<Contraction>& all = sequence.contractions;
  sequence.bands.clear();
  for (std::size_t begin = 0; begin < all.size();) {
    const Level level = apply_contractions(mesh, sequence, begin);
    Band band;
    std::vector<bool> is_used(mesh.vertex_count(), false);
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
      if (!level.alive[t]) continue;
      band.triangles.push_back(TriangleId{t});
      for (const VertexId v : level.triangles[t]) is_used[index_of(v)] = true;
    }
    band.first_triangle = {0, std::uint32_t(band.triangles.size())};
    const auto fits = [&](const Contraction& c) {
      return is_used[index_of(c.kept)] && is_used[index_of(c.removed)];
    };
    std::size_t end = begin;
    while (end < all.size() && end < begin + size && fits(all[end])) ++end;
    if (end < all.size() && end < begin + size) all.resize(end);
    band.contraction_count = std::uint32_t(end - begin);
    if (end > begin) sequence.bands.push_back(std::move(band));
    begin = end;
  }
  sequence.patch_of_contraction.assign(all.size(), 0);
}

TEST_CASE("by vertex, random complexes are one cut as well") {
  for (std::uint64_t seed = 1; seed <= (kSanitized ? 12 : 60); ++seed) {
    INFO(seed);
    Mesh mesh = random_complex(seed, 4 + seed % 40, 4 + seed * 7 % 120);
    if (has_isolated_vertex(mesh)) continue;
    const Grid grid = make_grid(mesh, {.length = 0, .bits = 10});
    snap(mesh, grid);
    const std::vector<LayerCoding> codings = codings_of(mesh, kCoarsePrecision);
    snap_to_codings(mesh, codings);
    ContractionSequence sequence = random_contractions(mesh, grid, {.seed = seed});
    snap_new_values(sequence, mesh, codings);
    make_bands(mesh, sequence, 3 + seed % 9);
    const EncodedCase c = encoded_case(std::move(mesh), std::move(sequence), codings);
    check_walk(c, seed);
    check_views_by_vertex(c, seed);
  }
}

TEST_CASE("by vertex, with all blocks there, hardly more is shown than of one hierarchy") {
  std::uint64_t seed = 400;
  for (const Mesh& mesh : {city_blocks(6, 2), smooth_sphere(60, 90)}) {
    const EncodedCase c = simplified_case(mesh, 2000, 16, kCoarsePrecision);
    const BlockFile file = opened(c.bytes);
    const Result<DecodedModel> model = decode_model(file);
    REQUIRE(model.ok());
    Result<MeshHierarchy> hierarchy = build_hierarchy(model->mesh, model->sequence, {});
    REQUIRE(hierarchy.ok());
    AdaptiveMesh whole(std::make_shared<const MeshHierarchy>(*std::move(hierarchy)));
    Arrivals arrivals = opened_arrivals(file);
    BlockViewParameters parameters = view_of_all();
    parameters.by_vertex = true;
    arrivals.load_all(parameters);
    std::mt19937_64 random(++seed);
    std::size_t in_blocks = 0, of_whole = 0;
    for (int trial = 0; trial < 12; ++trial) {
      parameters.view = random_vertex_view(c.mesh, random).view;
      arrivals.load_all(parameters);
      whole.update(parameters.view);
      in_blocks += arrivals.mesh.triangle_count();
      of_whole += whole.triangle_count();
    }
    CAPTURE(in_blocks);
    CAPTURE(of_whole);
    CHECK(double(in_blocks) <= 1.3 * double(of_whole));
  }
}

TEST_CASE("by vertex, models of many blocks are one cut") {
  std::uint64_t seed = 200;
  for (const Mesh& mesh : {city_blocks(6, 2), crossing_walls(3, 6), smooth_sphere(30, 44)}) {
    INFO(seed);
    const EncodedCase c = simplified_case(mesh, 150, 14, kCoarsePrecision);
    check_walk(c, ++seed);
    check_views_by_vertex(c, seed);
  }
}

// A clock that goes on by one with each look.
double look_at_clock(void* context) {
  return ++*static_cast<double*>(context);
}

TEST_CASE("by vertex, an update without time leaves one cut, and the next ones go on") {
  const EncodedCase c = simplified_case(smooth_sphere(30, 44), 150, 14, kCoarsePrecision);
  const BlockFile file = opened(c.bytes);
  Arrivals arrivals = opened_arrivals(file);
  std::mt19937_64 random(17);
  double now = 0;
  std::size_t slow = 0;
  for (int trial = 0; trial < (kSanitized ? 3 : 10); ++trial) {
    BlockViewParameters parameters = random_vertex_view(c.mesh, random);
    parameters.view.hysteresis = 1;
    arrivals.load_all(parameters);
    parameters.view.camera.pixels = parameters.view.camera.pixels > 8 ? 1 : 64;
    parameters.view.clock = look_at_clock;
    parameters.view.clock_context = &now;
    parameters.view.max_seconds = 6;
    for (int updates = 0; updates < 1000; ++updates) {
      arrivals.mesh.update(parameters);
      check_by_vertex(arrivals.mesh);
      slow += !arrivals.mesh.has_arrived();
      if (arrivals.mesh.has_arrived()) break;
    }
    CHECK(arrivals.mesh.has_arrived());
    check_nothing_is_wrong(arrivals.mesh, parameters.view);
  }
  CHECK(slow > 0);
}

TEST_CASE("by vertex, a cut of which all is split is the block's fine end") {
  const EncodedCase c = simplified_case(faceted_sphere(30, 44), 150, 14, kCoarsePrecision);
  const BlockFile file = opened(c.bytes);
  Arrivals arrivals = opened_arrivals(file);
  BlockViewParameters parameters = view_of_all();
  parameters.by_vertex = true;
  arrivals.load_all(parameters);
  std::size_t blocks = 0;
  for (const std::uint32_t block : arrivals.mesh.impl().cut) {
    const ResidentBlockPtr resident = arrivals.mesh.resident(BlockId{block});
    const BlockHierarchyPtr hierarchy = arrivals.mesh.hierarchy(BlockId{block});
    const BlockHierarchy::Data& data = hierarchy->data();
    ActiveCut cut(data.hierarchy);
    for (std::uint32_t slot = 0; slot < cut.vertices().size();) {
      cut.vertices()[slot].split == kNoSplit ? void(++slot) : void(cut.split(slot));
    }
    CHECK(cut.triangle_count() == data.roots_of_triangle.size());
    blocks += data.node_of_root.size() < data.leaf_of_vertex.size();
    // As the mesh by block has it, with nothing else shown.
    const Grid& grid = file.facts().grid;
    const auto place = [&grid](const Vec3d& p) { return draw_position(grid, grid.nearest(p)); };
    TriangleBag fine;
    for (const BlockGroup& group : resident->groups()) {
      add_drawn(resident->draw_list(), {group.sn, group.fn, group.nsn}, fine);
    }
    CHECK((drawn_of_mesh(extract_cut(cut), place) == fine));
  }
  CHECK(blocks > 3);
}

// Payloads that decode to something else than was written; what is shown is nonsense then, and that
// is all.
TEST_CASE("by vertex, blocks that lie are shown or refused") {
  const EncodedCase c = simplified_case(city_blocks(3, 2), 60, 12, kCoarsePrecision);
  const BlockFile file = opened(c.bytes);
  std::mt19937_64 random(9);
  std::size_t lies = 0;
  for (int trial = 0; trial < (kSanitized ? 40 : 150); ++trial) {
    Result<BlockMesh> mesh = BlockMesh::open(file);
    REQUIRE(mesh.ok());
    Result<DirectoryPage> page = file.read_page(0);
    REQUIRE(page.ok());
    std::vector<std::vector<std::byte>> payloads;
    for (BlockEntry& entry : page->blocks) {
      payloads.push_back(*file.read_block(entry));
      if (random() % 2) payloads.back()[random() % payloads.back().size()] ^= std::byte{32};
      entry.checksum = payload_checksum(payloads.back());
    }
    REQUIRE(mesh->add_page(*page).ok());
    for (std::size_t b = 0; b < payloads.size(); ++b) {
      const std::optional<BlockDecodeJob> job = mesh->decode_job(BlockId{std::uint32_t(b)});
      if (!job) continue;
      const Result<ResidentBlockPtr> block = job->run(payloads[b]);
      if (block.ok()) mesh->insert(*block);
    }
    for (int view = 0; view < 4; ++view) {
      const BlockViewParameters parameters = random_vertex_view(c.mesh, random);
      for (int round = 0; round < 3; ++round) {
        mesh->update(parameters);
        for (const BlockId id : std::vector<BlockId>(mesh->missing_hierarchies().begin(),
                                                     mesh->missing_hierarchies().end())) {
          mesh->insert(mesh->hierarchy_job(id)->run());
        }
      }
      lies += mesh->resident_count();
      CHECK(mesh->extract().triangle_count() == mesh->triangle_count());
    }
  }
  CHECK(lies > 0);
}

TEST_CASE("by vertex, real models are one cut") {
  if (kSanitized) return;
  std::uint64_t seed = 300;
  for (const char* name : {"city/delft_36k.obj.zst", "attributes/corset.glb", "cad/fandisk.off"}) {
    const std::filesystem::path path = shared_model(name);
    if (path.empty() || !std::filesystem::exists(path)) continue;
    Result<Imported> imported = import_mesh(path, {});
    REQUIRE(imported.ok());
    INFO(name);
    const EncodedCase c = simplified_case(std::move(imported->mesh), 4000, 14, kCoarsePrecision);
    const BlockFile file = opened(c.bytes);
    Arrivals arrivals = opened_arrivals(file);
    std::mt19937_64 random(++seed);
    for (int trial = 0; trial < 3; ++trial) {
      const BlockViewParameters parameters = random_vertex_view(c.mesh, random);
      arrivals.load_all(parameters);
      check_by_vertex(arrivals.mesh);
      check_nothing_is_wrong(arrivals.mesh, parameters.view);
    }
  }
}

}  // namespace
}  // namespace crease
