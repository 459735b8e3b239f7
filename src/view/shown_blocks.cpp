#include "view/shown_blocks.h"

#include <algorithm>
#include <cmath>

namespace crease {

namespace {

constexpr std::size_t kFewBlocks = 32;

// Hues a golden ratio apart, so that blocks next to each other differ.
ColorSrgb color_of_number(std::uint32_t number) {
  const double hue = 6 * (number * 0.618033988749895 - std::floor(number * 0.618033988749895));
  ColorSrgb color{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double at = std::fmod(hue + 6 - 2 * double(i), 6.0);
    const double full = std::clamp(std::abs(at - 3) - 1, 0.0, 1.0);
    color[i] = std::uint8_t(std::lround(96 + 136 * full));
  }
  return color;
}

double distance_to(const BlockFacts& facts, const Grid& grid, const Vec3d& eye) {
  const double radius = grid.step * facts.radius;
  return std::max(length(grid.position(facts.center) - eye) - radius, 1e-6 * radius + 1e-12);
}

}  // namespace

FrameFacts ShownBlocks::update(const ViewSettings& settings, const Camera& camera) {
  BlockViewParameters parameters;
  parameters.view.camera = camera;
  parameters.view.camera.pixels = settings.wanted_pixels();
  parameters.view.degrees = settings.degrees;
  parameters.view.max_triangles = settings.max_triangles;
  parameters.max_bytes = settings.max_bytes;
  parameters.by_vertex = settings.vertices_in_blocks && !settings.is_original;
  const StreamReport report = streamer_->update(parameters, view_);
  FrameFacts facts;
  blocks_.drop(report.cut.dropped);
  facts.uploaded_bytes =
      blocks_.upload(mesh().shown(), beside_ == nullptr ? nullptr : &beside_->blocks_);
  facts.uploaded_bytes += cuts_.upload(mesh().shown_cuts());
  creases_.drop(report.cut.dropped);
  if (settings.creases) {
    facts.uploaded_bytes += creases_.update(mesh().shown(), mesh().shown_cuts());
  }
  facts.triangles = mesh().triangle_count();
  facts.error_pixels =
      std::min(std::max(1.0, double(mesh().view_error())) * settings.wanted_pixels(),
               double(camera.height_px));
  facts.gpu_bytes = blocks_.bytes() + cuts_.bytes() + creases_.bytes() + materials_->bytes();
  facts.resident_bytes = mesh().resident_bytes();
  facts.pending_bytes = streamer_->statistics().pending_bytes;
  facts.blocks = mesh().resident_count();
  facts.has_changed =
      report.cut.refined + report.cut.coarsened + report.inserted + facts.uploaded_bytes > 0;
  facts.is_complete = report.is_complete && facts.uploaded_bytes == 0 &&
                      mesh().missing_levels().empty() &&
                      !(mesh().shown().empty() && mesh().shown_cuts().empty());
  return facts;
}

Result<DrawCount> ShownBlocks::draw(ProgramCache& programs, const DrawPass& pass, DrawStyle style,
                                    const ViewSettings& settings, const Camera& cut_camera) {
  const ModelFacts& model = mesh().facts();
  GlBlocks::ColorOfBlock color_of_block;
  switch (settings.coloring) {
    case ViewColoring::Shaded:
      break;
    case ViewColoring::Kind:
      style.coloring = Coloring::Kind;
      break;
    case ViewColoring::Level:
      color_of_block = [&](const ResidentBlock& block) {
        const std::size_t bands = std::max<std::size_t>(model.bands.size(), 1);
        return level_color(float(block.facts().band) / float(bands));
      };
      break;
    case ViewColoring::Block:
      color_of_block = [](const ResidentBlock& block) {
        return color_of_number(std::uint32_t(index_of(block.id())));
      };
      break;
    case ViewColoring::Error:
      color_of_block = [&](const ResidentBlock& block) {
        const double distance = distance_to(block.facts(), model.grid, cut_camera.position);
        const double pixels = in_pixels(block.facts().fine, cut_camera, distance);
        return error_color(float(std::min(1.0, pixels / (2 * settings.pixels))));
      };
      break;
  }
  Result<DrawCount> count = blocks_.draw(programs, pass, style, mesh().shown(), color_of_block);
  if (!count.ok()) return count;
  const Result<DrawCount> by_vertex =
      cuts_.draw(programs, pass, style, mesh().shown_cuts(), color_of_block);
  if (!by_vertex.ok()) return by_vertex;
  count->calls += by_vertex->calls;
  count->triangles += by_vertex->triangles;
  if (!settings.creases) return count;
  const Status drawn = creases_.draw(programs, pass, style);
  if (!drawn.ok()) return drawn.failure();
  return count;
}

Box ShownBlocks::box() const {
  Box box = blocks_.box_of(mesh().shown());
  const Box by_vertex = cuts_.box_of(mesh().shown_cuts());
  if (by_vertex.empty) return box;
  box.add(by_vertex.low);
  box.add(by_vertex.high);
  return box;
}

std::optional<Hit> ShownBlocks::pick(const Ray& ray) const {
  std::optional<Hit> hit = crease::pick(mesh().shown(), mesh().facts().grid, ray);
  std::optional<Hit> by_vertex = crease::pick(mesh().shown_cuts(), mesh().facts().grid, ray);
  return by_vertex && (!hit || by_vertex->along < hit->along) ? by_vertex : hit;
}

HitFacts ShownBlocks::facts_of(const Hit& hit) const {
  const BlockFacts& block = hit.block->facts();
  const std::size_t bands = mesh().facts().bands.size();
  const std::string level =
      block.band == bands ? "the base of " + std::to_string(bands) + " bands"
                          : "band " + std::to_string(block.band) + " of " + std::to_string(bands);
  // By vertex, what is shown there is somewhere between.
  return {level, hit.is_by_vertex ? block.coarse : block.fine, part_of(hit, mesh())};
}

// Of few blocks all corners, of many those of their boxes: a camera is fitted again with each block
// that arrives, between two frames.
std::vector<Vec3f> ShownBlocks::outline() const {
  const std::span<const ShownRange> shown = mesh().shown();
  const std::span<const ShownCut> cuts = mesh().shown_cuts();
  if (shown.size() + cuts.size() > kFewBlocks) {
    std::vector<Vec3f> points = blocks_.box_corners_of(shown, origin());
    const std::vector<Vec3f> more = cuts_.box_corners_of(cuts, origin());
    points.insert(points.end(), more.begin(), more.end());
    return points;
  }
  std::vector<Vec3f> points;
  const auto add = [&points](const DrawList& list) {
    points.insert(points.end(), list.positions.begin(), list.positions.end());
  };
  for (const ShownRange& range : shown) add(range.block->draw_list());
  for (const ShownCut& cut : cuts) add(cut.list);
  return points;
}

}  // namespace crease
