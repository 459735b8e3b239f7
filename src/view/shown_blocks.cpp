#include "view/shown_blocks.h"

#include "crease/block_view.h"

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

constexpr double kNearest = 1e-12;

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
  if (const std::size_t uploaded = cuts_.upload(mesh().shown_cuts()); uploaded > 0) {
    facts.uploaded_bytes += uploaded;
    painted_.reset();
  }
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
      break;
  }
  Result<DrawCount> count(DrawCount{});
  if (settings.coloring == ViewColoring::Error) {
    count = draw_by_error(programs, pass, style, 2 * settings.pixels, cut_camera);
  } else {
    count = blocks_.draw(programs, pass, style, mesh().shown(), color_of_block);
    if (!count.ok()) return count;
    const Result<DrawCount> cuts =
        cuts_.draw(programs, pass, style, mesh().shown_cuts(), color_of_block);
    if (!cuts.ok()) return cuts;
    *count += *cuts;
  }
  if (!count.ok() || !settings.creases) return count;
  const Status drawn = creases_.draw(programs, pass, style);
  if (!drawn.ok()) return drawn.failure();
  return count;
}

// The groups of whole blocks in one colour each, what is between the ends of blocks by position.
Result<DrawCount> ShownBlocks::draw_by_error(ProgramCache& programs, const DrawPass& pass,
                                             DrawStyle style, double full_pixels,
                                             const Camera& camera) {
  const std::span<const ShownCut> cuts = mesh().shown_cuts();
  if (painted_ != camera) {
    for (const ShownCut& cut : cuts) cuts_.set_scalars(cut, pixels_of_position(cut, camera));
    painted_ = camera;
  }
  DrawStyle by_position = style;
  by_position.coloring = Coloring::Error;
  by_position.error_full = float(full_pixels);
  Result<DrawCount> count = cuts_.draw(programs, pass, by_position, cuts);
  for (const ShownRange& shown : mesh().shown()) {
    const auto draw_group = [&](const BlockGroup& group) {
      if (!count.ok()) return false;
      const double share = pixels_of(*shown.block, group, camera) / full_pixels;
      style.surface = error_color(float(std::min(1.0, share)));
      const ShownRange range{shown.block, group.sn, group.fn, group.nsn};
      const Result<DrawCount> drawn = blocks_.draw(programs, pass, style, {&range, 1});
      if (!drawn.ok()) {
        count = drawn.failure();
      } else {
        *count += *drawn;
      }
      return false;  // nothing is asked of what shown_groups() would join
    };
    shown_groups({&shown, 1}, draw_group);
  }
  return count;
}

std::vector<float> ShownBlocks::pixels_of_position(const ShownCut& cut,
                                                   const Camera& camera) const {
  std::vector<float> errors = mesh().error_of_position(cut);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const Vec3d to = cut.list.origin + to_double(cut.list.positions[i]) - camera.position;
    errors[i] = float(double(errors[i]) / pixel_size(camera, std::max(length(to), kNearest)));
  }
  return errors;
}

// At the point of the group, and of a sphere where it is off, that is nearest to the eye.
double ShownBlocks::pixels_of(const ResidentBlock& block, const BlockGroup& group,
                              const Camera& camera) const {
  const Vec3d eye = camera.position - origin(), low = to_double(group.low),
              high = to_double(group.high);
  const auto distance_to_box = [&](const Vec3d& p) {
    Vec3d off;
    for (int i = 0; i < 3; ++i) off[i] = std::max({low[i] - p[i], p[i] - high[i], 0.0});
    return length(off);
  };
  double most = 0;
  for (const ErrorSphere& sphere : mesh().errors_of(block, group)) {
    const Vec3d center = to_double(sphere.center);
    if (distance_to_box(center) > sphere.radius) continue;
    const double distance =
        std::max({distance_to_box(eye), length(center - eye) - sphere.radius, kNearest});
    most = std::max(most, double(sphere.error) / pixel_size(camera, distance));
  }
  return most;
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
