// Budgets of triangles, against all cuts that have one error everywhere: none that fits is better.
#include "crease/build_hierarchy.h"
#include "crease/decode_model.h"
#include "runtime/block_mesh_impl.h"
#include "runtime/block_mesh_oracle.h"
#include "runtime/block_vertices_oracle.h"
#include "support/mesh_zoo.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace crease {
namespace {

// One thing that is missing, whichever. False: nothing is.
bool bring(const BlockFile& file, BlockMesh& mesh, std::mt19937_64& random) {
  const std::vector<BlockEntry> blocks(mesh.missing().begin(), mesh.missing().end());
  std::vector<BlockId> levels(mesh.missing_levels().begin(), mesh.missing_levels().end());
  std::vector<BlockId> vertices(mesh.missing_hierarchies().begin(),
                                mesh.missing_hierarchies().end());
  const std::size_t all = blocks.size() + levels.size() + vertices.size();
  if (all == 0) return false;
  for (;;) {
    std::size_t i = random() % all;
    if (i < blocks.size()) {
      if (const std::optional<BlockDecodeJob> job = mesh.decode_job(blocks[i].id)) {
        mesh.insert(*job->run(*file.read_block(blocks[i])));
        return true;
      }
      continue;
    }
    i -= blocks.size();
    if (i < levels.size()) {
      mesh.insert(mesh.levels_job(levels[i])->run());
    } else {
      mesh.insert(mesh.hierarchy_job(vertices[i - levels.size()])->run());
    }
    return true;
  }
}

// Until nothing is missing; at no moment are there too many.
void load_all(const BlockFile& file, BlockMesh& mesh, const BlockViewParameters& parameters,
              std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const BlockFacts& base = mesh.impl().graph.entry(0).facts;
  const std::size_t most =
      std::max<std::size_t>(parameters.view.max_triangles, base.triangles_fine);
  for (int rounds = 0;; ++rounds) {
    REQUIRE(rounds < 10'000);
    mesh.update(parameters);
    REQUIRE(mesh.triangle_count() <= most);
    if (!bring(file, mesh, random) && mesh.has_arrived()) return;
  }
}

// Blocks, and what each shows.
std::vector<std::pair<BlockId, std::size_t>> shown(const BlockMesh& mesh) {
  std::vector<std::pair<BlockId, std::size_t>> all;
  for (const ShownRange& range : mesh.shown()) {
    all.emplace_back(range.block->id(), range.triangle_count());
  }
  for (const ShownCut& cut : mesh.shown_cuts()) {
    all.emplace_back(cut.block->id(), cut.triangle_count());
  }
  return all;
}

// How many triangles the blocks have if nothing may be off by more than `error`.
std::int64_t triangles_within(const BlockMesh& mesh, const ViewParameters& view, float error) {
  const BlockGraph& graph = mesh.impl().graph;
  const LevelChoice& levels = mesh.impl().levels;
  const ViewError seen(view, mesh.facts().grid);
  std::vector<char> is_needed(graph.size(), 0);
  std::int64_t triangles = 0;
  for (std::uint32_t block = graph.size(); block-- > 0;) {
    const BlockBounds& own = graph.own(block);
    const bool is_wrong =
        graph.is_base(block) || seen.of(own.bounds, own.center, kNearestRadii) > error;
    int level = is_needed[block] || graph.is_base(block) ? kFullLevel : 0;
    if (level == 0 && is_wrong && !levels.can_choose(block)) level = kFullLevel;
    if (level == 0 && is_wrong && levels.error_at(block, 0, seen) > error) {
      level = 1;
      while (level < kFullLevel && levels.error_at(block, level, seen) > error) ++level;
    }
    if (level == 0) continue;
    const BlockFacts& facts = graph.entry(block).facts;
    triangles += level == kFullLevel ? std::int64_t(graph.more_triangles(block))
                                     : std::int64_t(levels.triangles_at(block, level)) -
                                           std::int64_t(facts.triangles_coarse);
    for (const std::uint32_t needed : graph.dependencies(block)) is_needed[needed] = 1;
  }
  return triangles;
}

// Of all cuts that have one error everywhere and fit, the least.
float best_error(const BlockMesh& mesh, const ViewParameters& view) {
  const BlockGraph& graph = mesh.impl().graph;
  const ViewError seen(view, mesh.facts().grid);
  std::set<float> errors{1};
  for (std::uint32_t block = 1; block < graph.size(); ++block) {
    const BlockBounds& own = graph.own(block);
    errors.insert(seen.of(own.bounds, own.center, kNearestRadii));
    if (!mesh.impl().levels.is_known(block)) continue;  // right at any error
    for (int level = 0; level < kFullLevel && mesh.impl().levels.can_choose(block); ++level) {
      errors.insert(mesh.impl().levels.error_at(block, level, seen));
    }
  }
  for (const float error : errors) {
    if (error < 1) continue;
    if (triangles_within(mesh, view, error) <= std::int64_t(view.max_triangles)) return error;
  }
  return std::numeric_limits<float>::infinity();
}

// Of the blocks that are seen to be wrong as the file tells it, the worst as it is shown; or 1.
float error_shown(const BlockMesh& mesh, const ViewParameters& view) {
  const BlockGraph& graph = mesh.impl().graph;
  const LevelChoice& levels = mesh.impl().levels;
  const ViewError seen(view, mesh.facts().grid);
  float worst = 1;
  for (std::uint32_t block = 1; block < graph.size(); ++block) {
    const BlockBounds& own = graph.own(block);
    const float at_worst = seen.of(own.bounds, own.center, kNearestRadii);
    const int level = levels.shown(block);
    if (at_worst <= 1 || level == kFullLevel) continue;
    const bool has_levels = levels.can_choose(block);
    const float as_shown = has_levels ? levels.error_at(block, level, seen) : at_worst;
    worst = std::max(worst, std::min(as_shown, at_worst));
  }
  return worst;
}

// Some block could show more, and is seen to be wrong.
bool has_room_for_more(const BlockMesh& mesh, const ViewParameters& view) {
  const BlockGraph& graph = mesh.impl().graph;
  const LevelChoice& levels = mesh.impl().levels;
  const ViewError seen(view, mesh.facts().grid);
  for (const std::uint32_t block : mesh.impl().cut) {
    const int level = levels.shown(block);
    if (level == kFullLevel || !levels.can_choose(block)) continue;
    const float error = levels.error_at(block, level, seen);
    if (error <= 1) continue;
    // The next level can be worse, where inner splits are undone.
    if (level + 1 < kFullLevel && levels.error_at(block, level + 1, seen) > error) continue;
    const std::span<const std::uint32_t> needed = graph.dependencies(block);
    const bool can_show = std::all_of(needed.begin(), needed.end(), [&](std::uint32_t n) {
      return levels.shown(n) == kFullLevel;
    });
    if (!can_show) continue;
    const BlockFacts& facts = graph.entry(block).facts;
    const auto triangles = [&](int k) {
      return k == 0           ? facts.triangles_coarse
             : k < kFullLevel ? levels.triangles_at(block, k)
                              : facts.triangles_fine;
    };
    const std::size_t others = mesh.triangle_count() - triangles(level);
    if (others + triangles(level + 1) <= view.max_triangles) return true;
  }
  return false;
}

std::vector<EncodedCase> cases() {
  std::vector<EncodedCase> all;
  for (const Mesh& mesh : {smooth_sphere(40, 60), city_blocks(4, 3), height_field(30)}) {
    all.push_back(simplified_case(mesh, 300, 14, kCoarsePrecision));
  }
  return all;
}

TEST_CASE("by block no cut of one error that has no more triangles is better") {
  std::mt19937_64 random(1);
  int limited = 0;
  for (const EncodedCase& c : cases()) {
    const BlockFile file = opened(c.bytes);
    BlockMesh mesh = mesh_of(file);
    BlockViewParameters everything = view_of_all();
    everything.in_levels = true;
    load_all(file, mesh, everything, 1);
    for (int trial = 0; trial < (kSanitized ? 3 : 12); ++trial) {
      BlockViewParameters parameters = random_view(c.mesh, random);
      parameters.in_levels = true;
      parameters.view.hysteresis = 1;
      parameters.view.max_triangles = 50 + random() % c.mesh.triangle_count();
      // What is not known now is what no view has wanted.
      parameters.view.camera.pixels = 1e-3;
      load_all(file, mesh, parameters, random());
      const float best = best_error(mesh, parameters.view);
      CAPTURE(parameters.view.max_triangles);
      CHECK(error_shown(mesh, parameters.view) <= best * 1.0001f);
      CHECK(error_shown(mesh, parameters.view) <= std::max(1.0f, mesh.view_error()) * 1.0001f);
      CHECK(!has_room_for_more(mesh, parameters.view));
      limited += best > 1;
      check_by_vertex(mesh);
    }
  }
  CHECK(limited > (kSanitized ? 3 : 12));
}

TEST_CASE("of triangles that are allowed few are left, and what came first does not matter") {
  std::mt19937_64 random(2);
  const std::vector<EncodedCase> all = cases();
  const EncodedCase& boxes = all[1];
  for (const EncodedCase& c : all) {
    const BlockFile file = opened(c.bytes);
    for (int trial = 0; trial < (kSanitized ? 1 : 4); ++trial) {
      BlockViewParameters parameters = random_view(c.mesh, random);
      parameters.view.camera.pixels = 1e-3;
      parameters.view.coarse_outside = false;
      for (const bool by_vertex : {false, true}) {
        parameters.by_vertex = by_vertex;
        parameters.in_levels = true;
        parameters.view.max_triangles = c.mesh.triangle_count() / (2 + random() % 8);
        std::vector<std::pair<BlockId, std::size_t>> before;
        for (std::uint64_t seed = 0; seed < 3; ++seed) {
          BlockMesh mesh = mesh_of(file);
          load_all(file, mesh, parameters, random());
          CAPTURE(by_vertex);
          CAPTURE(parameters.view.max_triangles);
          // What has one error splits together: boxes that are alike, and ancestors, whose errors
          // are no less than what is below them.
          if (by_vertex && &c != &boxes) {
            CHECK(10 * mesh.triangle_count() > 8 * parameters.view.max_triangles);
          }
          if (seed > 0) CHECK((shown(mesh) == before));
          before = shown(mesh);
        }
      }
    }
  }
}

// At the end of a search in which all that trials need is always there.
double found_error(ErrorSearch& search, std::size_t most,
                   const std::function<std::size_t(double)>& triangles_at) {
  search.look_anew(most);
  for (int trials = 0; !search.has_ended(); ++trials) {
    REQUIRE(trials < 40);
    double error = search.begin(true);
    while (triangles_at(error) > most) {
      error = ErrorSearch::coarser(error, triangles_at(error), most);
    }
    search.tell(error, triangles_at(error), most, true);
  }
  return search.trial();
}

TEST_CASE("a search ends where there are triangles enough and hardly more") {
  ErrorSearch search;
  for (const std::size_t most : {100, 3000, 40, 90'000, 2'000'000, 500}) {
    CAPTURE(most);
    const auto smooth = [](double error) { return std::size_t(1e6 / std::pow(error, 1.3)); };
    const double error = found_error(search, most, smooth);
    CHECK(smooth(error) <= most);
    CHECK((error == 1 || 20 * smooth(error) > 19 * most));
    const auto leaping = [](double e) { return std::size_t(e < 7 ? 1000 : 10); };
    const double leap = found_error(search, 500, leaping);
    CHECK(leap >= 7);
    CHECK(leap < 7.2);
  }
}

TEST_CASE("by vertex in blocks errors are nearly those of the whole model by vertex") {
  const EncodedCase c = simplified_case(smooth_sphere(60, 90), 300, 14, kCoarsePrecision);
  const BlockFile file = opened(c.bytes);
  const Result<DecodedModel> model = decode_model(file);
  REQUIRE(model.ok());
  const Result<MeshHierarchy> hierarchy = build_hierarchy(model->mesh, model->sequence, {});
  REQUIRE(hierarchy.ok());
  const auto shared = std::make_shared<const MeshHierarchy>(*hierarchy);
  BlockViewParameters parameters = view_of_all();
  parameters.by_vertex = true;
  parameters.view.camera.pixels = 0.01;
  for (const std::size_t triangles : {1000, 3000}) {
    parameters.view.max_triangles = triangles;
    BlockMesh mesh = mesh_of(file);
    load_all(file, mesh, parameters, triangles);
    REQUIRE(mesh.view_error() > 1);
    ViewParameters as_wrong = parameters.view;
    as_wrong.max_triangles = std::numeric_limits<std::size_t>::max();
    as_wrong.camera.pixels *= double(mesh.view_error()) / 2;
    AdaptiveMesh whole(shared);
    whole.update(as_wrong);
    CHECK(whole.triangle_count() > triangles);
    check_by_vertex(mesh);
  }
}

TEST_CASE("a budget is kept while a camera moves, whatever has come") {
  std::mt19937_64 random(3);
  for (const EncodedCase& c : cases()) {
    const BlockFile file = opened(c.bytes);
    for (const bool by_vertex : {false, true}) {
      BlockMesh mesh = mesh_of(file);
      const std::size_t base = mesh.impl().graph.entry(0).facts.triangles_fine;
      for (int frame = 0; frame < (kSanitized ? 20 : 150); ++frame) {
        BlockViewParameters parameters = random_view(c.mesh, random);
        parameters.by_vertex = by_vertex;
        parameters.in_levels = random() % 8 != 0;
        parameters.view.max_triangles = 20 + random() % c.mesh.triangle_count() / 3;
        for (std::size_t updates = random() % 6 + 1; updates > 0; --updates) {
          mesh.update(parameters);
          REQUIRE(mesh.triangle_count() <= std::max(base, parameters.view.max_triangles));
          bring(file, mesh, random);
        }
        if (mesh.is_resident(BlockId{0}) && frame % 8 == 0) {
          mesh.update(parameters);
          check_by_vertex(mesh);
        }
      }
    }
  }
}

}  // namespace
}  // namespace crease
