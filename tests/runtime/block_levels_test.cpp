// Blocks between their ends, against the definition: whatever has come, what is shown is one cut,
// and right within what the view allows.
#include "crease/block_streamer.h"
#include "crease/block_view.h"
#include "runtime/block_mesh_impl.h"
#include "runtime/block_mesh_oracle.h"
#include "runtime/block_vertices_oracle.h"
#include "runtime/shown_surface.h"
#include "support/mesh_zoo.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <vector>

namespace crease {
namespace {

void load_block(const BlockFile& file, BlockMesh& mesh, const BlockEntry& entry) {
  const std::optional<BlockDecodeJob> job = mesh.decode_job(entry.id);
  if (job) mesh.insert(*job->run(*file.read_block(entry)));
}

void make_levels(BlockMesh& mesh, BlockId id) {
  const std::optional<BlockLevelsJob> job = mesh.levels_job(id);
  REQUIRE(job.has_value());
  mesh.insert(job->run());
}

// Until nothing is missing.
void load_all(const BlockFile& file, BlockMesh& mesh, const BlockViewParameters& parameters) {
  for (int rounds = 0;; ++rounds) {
    REQUIRE(rounds < 10'000);
    mesh.update(parameters);
    const std::vector<BlockEntry> missing(mesh.missing().begin(), mesh.missing().end());
    for (const BlockEntry& entry : missing) load_block(file, mesh, entry);
    if (!missing.empty()) continue;
    if (mesh.missing_levels().empty()) return;
    make_levels(mesh, mesh.missing_levels().front());
  }
}

BlockViewParameters random_level_view(const Mesh& mesh, std::mt19937_64& random) {
  BlockViewParameters parameters = random_view(mesh, random);
  parameters.in_levels = true;
  parameters.view.degrees = random() % 4 ? 0 : 20;
  return parameters;
}

// Blocks and levels come in any order, some are dropped, the mode changes to and fro.
std::size_t walk(const EncodedCase& c, std::uint64_t seed) {
  const BlockFile file = opened(c.bytes);
  BlockMesh mesh = mesh_of(file);
  std::mt19937_64 random(seed);
  std::size_t between = 0;
  for (int trial = 0; trial < (kSanitized ? 6 : 24); ++trial) {
    BlockViewParameters parameters = random_level_view(c.mesh, random);
    if (random() % 3 == 0) parameters.max_bytes = random() % 600'000;
    parameters.in_levels = random() % 5 != 0;
    for (std::size_t steps = random() % 8 + 1; steps > 0; --steps) {
      mesh.update(parameters);
      const std::vector<BlockEntry> missing(mesh.missing().begin(), mesh.missing().end());
      if (!missing.empty()) load_block(file, mesh, missing[random() % missing.size()]);
      for (const BlockId id :
           std::vector<BlockId>(mesh.missing_levels().begin(), mesh.missing_levels().end())) {
        if (random() % 2) make_levels(mesh, id);
      }
    }
    if (random() % 2) mesh.update(parameters);
    if (!mesh.is_resident(BlockId{0})) continue;
    check_by_vertex(mesh);
    between += mesh.shown_cuts().size();
  }
  return between;
}

TEST_CASE("whatever has come of blocks and levels, what is shown is one cut") {
  std::uint64_t seed = 0;
  std::size_t between = 0;
  for (const ZooMesh& zoo : mesh_zoo()) {
    INFO(zoo.name);
    if (zoo.mesh.vertex_count() == 0) continue;
    between += walk(simplified_case(zoo.mesh, 100, 14, kCoarsePrecision), ++seed);
  }
  CHECK(between > 0);
}

TEST_CASE(
    "between its ends a block is right within what the view allows, and has fewer triangles") {
  const EncodedCase c = simplified_case(smooth_sphere(60, 90), 400, 14, kCoarsePrecision);
  const BlockFile file = opened(c.bytes);
  BlockMesh mesh = mesh_of(file);
  std::mt19937_64 random(5);
  std::size_t between = 0, in_levels = 0, whole = 0;
  for (int trial = 0; trial < (kSanitized ? 4 : 20); ++trial) {
    BlockViewParameters parameters = random_level_view(c.mesh, random);
    load_all(file, mesh, parameters);
    check_by_vertex(mesh);
    between += check_levels_are_right(mesh, parameters.view);
    in_levels += mesh.triangle_count();
    parameters.in_levels = false;
    mesh.update(parameters);
    check_shown(file, mesh, wanted_blocks(file, parameters.view));
    whole += mesh.triangle_count();
  }
  CHECK(between > 0);
  CHECK(in_levels < whole);
}

// Closed and flat, with small spikes here and there.
Mesh spiked_cube() {
  Mesh mesh = smooth_sphere(60, 90);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    Vec3d& p = mesh.positions[v];
    const double spike = v % 97 == 0 ? 1 + 0.0002 * double(v % 50) : 1;
    p = p * (spike / std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}));
  }
  return mesh;
}

// Inner splits that are undone in what is shown.
std::size_t undone_inner_splits(const BlockMesh& mesh) {
  const BlockMesh::Impl& impl = mesh.impl();
  std::size_t count = 0;
  for (const std::uint32_t block : impl.cut) {
    const LevelList* const list = impl.levels.list(block);
    if (list == nullptr) continue;
    std::vector<ResidentBlockPtr> needed;
    for (const std::uint32_t n : impl.graph.dependencies(block)) {
      needed.push_back(impl.resident[n]);
    }
    const BlockHierarchyPtr hierarchy = make_tall_hierarchy(*impl.resident[block], needed);
    const std::vector<char>& is_inner = hierarchy->data().is_inner;
    for (std::size_t s = 0; s < is_inner.size(); ++s) {
      count += is_inner[s] && (list->done[s / 64] >> (s % 64) & 1) == 0;
    }
  }
  return count;
}

TEST_CASE(
    "where little of a block is wrong, a level may be coarser than its coarse end elsewhere") {
  const EncodedCase c = simplified_case(spiked_cube(), 1500, 14, kCoarsePrecision);
  const BlockFile file = opened(c.bytes);
  BlockMesh mesh = mesh_of(file);
  std::mt19937_64 random(3);
  std::size_t undone = 0;
  for (int trial = 0; trial < (kSanitized ? 4 : 20); ++trial) {
    const BlockViewParameters parameters = random_level_view(c.mesh, random);
    load_all(file, mesh, parameters);
    check_by_vertex(mesh);
    check_levels_are_right(mesh, parameters.view);
    CHECK(open_edges(mesh) == 0);
    undone += undone_inner_splits(mesh);
  }
  CHECK(undone > 0);
}

TEST_CASE("groups of a level's list are all of it, and those beside a view are left out") {
  const EncodedCase c = simplified_case(smooth_sphere(60, 90), 800, 14, kCoarsePrecision);
  const BlockFile file = opened(c.bytes);
  BlockMesh mesh = mesh_of(file);
  std::mt19937_64 random(9);
  std::size_t left_out = 0, lists = 0;
  for (int trial = 0; trial < (kSanitized ? 3 : 12); ++trial) {
    BlockViewParameters parameters = random_level_view(c.mesh, random);
    load_all(file, mesh, parameters);
    for (const ShownCut& cut : mesh.shown_cuts()) {
      ++lists;
      const auto all = shown_groups(cut, [](const BlockGroup&) { return true; });
      REQUIRE(all.size() == 1);
      CHECK(all[0].triangle_count() == cut.triangle_count());
      std::size_t seen = 0;
      for (const ShownRange& range : shown_in_view(cut, parameters.view.camera)) {
        seen += range.triangle_count();
      }
      CHECK(seen <= cut.triangle_count());
      left_out += cut.triangle_count() - seen;
    }
  }
  CHECK(lists > 0);
  CHECK(left_out > 0);
}

// The level that a block wants by the definition, one level and one piece after the other.
class LevelByDefinition {
 public:
  LevelByDefinition(const BlockMesh& mesh, const ViewParameters& view)
      : impl_(mesh.impl()),
        error_(view, mesh.facts().grid),
        keep_(static_cast<float>(1 / std::max(view.hysteresis, 1.0))) {}

  // Coarser than before where nothing there is wrong by what is kept, finer where something is. The
  // coarse end comes first: inner splits are done there.
  int level(std::uint32_t block, int before) const {
    const std::span<const std::uint32_t> finer = impl_.graph.dependents(block);
    if (std::any_of(finer.begin(), finer.end(),
                    [this](std::uint32_t f) { return impl_.levels.shown(f) > 0; })) {
      return kFullLevel;
    }
    const LevelFactsPtr facts = impl_.levels.facts(block);
    if (!facts || facts->of_root.empty() || impl_.graph.is_base(block)) return kFullLevel;
    if (!is_wrong(block, *facts, 0, before > 0 ? keep_ : 1)) return 0;
    int level = std::max(before, 1);
    while (level > 1 && !is_wrong(block, *facts, level - 1, keep_)) --level;
    if (level < before) return level;
    while (level < kFullLevel && is_wrong(block, *facts, level, 1)) ++level;
    return level;
  }

 private:
  bool is_sphere_wrong(const RoundedError& left, RoundedUp radius, const Vec3f& center,
                       float limit) const {
    SplitBounds bounds;
    set_error(bounds, left);
    bounds.radius = radius;
    return error_.is_wrong(error_.watch(bounds, center, limit));
  }
  bool is_wrong(std::uint32_t block, const LevelFacts& facts, int level, float limit) const {
    const BlockBounds& own = impl_.graph.own(block);
    const RoundedError left = RoundedError::from(facts.left[std::size_t(level)]);
    return is_sphere_wrong(left, own.bounds.radius, own.center, limit) &&
           is_piece_wrong(facts, 0, level, limit);
  }
  // It is, and so is one of its parts, if it has any.
  bool is_piece_wrong(const LevelFacts& facts, std::size_t i, int level, float limit) const {
    const LevelSphere& piece = facts.pieces[i];
    const std::size_t at = std::size_t(level) * facts.pieces.size() + i;
    const RoundedError left{facts.left_in_piece.off[at], {}, facts.left_in_piece.degrees[at], {}};
    if (!is_sphere_wrong(left, piece.radius, piece.center, limit)) return false;
    bool any = piece.next == i + 1;
    for (std::size_t part = i + 1; part < piece.next && !any; part = facts.pieces[part].next) {
      any = is_piece_wrong(facts, part, level, limit);
    }
    return any;
  }

  const BlockMesh::Impl& impl_;
  ViewError error_;
  float keep_;
};

// By the levels of before. How many blocks are not shown whole.
std::size_t check_levels_by_definition(const BlockMesh& mesh, const ViewParameters& view,
                                       std::span<const int> before) {
  const LevelByDefinition definition(mesh, view);
  std::size_t different = 0, between = 0;
  for (const std::uint32_t block : mesh.impl().cut) {
    const int wanted = mesh.impl().levels.wanted(block);
    different += wanted != definition.level(block, before[block]);
    between += wanted < kFullLevel;
  }
  CHECK(different == 0);
  return between;
}

TEST_CASE("each block wants the level that the definition says, from frame to frame") {
  const EncodedCase c = simplified_case(smooth_sphere(60, 90), 400, 14, kCoarsePrecision);
  const BlockFile file = opened(c.bytes);
  BlockMesh mesh = mesh_of(file);
  std::mt19937_64 random(11);
  std::size_t between = 0;
  for (int trial = 0; trial < (kSanitized ? 4 : 16); ++trial) {
    BlockViewParameters parameters = random_level_view(c.mesh, random);
    parameters.view.hysteresis = random() % 2 ? 1.25 : 2;
    parameters.view.silhouette_weight = random() % 3 ? 1 : 3;
    load_all(file, mesh, parameters);
    for (int frame = 0; frame < 20; ++frame) {
      std::vector<int> before;
      for (std::uint32_t b = 0; b < file.block_count(); ++b) {
        before.push_back(mesh.impl().levels.chosen(b));
      }
      parameters.view.camera.pixels *= random() % 2 ? 1.1 : 1 / 1.3;
      parameters.view.camera.position.x += 0.01 * double(random() % 5);
      mesh.update(parameters);
      between += check_levels_by_definition(mesh, parameters.view, before);
    }
  }
  CHECK(between > 0);
}

// The same, where jobs begin together and end in any order, and blocks bring levels along that
// another mesh has of them.
void load_all_at_random(const BlockFile& file, BlockMesh& mesh, const BlockMesh& other,
                        const BlockViewParameters& parameters, std::mt19937_64& random) {
  std::vector<BlockLevelsPtr> made;
  for (int rounds = 0;; ++rounds) {
    REQUIRE(rounds < 10'000);
    mesh.update(parameters);
    const std::vector<BlockEntry> missing(mesh.missing().begin(), mesh.missing().end());
    for (const BlockEntry& entry : missing) {
      load_block(file, mesh, entry);
      const bool is_base = mesh.impl().graph.is_base(std::uint32_t(index_of(entry.id)));
      if (is_base || !mesh.is_resident(entry.id) || random() % 2) continue;
      if (const auto job = other.levels_job(entry.id)) mesh.insert(job->run());
    }
    for (const BlockId id : mesh.missing_levels()) {
      if (made.size() < 8 && random() % 3 == 0) made.push_back(mesh.levels_job(id)->run());
    }
    std::shuffle(made.begin(), made.end(), random);
    for (std::size_t count = random() % 4; count > 0 && !made.empty(); --count) {
      mesh.insert(std::move(made.back()));
      made.pop_back();
    }
    if (missing.empty() && mesh.missing_levels().empty() && made.empty()) return;
  }
}

void check_levels_are_equal(const LevelChoice& a, const LevelChoice& b, std::uint32_t block) {
  CHECK(a.shown(block) == b.shown(block));
  const LevelFactsPtr facts_a = a.facts(block), facts_b = b.facts(block);
  REQUIRE((facts_a == nullptr) == (facts_b == nullptr));
  if (facts_a) {
    CHECK(facts_a->of_root == facts_b->of_root);
    CHECK(facts_a->left_in_piece.off == facts_b->left_in_piece.off);
    CHECK(facts_a->left_in_piece.degrees == facts_b->left_in_piece.degrees);
  }
  REQUIRE((a.list(block) == nullptr) == (b.list(block) == nullptr));
  if (a.list(block) != nullptr) CHECK(a.list(block)->done == b.list(block)->done);
}

TEST_CASE("what is shown of a view in the end does not depend on what came when") {
  const EncodedCase c = simplified_case(spiked_cube(), 400, 14, kCoarsePrecision);
  const BlockFile file = opened(c.bytes);
  std::mt19937_64 random(13);
  std::size_t between = 0;
  for (int trial = 0; trial < (kSanitized ? 2 : 20); ++trial) {
    BlockViewParameters parameters = random_level_view(c.mesh, random);
    parameters.view.hysteresis = 2;
    BlockMesh one = mesh_of(file), other = mesh_of(file);
    load_all(file, one, parameters);
    load_all_at_random(file, other, one, parameters, random);
    REQUIRE(one.impl().cut == other.impl().cut);
    for (const std::uint32_t block : one.impl().cut) {
      check_levels_are_equal(one.impl().levels, other.impl().levels, block);
    }
    between += one.shown_cuts().size();
  }
  CHECK(between > 0);
}

TEST_CASE("a streamer makes levels beside the frames" * doctest::test_suite("threads")) {
  const EncodedCase c = simplified_case(smooth_sphere(60, 90), 400, 14, kCoarsePrecision);
  std::mt19937_64 random(5);
  for (const int threads : {0, 2}) {
    Result<BlockStreamer> streamer =
        BlockStreamer::open(async_memory_source(c.bytes), {.decode_threads = threads});
    REQUIRE(streamer.ok());
    std::size_t between = 0;
    for (int trial = 0; trial < (kSanitized ? 3 : 10); ++trial) {
      const BlockViewParameters parameters = random_level_view(c.mesh, random);
      for (int frames = 0;
           !streamer->update(parameters).is_complete || !streamer->mesh().missing_levels().empty();
           ++frames) {
        REQUIRE(frames < 100'000);
        if (frames % 8 == 0 && !streamer->mesh().shown().empty()) check_by_vertex(streamer->mesh());
        streamer->wait(std::chrono::milliseconds(20));
      }
      check_by_vertex(streamer->mesh());
      between += streamer->mesh().shown_cuts().size();
    }
    CHECK(between > 0);
  }
}

}  // namespace
}  // namespace crease
