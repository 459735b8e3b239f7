// The mesh by block against the definition: what is shown is the model of the refined blocks,
// whatever came in which order, was dropped, and came again.
#include "runtime/block_mesh_oracle.h"
#include "runtime/shown_surface.h"
#include "support/described_mesh.h"
#include "support/mesh_zoo.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <limits>
#include <random>

namespace crease {
namespace {

BlockMesh opened_mesh(const BlockFile& file) {
  Result<BlockMesh> mesh = BlockMesh::open(file);
  REQUIRE_MESSAGE(mesh.ok(), (mesh.ok() ? "" : mesh.failure().message));
  while (const std::optional<std::uint32_t> page = mesh->next_page()) {
    const Result<DirectoryPage> read = file.read_page(*page);
    REQUIRE(read.ok());
    REQUIRE(mesh->add_page(*read).ok());
  }
  Result<std::vector<std::string>> names = file.read_parts();
  REQUIRE(names.ok());
  mesh->set_part_names(*std::move(names));
  return *std::move(mesh);
}

std::vector<BlockEntry> all_entries(const BlockFile& file) {
  std::vector<BlockEntry> all;
  for (std::uint32_t p = 0; p < file.page_count(); ++p) {
    const Result<DirectoryPage> page = file.read_page(p);
    REQUIRE(page.ok());
    all.insert(all.end(), page->blocks.begin(), page->blocks.end());
  }
  return all;
}

ResidentBlockPtr loaded(const BlockFile& file, const BlockMesh& mesh, const BlockEntry& entry) {
  const std::optional<BlockDecodeJob> job = mesh.decode_job(entry.id);
  REQUIRE(job.has_value());
  const Result<std::vector<std::byte>> payload = file.read_block(entry);
  REQUIRE(payload.ok());
  Result<ResidentBlockPtr> block = job->run(*payload);
  REQUIRE_MESSAGE(block.ok(), (block.ok() ? "" : block.failure().message));
  CHECK((*block)->bytes() <= mesh.bytes_of(entry.facts));
  return *std::move(block);
}

void check_arrivals(const EncodedCase& c, std::uint64_t seed) {
  const BlockFile file = opened(c.bytes);
  BlockMesh mesh = opened_mesh(file);
  CHECK(mesh.shown().empty());
  std::mt19937_64 random(seed);
  BlockSet resident;
  for (;;) {
    const BlockUpdate report = mesh.update(view_of_all());
    CHECK(report.dropped.empty());
    if (random() % 3 == 0 || mesh.missing().empty()) {
      if (resident.contains(BlockId{0})) check_shown(file, mesh, resident);
    }
    std::vector<BlockEntry> able;
    for (const BlockEntry& entry : mesh.missing()) {
      if (mesh.decode_job(entry.id)) able.push_back(entry);
    }
    if (able.empty()) break;
    const BlockEntry& next = able[random() % able.size()];
    mesh.insert(loaded(file, mesh, next));
    resident.insert(next.id);
  }
  // All but what is not wrong at its coarse end.
  CHECK(mesh.missing().empty());
  CHECK((resident == wanted_blocks(file, view_of_all().view)));
  CHECK(mesh.resident_count() == resident.size());
  CHECK(mesh.error().surface == 0);
}

void load_all_missing(const BlockFile& file, BlockMesh& mesh,
                      const BlockViewParameters& parameters) {
  mesh.update(parameters);
  while (!mesh.missing().empty()) {
    const std::vector<BlockEntry> missing(mesh.missing().begin(), mesh.missing().end());
    for (const BlockEntry& entry : missing) mesh.insert(loaded(file, mesh, entry));
    mesh.update(parameters);
  }
}

void check_views(const EncodedCase& c, std::uint64_t seed) {
  if (c.mesh.vertex_count() == 0) return;
  const BlockFile file = opened(c.bytes);
  BlockMesh mesh = opened_mesh(file);
  std::mt19937_64 random(seed);
  for (int trial = 0; trial < (kSanitized ? 3 : 10); ++trial) {
    const BlockViewParameters parameters = random_view(c.mesh, random);
    load_all_missing(file, mesh, parameters);
    check_shown(file, mesh, wanted_blocks(file, parameters.view));
    CHECK(mesh.update(parameters).evaluated == 0);
  }
}

// What is resident never takes more than the budget, and whatever was dropped, the cut is one.
void check_budget(const EncodedCase& c, std::uint64_t seed) {
  if (c.mesh.vertex_count() == 0) return;
  const BlockFile file = opened(c.bytes);
  BlockMesh mesh = opened_mesh(file);
  std::mt19937_64 random(seed);
  std::size_t all = 0;
  const std::vector<BlockEntry> entries = all_entries(file);
  for (const BlockEntry& entry : entries) all += mesh.bytes_of(entry.facts);
  BlockSet resident;
  for (int trial = 0; trial < (kSanitized ? 4 : 20); ++trial) {
    BlockViewParameters parameters = random_view(c.mesh, random);
    parameters.max_bytes = mesh.bytes_of(entries[0].facts) + all * (random() % 60) / 100;
    const auto update = [&] {
      for (const BlockId id : mesh.update(parameters).dropped) {
        CHECK(resident.erase(id) == 1);
        CHECK(!mesh.is_resident(id));
      }
    };
    update();
    for (std::size_t steps = random() % 8 + 1; steps > 0 && !mesh.missing().empty(); --steps) {
      const BlockEntry next = mesh.missing().front();
      mesh.insert(loaded(file, mesh, next));
      resident.insert(next.id);
      update();
      CHECK(mesh.resident_bytes() <= parameters.max_bytes);
    }
    if (!resident.contains(BlockId{0})) continue;
    const BlockSet wanted = wanted_blocks(file, parameters.view);
    for (const ShownRange& range : mesh.shown()) CHECK(wanted.contains(range.block->id()));
    const BlockSet refined = refined_blocks(file, mesh);
    check_shown(file, mesh, refined);
  }
}

TEST_CASE("whatever blocks have come, what is shown is their model") {
  std::uint64_t seed = 0;
  for (const ZooMesh& zoo : mesh_zoo()) {
    INFO(zoo.name);
    check_arrivals(simplified_case(zoo.mesh, 100, 14, kCoarsePrecision), ++seed);
  }
}

TEST_CASE("a view gets the blocks that are seen to be wrong, and what they need") {
  std::uint64_t seed = 0;
  for (const ZooMesh& zoo : mesh_zoo()) {
    INFO(zoo.name);
    check_views(simplified_case(zoo.mesh, 100, 14, kCoarsePrecision), ++seed);
  }
}

TEST_CASE("a budget is kept, and blocks that were dropped come again") {
  std::uint64_t seed = 0;
  for (const ZooMesh& zoo : mesh_zoo()) {
    INFO(zoo.name);
    check_budget(simplified_case(zoo.mesh, 100, 14, kCoarsePrecision), ++seed);
  }
}

TEST_CASE("the most visible errors come first, and triangles are a budget too") {
  const EncodedCase c = simplified_case(smooth_sphere(60, 90), 300, 14, kCoarsePrecision);
  const BlockFile file = opened(c.bytes);
  BlockMesh mesh = opened_mesh(file);
  BlockViewParameters parameters = view_of_all();
  parameters.view.max_triangles = c.mesh.triangle_count() / 3;
  load_all_missing(file, mesh, parameters);
  CHECK(mesh.triangle_count() <= parameters.view.max_triangles);
  CHECK(mesh.triangle_count() > parameters.view.max_triangles / 2);
  const float limited = mesh.error().surface;
  parameters.view.max_triangles = c.mesh.triangle_count();
  load_all_missing(file, mesh, parameters);
  CHECK(mesh.triangle_count() == c.mesh.triangle_count());
  CHECK(mesh.error().surface == 0);
  CHECK(limited > 0);
}

TEST_CASE("a block stays refined until its error is smaller by the hysteresis") {
  const EncodedCase c = simplified_case(smooth_sphere(60, 90), 300, 14, kCoarsePrecision);
  const BlockFile file = opened(c.bytes);
  BlockViewParameters parameters = view_of_all();
  parameters.view.hysteresis = 2;
  const auto fresh = [&](double pixels) {
    BlockMesh mesh = opened_mesh(file);
    parameters.view.camera.pixels = pixels;
    load_all_missing(file, mesh, parameters);
    return mesh;
  };
  double pixels = 8;
  const std::size_t fine = fresh(pixels).triangle_count();
  while (fresh(1.1 * pixels).triangle_count() == fine) pixels *= 1.1;
  BlockMesh mesh = fresh(pixels);
  CHECK(mesh.triangle_count() == fine);
  parameters.view.camera.pixels = 1.1 * pixels;
  mesh.update(parameters);
  CHECK(mesh.triangle_count() == fine);
  parameters.view.camera.pixels = 10 * pixels;
  CHECK(mesh.update(parameters).coarsened > 0);
  CHECK(mesh.triangle_count() < fine);
}

TEST_CASE("pages and payloads that are not the next ones are refused") {
  const EncodedCase c = simplified_case(smooth_sphere(12, 16), 100, 14, kCoarsePrecision);
  const BlockFile file = opened(c.bytes);
  Result<BlockMesh> mesh = BlockMesh::open(file);
  REQUIRE(mesh.ok());
  Result<DirectoryPage> page = file.read_page(0);
  REQUIRE(page.ok());
  DirectoryPage later = *page;
  later.first = BlockId{kBlocksPerPage};
  CHECK(!mesh->add_page(later).ok());
  // One that goes wrong at its end leaves nothing behind: the next update() has no block to look
  // at.
  DirectoryPage wrong = *page;
  wrong.blocks.back().facts.patch += 1;
  CHECK(!mesh->add_page(wrong).ok());
  CHECK(mesh->update(view_of_all()).evaluated == 0);
  REQUIRE(mesh->add_page(*page).ok());
  CHECK(!mesh->next_page());
  const BlockId last = page->blocks.back().id;
  REQUIRE(!page->dependencies_of(last).empty());
  CHECK(!mesh->decode_job(last));  // without what it needs
  const std::optional<BlockDecodeJob> job = mesh->decode_job(BlockId{0});
  REQUIRE(job.has_value());
  Result<std::vector<std::byte>> payload = file.read_block(page->blocks[0]);
  REQUIRE(payload.ok());
  (*payload)[0] ^= std::byte{1};
  const Result<ResidentBlockPtr> block = job->run(*payload);
  REQUIRE(!block.ok());
  CHECK(block.failure().error == Error::BadChecksum);
  CHECK(block.failure().message.find("block 0") != std::string::npos);
}

// A model that says so in its floats, which no checksum forbids.
TEST_CASE("a block with a value that is not finite is refused") {
  Mesh mesh = smooth_sphere(4, 6);
  mesh.layers[0].values[4] = std::numeric_limits<float>::infinity();
  const EncodedCase c = simplified_case(std::move(mesh), 100, 14, kExactPrecision);
  const BlockFile file = opened(c.bytes);
  BlockMesh blocks = opened_mesh(file);
  std::size_t refused = 0;
  for (const BlockEntry& entry : all_entries(file)) {
    const std::optional<BlockDecodeJob> job = blocks.decode_job(entry.id);
    if (!job) continue;
    const Result<ResidentBlockPtr> block = job->run(*file.read_block(entry));
    if (block.ok()) {
      blocks.insert(*block);
      continue;
    }
    ++refused;
    CHECK(block.failure().message == "block " + std::to_string(index_of(entry.id)) +
                                         ": a value of an attribute is not finite");
  }
  CHECK(refused > 0);
  CHECK(!decode_model(file).ok());
}

TEST_CASE("edges are open at the borders of a model and nowhere else, whatever is refined") {
  for (const bool is_closed : {true, false}) {
    const EncodedCase c = simplified_case(is_closed ? smooth_sphere(30, 40) : height_field(24), 200,
                                          14, kCoarsePrecision);
    const BlockFile file = opened(c.bytes);
    const std::vector<std::uint64_t> checksums = *drawn_checksums(file);
    BlockMesh mesh = opened_mesh(file);
    std::mt19937_64 random(6);
    for (int trial = 0; trial < 6; ++trial) {
      load_all_missing(file, mesh, random_view(c.mesh, random));
      CHECK((open_edges(mesh) == 0) == is_closed);
      CHECK(wrong_blocks(mesh, checksums) == 0);
    }
    std::vector<std::uint64_t> others = checksums;
    for (std::uint64_t& other : others) other ^= 1;
    CHECK(wrong_blocks(mesh, others) > 0);
  }
}

}  // namespace
}  // namespace crease
