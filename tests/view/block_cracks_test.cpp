// No light between triangles of different blocks and bands, whatever the cut.
//
// A closed model is drawn without the triangles that face away, so that behind a gap there is
// nothing: a sample that stays empty. Where it looks at the model is told by the picture with all
// triangles, well away from its outline.
#include "crease/build.h"
#include "render/gl_blocks.h"
#include "render/gl_context.h"
#include "render/gl_cuts.h"
#include "render/gl_target.h"
#include "support/mesh_zoo.h"
#include "support/sanitized.h"
#include "view/streamed_model.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace crease {

namespace {

constexpr int kSide = 200;
constexpr int kViews = kSanitized ? 5 : 25;

double number(std::mt19937& random) {
  return double(random()) / 4294967296.0 * 2 - 1;
}

Vec3d direction(std::mt19937& random) {
  for (;;) {
    const Vec3d v{number(random), number(random), number(random)};
    if (length(v) > 0.1 && length(v) < 1) return normalized(v);
  }
}

Camera camera_from(const StreamedModel& model, const Vec3d& towards, double distance) {
  Camera camera;
  camera.target = (model.low + model.high) * 0.5;
  camera.position = camera.target + towards * (distance * length(model.high - model.low));
  camera.up = {0.1, 0.2, 1};
  camera.vertical_fov_deg = 40;
  camera.width_px = camera.height_px = kSide;
  return camera;
}

class Stage {
 public:
  Stage() : gl_(open_gl()) {
    REQUIRE(gl_.ok());
    Result<GlTarget> target = GlTarget::make(gl_->limits(), kSide, kSide);
    REQUIRE(target.ok());
    target_.emplace(*std::move(target));
  }

  // How much of each pixel is covered, 0 to 255.
  std::vector<int> cover(const GlBlocks& blocks, std::span<const ShownRange> shown,
                         const Camera& camera, bool faces_away_too, const GlCuts* cuts = nullptr,
                         std::span<const ShownCut> shown_cuts = {}) {
    DrawPass pass{.view = make_view(camera, 1), .up = camera.up};
    Box box = blocks.box_of(shown);
    if (!shown_cuts.empty()) {
      box.add(cuts->box_of(shown_cuts).low);
      box.add(cuts->box_of(shown_cuts).high);
    }
    pass.depth = depth_range(pass.view, box.low, box.high);
    target_->begin(kSide, kSide);
    const DrawStyle style{.reversed_depth = gl_->limits().can_reverse_depth,
                          .shows_backs = faces_away_too};
    REQUIRE(blocks.draw(programs_, pass, style, shown).ok());
    if (!shown_cuts.empty()) REQUIRE(cuts->draw(programs_, pass, style, shown_cuts).ok());
    std::vector<std::uint8_t> rgba(4 * kSide * kSide);
    target_->read(kSide, kSide, rgba);
    std::vector<int> covered(kSide * kSide);
    for (std::size_t i = 0; i < covered.size(); ++i) covered[i] = rgba[4 * i + 3];
    return covered;
  }

 private:
  Result<GlContext> gl_;
  std::optional<GlTarget> target_;
  ProgramCache programs_;
};

struct Found {
  int inside = 0, leaks = 0;
};

// Where triangles without area are seen, lines that fill what rounding leaves between others: the
// renderer may find by one rounding which way one faces, and by another what it covers.
std::vector<bool> slivers(const Mesh& mesh, const Camera& camera) {
  std::vector<bool> pixels(kSide * kSide, false);
  const Vec3d ahead = normalized(camera.target - camera.position);
  const Vec3d right = normalized(cross(ahead, camera.up)), up = cross(right, ahead);
  const double scale = kSide / 2 / std::tan(camera.vertical_fov_deg * 0.5 * 3.14159265358979 / 180);
  const auto mark = [&](const Vec3d& p) {
    const Vec3d to = p - camera.position;
    const double x = kSide / 2 + scale * dot(to, right) / dot(to, ahead);
    const double y = kSide / 2 + scale * dot(to, up) / dot(to, ahead);
    for (int v = int(y) - 1; v <= int(y) + 1; ++v) {
      for (int u = int(x) - 1; u <= int(x) + 1; ++u) {
        if (u >= 0 && v >= 0 && u < kSide && v < kSide) pixels[std::size_t(v * kSide + u)] = true;
      }
    }
  };
  for (const auto& t : mesh.triangles) {
    const auto at = [&](std::size_t k) { return mesh.positions[index_of(t[k % 3])]; };
    if (length(cross(at(1) - at(0), at(2) - at(0))) > 1e-12) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      for (int i = 0; i <= 2 * kSide; ++i) mark(at(k) + (at(k + 1) - at(k)) * (i / (2.0 * kSide)));
    }
  }
  return pixels;
}

Found count_leaks(const std::vector<int>& all, const std::vector<int>& facing,
                  const std::vector<bool>& left_out) {
  Found found;
  for (int y = 2; y < kSide - 2; ++y) {
    for (int x = 2; x < kSide - 2; ++x) {
      bool is_inside = true;
      for (int v = y - 2; v <= y + 2; ++v) {
        for (int u = x - 2; u <= x + 2; ++u) is_inside &= all[std::size_t(v * kSide + u)] == 255;
      }
      is_inside = is_inside && !left_out[std::size_t(y * kSide + x)];
      found.inside += is_inside;
      found.leaks += is_inside && facing[std::size_t(y * kSide + x)] != 255;
    }
  }
  return found;
}

std::set<std::uint16_t> bands_of(std::span<const ShownRange> shown) {
  std::set<std::uint16_t> bands;
  for (const ShownRange& range : shown) bands.insert(range.block->facts().band);
  return bands;
}

}  // namespace

TEST_CASE("no background shows between the blocks of a closed model") {
  const std::pair<const char*, Mesh> closed[] = {{"smooth sphere", smooth_sphere(64, 128)},
                                                 {"faceted sphere", faceted_sphere(48, 96)},
                                                 {"box", hard_box(36)},
                                                 {"cylinder", hard_cylinder(128, 48)}};
  Stage stage;
  std::size_t all_between = 0;
  for (const auto& [shape, mesh] : closed) {
    const std::string name = shape;
    CAPTURE(name);
    const StreamedModel model = streamed_model(mesh, 400);
    BlockStreamer streamer = model.stream();
    GlBlocks blocks;
    GlCuts cuts(std::make_shared<GlMaterials>());
    std::mt19937 random(3);
    Found found;
    std::size_t most_bands = 0, between = 0;
    for (int i = 0; i < kViews; ++i) {
      // The cut is for one camera, near the surface, and the picture from another.
      BlockViewParameters parameters;
      const Vec3d towards = direction(random);
      parameters.view.camera = camera_from(model, towards, 0.45 + 0.2 * std::abs(number(random)));
      parameters.view.camera.pixels = std::pow(10, number(random));
      parameters.max_bytes = std::size_t(1) << 20;
      finish(streamer, parameters);
      for (int rounds = 0; !streamer.mesh().missing_levels().empty(); ++rounds) {
        REQUIRE(rounds < 10'000);
        streamer.wait(std::chrono::milliseconds(20));
        streamer.update(parameters);
      }
      const std::span<const ShownRange> shown = streamer.mesh().shown();
      const std::span<const ShownCut> levels = streamer.mesh().shown_cuts();
      blocks.upload(shown);
      cuts.upload(levels);
      between += levels.size();
      const Camera camera = camera_from(model, direction(random), 1.3);
      const Found here = count_leaks(stage.cover(blocks, shown, camera, true, &cuts, levels),
                                     stage.cover(blocks, shown, camera, false, &cuts, levels),
                                     slivers(streamer.mesh().extract(), camera));
      found.inside += here.inside;
      found.leaks += here.leaks;
      std::set<std::uint16_t> bands = bands_of(shown);
      for (const ShownCut& cut : levels) bands.insert(cut.block->facts().band);
      most_bands = std::max(most_bands, bands.size());
    }
    CHECK(found.leaks == 0);
    CHECK(found.inside > kViews * 2000);
    if (!kSanitized) CHECK(most_bands >= 2);  // there were seams to look at
    all_between += between;
  }
  CHECK(all_between > 0);
}

TEST_CASE("a block that is left out would have been found") {
  Stage stage;
  const StreamedModel model = streamed_model(smooth_sphere(32, 64), 400);
  BlockStreamer streamer = model.stream();
  BlockViewParameters parameters;
  parameters.in_levels = false;
  parameters.view.camera = camera_from(model, {1, 0, 0}, 1.3);
  finish(streamer, parameters);
  GlBlocks blocks;
  blocks.upload(streamer.mesh().shown());
  int leaks = 0;
  for (std::size_t left_out = 0; left_out < streamer.mesh().shown().size(); ++left_out) {
    std::vector<ShownRange> shown(streamer.mesh().shown().begin(), streamer.mesh().shown().end());
    shown.erase(shown.begin() + std::ptrdiff_t(left_out));
    leaks += count_leaks(stage.cover(blocks, streamer.mesh().shown(), parameters.view.camera, true),
                         stage.cover(blocks, shown, parameters.view.camera, false),
                         slivers({}, parameters.view.camera))
                 .leaks;
  }
  CHECK(leaks > 1000);
}

TEST_CASE("blocks are uploaded once, and freed when the mesh drops them") {
  Stage stage;
  const StreamedModel model = streamed_model(smooth_sphere(32, 64), 400);
  BlockStreamer streamer = model.stream();
  GlBlocks blocks;
  BlockViewParameters parameters;
  parameters.in_levels = false;
  parameters.view.camera = camera_from(model, {1, 0, 0}, 1.3);
  parameters.view.camera.pixels = 0.01;
  finish(streamer, parameters);
  const std::size_t bytes = blocks.upload(streamer.mesh().shown());
  CHECK(bytes > 0);
  CHECK(blocks.bytes() == bytes);
  CHECK(blocks.bytes() <= streamer.mesh().resident_bytes());
  CHECK(blocks.upload(streamer.mesh().shown()) == 0);

  // From far away little is wanted, and the budget lets nothing stay that is not.
  parameters.view.camera = camera_from(model, {1, 0, 0}, 400);
  parameters.max_bytes = 1;
  std::size_t dropped = 0;
  for (;;) {
    const StreamReport report = streamer.update(parameters);
    blocks.drop(report.cut.dropped);
    blocks.upload(streamer.mesh().shown());
    dropped += report.cut.dropped.size();
    if (report.is_complete) break;
  }
  CHECK(dropped > 0);
  CHECK(blocks.block_count() <= streamer.mesh().resident_count());
  CHECK(blocks.bytes() < bytes);
}

}  // namespace crease
