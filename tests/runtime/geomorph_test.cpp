// Geomorphs: nothing is seen to jump, everything goes straight to its own place, and in the end the
// arrays are those without.
#include "crease/adaptive_mesh.h"
#include "hierarchy/grid_sum.h"
#include "pipeline/hierarchy_case.h"
#include "runtime/cut_drawing.h"
#include "runtime/draw_values.h"
#include "runtime/geomorphs.h"
#include "runtime/random_camera.h"
#include "runtime/refiner.h"
#include "runtime/renderer_copy.h"
#include "runtime/seen_triangles.h"
#include "support/mesh_zoo.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <random>

namespace crease {
namespace {

constexpr double kSeconds = 0.25;

ViewParameters view_all_round(const MeshHierarchy& h, std::mt19937_64& random) {
  ViewParameters view;
  view.camera = random_camera(h, random);
  view.coarse_outside = false;
  view.hysteresis = 1;
  return view;
}

// One move: a view, or the same error everywhere.
struct Move {
  ViewParameters view;
  float error = -1;
  bool is_view = true;
};

Move random_move(const MeshHierarchy& h, std::mt19937_64& random) {
  Move move;
  move.view = view_all_round(h, random);
  move.is_view = random() % 3 != 0;
  move.error = random() % 3 == 0 ? -1 : float(std::exp(double(random() % 10) - 9));
  return move;
}

UpdateReport move_to(AdaptiveMesh& mesh, const Move& move, double seconds) {
  return move.is_view ? mesh.update(move.view, seconds) : mesh.set_error(move.error, seconds);
}

std::shared_ptr<const MeshHierarchy> shared_hierarchy(const HierarchyCase& c) {
  return std::make_shared<const MeshHierarchy>(c.hierarchy);
}

void settle(AdaptiveMesh& mesh, const Move& move, RendererCopy& copy) {
  std::size_t steps = 0;
  while (move_to(mesh, move, kSeconds).moving > 0) {
    copy.fetch(mesh.draw_list(), mesh.changes());
    REQUIRE(++steps < 1000);
  }
  copy.fetch(mesh.draw_list(), mesh.changes());
}

void check_walk(const HierarchyCase& c, int move_count, std::uint64_t seed) {
  AdaptiveMesh mesh(shared_hierarchy(c)), plain(shared_hierarchy(c));
  mesh.set_geomorph_seconds(kSeconds);
  RendererCopy copy(mesh.draw_list());
  std::mt19937_64 random(seed);
  const bool with_normals = c.hierarchy.vertices.deriving_splits.empty() &&
                            std::any_of(c.hierarchy.layers.begin(), c.hierarchy.layers.end(),
                                        [](const AttributeHierarchy& layer) {
                                          return layer.role == AttributeRole::Normal;
                                        });
  for (int i = 0; i < move_count; ++i) {
    CAPTURE(i);
    const Move move = random_move(c.hierarchy, random);
    const std::vector<SeenTriangle> before = seen(mesh.draw_list(), with_normals);
    move_to(mesh, move, 0);
    REQUIRE((seen(mesh.draw_list(), with_normals) == before));
    copy.fetch(mesh.draw_list(), mesh.changes());
    const int steps = int(random() % 4);
    for (int k = 0; k < steps; ++k) {
      move_to(mesh, move, kSeconds * double(random() % 100) / 200);
      copy.fetch(mesh.draw_list(), mesh.changes());
      const std::string different = copy.difference(mesh.draw_list());
      REQUIRE_MESSAGE(different.empty(), different);
    }
    move_to(plain, move, 0);
    if (random() % 2 == 0) continue;
    settle(mesh, move, copy);
    REQUIRE(copy.difference(mesh.draw_list()).empty());
    REQUIRE(shown_triangles(mesh.draw_list()) == shown_triangles(plain.draw_list()));
    REQUIRE(mesh.draw_list().fn.triangle_count() == plain.draw_list().fn.triangle_count());
  }
}

TEST_CASE("no move is seen when it is made, and in the end all is as without geomorphs") {
  for (std::uint64_t seed = 0; seed < (kSanitized ? 10 : 60); ++seed) {
    CAPTURE(seed);
    const double derive_share = seed % 4 == 0 ? 0.2 : 0;
    check_walk(
        random_case(random_complex(seed, 24, 80), {.seed = seed, .derive_share = derive_share}), 30,
        seed);
  }
  for (const ZooMesh& z : mesh_zoo()) {
    if (z.mesh.triangle_count() > (kSanitized ? 200 : 3000)) continue;
    CAPTURE(z.name);
    check_walk(simplified_case(z.mesh), 20, 3);
    check_walk(random_case(z.mesh, {.seed = 5, .derive_share = 0}), 20, 4);
  }
}

TEST_CASE(
    "a budget that changes while vertices are on their way is kept, and in the end all is told") {
  const HierarchyCase c = simplified_case(smooth_sphere(40, 60));
  for (const bool consistent : {false, true}) {
    for (const double hysteresis : {0.0, 0.5, 1.0, 1.25}) {
      CAPTURE(consistent);
      CAPTURE(hysteresis);
      AdaptiveMesh mesh(shared_hierarchy(c));
      mesh.set_geomorph_seconds(0.2);
      RendererCopy copy(mesh.draw_list());
      std::mt19937_64 random(7);
      Move move;
      move.view.camera.position = {3, 3, 3};
      move.view.camera.pixels = 0.1;
      move.view.consistent = consistent;
      move.view.hysteresis = hysteresis;
      for (int frame = 0; frame < (kSanitized ? 100 : 400); ++frame) {
        move.view.max_triangles = random() % c.mesh.triangle_count();
        move_to(mesh, move, 0.016);
        copy.fetch(mesh.draw_list(), mesh.changes());
        const std::string different = copy.difference(mesh.draw_list());
        REQUIRE_MESSAGE(different.empty(), different);
      }
      settle(mesh, move, copy);
      CHECK(copy.difference(mesh.draw_list()).empty());
      CHECK(mesh.triangle_count() <= std::max<std::size_t>(move.view.max_triangles, 8));
    }
  }
}

// The parts of an AdaptiveMesh, to look into.
struct Parts {
  explicit Parts(const MeshHierarchy& h) : cut(h), geomorphs(h), refiner(&geomorphs) {
    geomorphs.set_seconds(kSeconds);
    drawing.arrive(cut, geomorphs);
  }
  void update(const ViewParameters& view, double seconds) {
    geomorphs.advance(seconds);
    refiner.update(cut, view);
    geomorphs.mark(cut);
    drawing.arrive(cut, geomorphs);
  }

  ActiveCut cut;
  Geomorphs geomorphs;
  Refiner refiner;
  CutDrawing drawing;
};

TEST_CASE("a vertex that is split in the moment in which it began to leave starts where it stood") {
  const HierarchyCase c = simplified_case(smooth_sphere(12, 16));
  Parts parts(c.hierarchy);
  ActiveCut& cut = parts.cut;
  std::size_t checked = 0;
  for (std::uint32_t slot = 0; slot < cut.vertices().size() && cut.vertices().size() < 200;) {
    const ActiveVertex v = cut.vertices()[slot];
    if (v.node == kNoNode || v.split == kNoSplit) {
      ++slot;
      continue;
    }
    const SplitId above =
        c.hierarchy.vertices.is_root(v.node) ? kNoSplit : c.hierarchy.vertices.split_above(v.node);
    if (above != kNoSplit && cut.can_merge(above) &&
        parts.geomorphs.leave(cut, above, cut.children(above), true)) {
      ++checked;
    }
    const Vec3f stood = draw_position(c.hierarchy.vertices.grid, v.position);
    parts.geomorphs.before_split(cut, slot);
    const std::uint32_t other = cut.split(slot);
    parts.geomorphs.after_split(cut, v.split, slot, other);
    for (const std::uint32_t child : {slot, other}) {
      if (child != kNoSlot) CHECK(parts.geomorphs.position(cut, child) == stood);
    }
    CHECK(parts.geomorphs.leaving_triangles() == 0);
    parts.geomorphs.advance(kSeconds);
  }
  CHECK(checked > 5);
}

// A vertex on its way, as it was when the view changed.
struct Way {
  NodeId node;
  SplitId leaving;
  Vec3f from, to;
};

std::map<std::uint32_t, Way> ways_of(const Parts& parts) {
  const Grid& grid = parts.cut.hierarchy().vertices.grid;
  std::map<std::uint32_t, Way> ways;
  for (std::uint32_t slot = 0; slot < parts.cut.vertices().size(); ++slot) {
    const ActiveVertex& v = parts.cut.vertices()[slot];
    if (v.node == kNoNode || !parts.geomorphs.is_moving(slot)) continue;
    Way way{v.node, parts.geomorphs.leaving(slot), parts.geomorphs.position(parts.cut, slot), {}};
    way.to = draw_position(grid, v.position);
    if (way.leaving != kNoSplit) {  // to where its parent stands
      const Vec3i delta = parts.cut.hierarchy().vertices.delta_of(v.node);
      way.to = draw_position(grid, grid_difference(v.position, delta));
    }
    ways[slot] = way;
  }
  return ways;
}

// Beyond rounding, `at` is between the two, and no nearer to `from` than `before` was.
void check_on_way(const Way& way, const Vec3f& at, float& share) {
  const Vec3f all = way.to - way.from, come = at - way.from;
  const float square = dot(all, all);
  if (square == 0) return;
  const float now = dot(come, all) / square;
  const float size = length(way.to) + length(way.from);
  REQUIRE(length(come - all * now) <= 1e-5f * size);
  REQUIRE(now >= share - 1e-4f);
  REQUIRE(now <= 1 + 1e-4f);
  share = now;
}

TEST_CASE(
    "vertices go straight from where they were seen to their own place, or to their parent's") {
  for (std::uint64_t seed = 0; seed < (kSanitized ? 5 : 30); ++seed) {
    CAPTURE(seed);
    const HierarchyCase c = random_case(random_complex(seed, 24, 80), {.seed = seed});
    Parts parts(c.hierarchy);
    std::mt19937_64 random(seed);
    for (int i = 0; i < 20; ++i) {
      const ViewParameters view = view_all_round(c.hierarchy, random);
      parts.update(view, 0);
      const std::map<std::uint32_t, Way> ways = ways_of(parts);
      std::map<std::uint32_t, float> shares;
      const double step = kSeconds * double(1 + random() % 9) / 20;
      for (double time = step; time < kSeconds; time += step) {
        parts.update(view, step);
        for (const auto& [slot, way] : ways) {
          if (parts.cut.vertices()[slot].node != way.node) continue;  // came early and went on
          if (parts.geomorphs.leaving(slot) != way.leaving) continue;
          check_on_way(way, parts.geomorphs.position(parts.cut, slot), shares[slot]);
        }
      }
      parts.update(view, kSeconds);
      for (const auto& [slot, way] : ways) {  // all of them have arrived
        if (way.leaving == kNoSplit) continue;
        CHECK(!parts.cut.can_merge(way.leaving));
      }
    }
  }
}

TEST_CASE("a budget of triangles holds while it stays the same") {
  const HierarchyCase c = simplified_case(smooth_sphere(40, 60));
  AdaptiveMesh mesh(shared_hierarchy(c));
  mesh.set_geomorph_seconds(kSeconds);
  std::mt19937_64 random(3);
  ViewParameters view = view_all_round(c.hierarchy, random);
  std::size_t merges = 0;
  int most = 0;
  for (int i = 0; i < 20; ++i) {
    const Vec3d position = view_all_round(c.hierarchy, random).camera.position;
    view.camera.position = position;
    view.camera.pixels = 0.01;
    view.max_triangles = 300;
    for (int k = 0; k < 200; ++k) {
      const UpdateReport report = mesh.update(view, kSeconds / 3);
      merges += report.merges;
      CHECK(mesh.triangle_count() <= 300);
      if (report.moving == 0 && report.complete) {
        most = std::max(most, k);
        break;
      }
      REQUIRE(k < 199);
    }
    CHECK(mesh.triangle_count() > 280);
  }
  CHECK(merges > 0);
  CHECK(most <= 30);  // 9; 90 where each exchange waits for the one before
}

}  // namespace
}  // namespace crease
