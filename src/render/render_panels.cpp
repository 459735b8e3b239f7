#include "base/assert.h"
#include "crease/render.h"
#include "render/averaged_tile.h"
#include "render/fit_camera.h"
#include "render/frustum.h"
#include "render/gl_context.h"
#include "render/gl_lines.h"
#include "render/gl_occlusion.h"
#include "render/gl_scene.h"
#include "render/gl_target.h"
#include "render/layout.h"
#include "render/legend.h"
#include "render/palette.h"
#include "render/text.h"

#include <algorithm>
#include <cmath>

namespace crease {

namespace {

constexpr int kMaxSide = 32768;

// A larger framebuffer takes more memory (36 bytes a pixel), a smaller one draws the scene more
// often.
constexpr int kMaxTile = 4096;

std::string panel_name(std::size_t i, const Panel& panel) {
  return "panel " + std::to_string(i + 1) + (panel.title.empty() ? "" : " (" + panel.title + ")");
}

Status check_part(const DrawList& list, const DrawPart& part, std::size_t normal_count,
                  std::size_t position_count, const char* kind) {
  const std::size_t triangles = part.triangle_count();
  const auto off = [&](const std::string& what) {
    return fail(Error::BadValue, std::string(kind) + " part: " + what);
  };
  if (part.indices.size() != 3 * triangles) return off("indices are not three a triangle");
  if (part.normals.size() != normal_count) return off("normals do not fit the triangles");
  if (!part.materials.empty() && part.materials.size() != triangles) {
    return off("materials are not one a triangle");
  }
  if (!part.colors.empty() && part.colors.size() != 3 * triangles) {
    return off("colours are not three a triangle");
  }
  if (!part.texcoords.empty() && part.texcoords.size() != 3 * triangles) {
    return off("texture coordinates are not three a triangle");
  }
  for (std::uint32_t i : part.indices) {
    if (i >= position_count)
      return off("index " + std::to_string(i) + " of " + std::to_string(position_count));
  }
  for (std::uint32_t m : part.materials) {
    if (!list.materials.empty() && m >= list.materials.size()) {
      return off("material " + std::to_string(m) + " of " + std::to_string(list.materials.size()));
    }
  }
  return Done{};
}

// A driver may do anything with an index out of range, so none gets there.
Status check_panel(const Panel& panel, int max_texel_count) {
  const DrawList& list = panel.list;
  const std::size_t sn_positions = std::min(list.vertex_normals.size(), list.positions.size());
  for (const Status& status :
       {check_part(list, list.sn, 0, sn_positions, "SN"),
        check_part(list, list.fn, list.fn.triangle_count(), list.positions.size(), "FN"),
        check_part(list, list.nsn, 3 * list.nsn.triangle_count(), list.positions.size(), "NSN")}) {
    if (!status.ok()) return status;
  }
  const auto is_one_each = [&](std::span<const float> of_position) {
    return of_position.empty() || of_position.size() == list.positions.size();
  };
  if (!is_one_each(panel.error_of_position)) {
    return fail(Error::BadValue, "errors are not one a position");
  }
  if (!is_one_each(panel.level_of_position)) {
    return fail(Error::BadValue, "levels are not one a position");
  }
  const std::size_t largest = std::max({list.positions.size(), list.sn.indices.size(),
                                        list.fn.indices.size(), list.nsn.indices.size()});
  if (largest > std::size_t(max_texel_count)) {
    return fail(Error::OverLimit, std::to_string(largest / 3) + " triangles of one kind; this " +
                                      "device draws " + std::to_string(max_texel_count / 3));
  }
  return Done{};
}

struct ErrorScale {
  double full = 1, max = 0;
};

// The red end is the one that is asked for, else the 99.5th percentile over all panels: one far
// vertex must not turn all else blue.
ErrorScale error_scale(std::span<const Panel> panels, const RenderOptions& options) {
  if (options.coloring != Coloring::Error) return {};
  std::vector<float> errors;
  for (const Panel& panel : panels) {
    for (float e : panel.error_of_position) {
      if (std::isfinite(e)) errors.push_back(std::abs(e));
    }
  }
  if (errors.empty()) return {};
  const auto at = errors.begin() + std::ptrdiff_t(double(errors.size() - 1) * 0.995);
  std::nth_element(errors.begin(), at, errors.end());
  const double max = *std::max_element(at, errors.end());
  if (options.error_full > 0) return {options.error_full, max};
  const double full = *at > 0 ? double(*at) : max;
  return {full > 0 ? full : 1, max};
}

// The background's colour in a row, in encoded steps finer than a byte; linear in encoded values,
// which looks even.
std::array<float, 3> background_row(int y, int height) {
  const float t = (float(y) + 0.5f) / float(height);
  std::array<float, 3> c;
  for (std::size_t i = 0; i < 3; ++i) {
    c[i] = float(kBackgroundTop[i]) + t * (float(kBackgroundBottom[i]) - float(kBackgroundTop[i]));
  }
  return c;
}

// Ordered dither, so that 32 grey levels over 1000 rows show no bands.
float dither(int x, int y) {
  static constexpr std::uint8_t kBayer[4][4] = {
      {0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};
  return (float(kBayer[y & 3][x & 3]) + 0.5f) / 16;
}

void fill_background(Image& image, const PixelRect& view) {
  for (int y = 0; y < view.height; ++y) {
    const std::array<float, 3> row = background_row(y, view.height);
    for (int x = 0; x < view.width; ++x) {
      std::uint8_t* pixel = &image.rgba[4 * (std::size_t(view.y + y) * std::size_t(image.width) +
                                             std::size_t(view.x + x))];
      for (std::size_t c = 0; c < 3; ++c) {
        pixel[c] = std::uint8_t(std::min(255.0f, row[c] + dither(x, y)));
      }
      pixel[3] = 255;
    }
  }
}

// How often a scene is drawn and averaged. What is seen through has a grain that is gone at 8; of
// large scenes that would take long.
unsigned turns_of(const GlScene& scene, const DrawStyle& style) {
  if (!scene.is_seen_through(style)) return 1;
  return unsigned(std::clamp<std::size_t>(16'000'000 / (scene.triangle_count() + 1), 2, 8));
}

// Draws one panel's view tile by tile.
Status draw_view(Image& image, const PixelRect& view_rect, const GlScene& scene,
                 std::span<const Segment> lines, const Camera& camera, const DrawStyle& style,
                 GlTarget& target, int tile_px, ProgramCache& programs) {
  DrawPass pass = pass_over(camera, double(view_rect.width) / view_rect.height, scene.box(), lines);
  const unsigned turns = turns_of(scene, style);
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < view_rect.height; y += tile_px) {
    for (int x = 0; x < view_rect.width; x += tile_px) {
      const int width = std::min(tile_px, view_rect.width - x);
      const int height = std::min(tile_px, view_rect.height - y);
      pass.window.left = double(x) / view_rect.width;
      pass.window.right = double(x + width) / view_rect.width;
      pass.window.top = 1 - double(y) / view_rect.height;
      pass.window.bottom = 1 - double(y + height) / view_rect.height;
      const int draw_width = width * kSupersampling, draw_height = height * kSupersampling;
      pixels.resize(4 * std::size_t(draw_width) * std::size_t(draw_height));
      // What is seen through keeps no light away, and is drawn over the rest.
      const bool is_seen_through = scene.is_seen_through(style);
      DrawStyle of_turn = style;
      if (is_seen_through) of_turn.shown = Shown::Opaque;
      target.begin(draw_width, draw_height);
      if (const Status drawn = scene.draw(programs, pass, of_turn); !drawn.ok()) return drawn;
      if (style.ambient_occlusion) {
        const Result<const GlTexture*> depths = target.resolve_depth(draw_width, draw_height);
        if (!depths.ok()) return depths.failure();
        const Status drawn = draw_occlusion(programs, **depths, pass, style);
        if (!drawn.ok()) return drawn;
      }
      if (is_seen_through) {
        if (const Status kept = target.keep(draw_width, draw_height); !kept.ok()) return kept;
        of_turn.shown = Shown::SeenThrough;
      }
      AveragedTile tile(width, height);
      for (unsigned turn = 0; turn < turns; ++turn) {
        if (turn > 0) target.go_back(draw_width, draw_height);
        of_turn.turn = turn;
        if (is_seen_through) {
          if (const Status drawn = scene.draw(programs, pass, of_turn); !drawn.ok()) return drawn;
        }
        const Status drawn = draw_lines(programs, lines, pass, style);
        if (!drawn.ok()) return drawn;
        target.read(draw_width, draw_height, pixels);
        tile.add(pixels);
      }
      tile.lay_over(image, view_rect.x + x, view_rect.y + y);
    }
  }
  return Done{};
}

LegendContent legend_content(std::span<const Panel> panels, const RenderOptions& options,
                             const ErrorScale& scale) {
  LegendContent content{.coloring = options.coloring,
                        .error_full = scale.full,
                        .error_max = scale.max,
                        .says_max = options.error_full <= 0,
                        .error_unit = options.error_unit};
  for (const Panel& panel : panels) {
    content.has_sn |= panel.list.sn.triangle_count() > 0;
    content.has_fn |= panel.list.fn.triangle_count() > 0;
    content.has_nsn |= panel.list.nsn.triangle_count() > 0;
  }
  return content;
}

// Those of triangles: an adaptive mesh has others in between, which must not widen the view.
std::vector<Vec3f> used_positions(const DrawList& list) {
  std::vector<char> is_used(list.positions.size(), 0);
  for (const DrawPart* part : {&list.sn, &list.fn, &list.nsn}) {
    for (std::uint32_t i : part->indices) {
      if (i < is_used.size()) is_used[i] = 1;  // check_panel() refuses others
    }
  }
  std::vector<Vec3f> used;
  for (std::size_t i = 0; i < is_used.size(); ++i) {
    if (is_used[i] != 0) used.push_back(list.positions[i]);
  }
  return used;
}

bool has_same_materials(const DrawList& a, const DrawList& b) {
  const auto same = [](const ImageFile& x, const ImageFile& y) {
    return x.name == y.name && x.bytes == y.bytes;
  };
  return std::ranges::equal(a.materials, b.materials) &&
         std::ranges::equal(a.images, b.images, same);
}

GlMaterialsPtr upload_materials(const DrawList& list, const GlLimits& gl,
                                const RenderOptions& options) {
  Textures textures;
  if (options.coloring == Coloring::Shaded) {
    textures = decode_textures(list.materials, list.images, texture_limits(gl));
  }
  for (const std::string& note : textures.notes) {
    if (options.on_note) options.on_note(note);
  }
  auto materials = std::make_shared<GlMaterials>();
  materials->fill(list.materials, textures);
  return materials;
}

// Panels of one model, where all have as many one after the other; else 1.
int panels_a_model(std::span<const std::uint32_t> models) {
  std::size_t group = 0;
  for (std::size_t begin = 0, end = 0; begin < models.size(); begin = end) {
    while (end < models.size() && models[end] == models[begin]) ++end;
    if (begin == 0) group = end;
    if (end - begin != group) return 1;
  }
  return int(std::max<std::size_t>(1, group));
}

// `content_aspect` and `group` count where there is no camera.
Result<Layout> lay_out_panels(std::size_t panel_count, bool has_titles, double content_aspect,
                              int group, const RenderOptions& options) {
  if (panel_count == 0) return fail(Error::BadValue, "no panel to draw");
  if (options.camera && !can_see(*options.camera)) {
    return fail(Error::BadValue, "a camera that sees nothing: not finite, or without a direction");
  }
  if (options.width_px < 1 || options.height_px < 1 || options.width_px > kMaxSide ||
      options.height_px > kMaxSide) {
    return fail(Error::BadValue, "a picture of " + std::to_string(options.width_px) + " x " +
                                     std::to_string(options.height_px) +
                                     " pixels; each side is 1 to " + std::to_string(kMaxSide));
  }
  Layout layout = make_layout({.panel_count = panel_count,
                               .width_px = options.width_px,
                               .height_px = options.height_px,
                               .columns = options.columns,
                               .group = options.camera ? 1 : group,
                               .content_aspect = options.camera ? double(options.camera->width_px) /
                                                                      options.camera->height_px
                                                                : content_aspect,
                               .titles = has_titles,
                               .legend = options.coloring != Coloring::Shaded});
  const PixelRect& size = layout.views.front();
  if (size.width < 1 || size.height < 1) {
    return fail(Error::BadValue, std::to_string(panel_count) + " panels do not fit into " +
                                     std::to_string(options.width_px) + " x " +
                                     std::to_string(options.height_px) + " pixels");
  }
  return layout;
}

// The sets whose place is `first`.
std::vector<PointSet> at_place(Scene scene, std::span<const std::size_t> places,
                               std::size_t first) {
  std::vector<PointSet> sets;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    if (places[i] == first) sets.push_back(scene[i]);
  }
  return sets;
}

// What is seen of all places on the average, from afar.
double aspect_of(Scene scene, std::span<const std::size_t> places, std::span<const Vec3d> ups) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    if (places[i] != i) continue;
    sum += std::log(projected_aspect(at_place(scene, places, i), ups[i]));
    ++count;
  }
  return count > 0 ? std::exp(sum / count) : 1;
}

// One camera for each panel.
std::vector<Camera> choose_cameras(Scene scene, std::span<const std::size_t> places,
                                   std::span<const Vec3d> ups, const RenderOptions& options,
                                   const PixelRect& size) {
  std::vector<Camera> cameras;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    if (places[i] != i) {
      cameras.push_back(cameras[places[i]]);
    } else if (options.camera) {
      cameras.push_back(*options.camera);
    } else if (options.frustum) {
      cameras.push_back(fit_outside(scene, *options.frustum, size.width, size.height));
    } else {
      cameras.push_back(fit_camera_to(at_place(scene, places, i), ups[i], size.width, size.height));
    }
  }
  return cameras;
}

}  // namespace

Result<Camera> camera_of_panel(std::size_t panel_count, bool has_titles,
                               const RenderOptions& options) {
  CREASE_ASSERT(options.camera);
  const Result<Layout> layout = lay_out_panels(panel_count, has_titles, 1, 1, options);
  if (!layout.ok()) return layout.failure();
  return camera_for_shape(*options.camera, layout->views.front().width,
                          layout->views.front().height);
}

Result<Image> render_panels(std::span<const Panel> panels, const RenderOptions& options) {
  std::vector<std::vector<Vec3f>> points;
  for (const Panel& panel : panels) points.push_back(used_positions(panel.list));
  std::vector<PointSet> scene;
  std::vector<std::uint32_t> models;
  std::vector<Vec3d> ups;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    scene.push_back({panels[i].list.origin, points[i]});
    models.push_back(panels[i].model);
    ups.push_back(panels[i].up.value_or(options.up));
  }
  const bool has_titles =
      std::ranges::any_of(panels, [](const Panel& p) { return !p.title.empty(); });
  // A camera that is asked for shows all panels.
  const std::vector<std::size_t> places = options.camera || options.frustum
                                              ? std::vector<std::size_t>(panels.size(), 0)
                                              : places_of(scene, models);
  const Result<Layout> layout = lay_out_panels(
      panels.size(), has_titles, aspect_of(scene, places, ups), panels_a_model(models), options);
  if (!layout.ok()) return layout.failure();
  const PixelRect& size = layout->views.front();
  const std::vector<Camera> cameras = choose_cameras(scene, places, ups, options, size);
  if (options.on_note && std::ranges::count(places, 0) < std::ptrdiff_t(places.size())) {
    options.on_note(
        "models that lie apart, or differ in size by more than twice, are each seen from near");
  }
  const std::vector<Segment> lines =
      options.frustum ? frustum_lines(scene, *options.frustum) : std::vector<Segment>{};

  Result<GlContext> gl = open_gl();
  if (!gl.ok()) return gl.failure();
  const int tile_px = std::min(kMaxTile, gl->limits().max_texture_size) / kSupersampling;
  Result<GlTarget> target =
      GlTarget::make(gl->limits(), std::min(tile_px, size.width) * kSupersampling,
                     std::min(tile_px, size.height) * kSupersampling);
  if (!target.ok()) return target.failure();

  Image image;
  image.width = options.width_px;
  image.height = options.height_px;
  image.rgba.resize(4 * std::size_t(image.width) * std::size_t(image.height));
  fill_rect(image, {0, 0, image.width, image.height}, kPageColor);
  const ErrorScale scale = error_scale(panels, options);
  ProgramCache programs;
  GlMaterialsPtr materials;  // of the panel before
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const Status sound = check_panel(panels[i], gl->limits().max_texel_count);
    if (!sound.ok()) {
      return fail(sound.failure().error, panel_name(i, panels[i]) + ": " + sound.failure().message);
    }
    fill_rect(image, layout->titles[i], kPageColor);
    draw_title(image, panels[i].title, layout->titles[i], layout->title_px, kTextColor);
    fill_background(image, layout->views[i]);
    const DrawStyle style{.coloring = options.coloring,
                          .wireframe = options.wireframe,
                          .ambient_occlusion = options.ambient_occlusion,
                          .line_px = kSupersampling * std::max(1.0f, float(size.height) / 1080),
                          .level_share = panels[i].level_share,
                          .error_full = float(scale.full),
                          .reversed_depth = gl->limits().can_reverse_depth};
    if (i == 0 || !has_same_materials(panels[i].list, panels[i - 1].list)) {
      materials = upload_materials(panels[i].list, gl->limits(), options);
    }
    const GlScene on_gpu(panels[i].list,
                         options.coloring == Coloring::Level ? panels[i].level_of_position
                                                             : panels[i].error_of_position,
                         materials);
    const Status drawn = draw_view(image, layout->views[i], on_gpu, lines, cameras[i], style,
                                   *target, tile_px, programs);
    if (!drawn.ok()) return drawn.failure();
  }
  for (const PixelRect& separator : layout->separators) {
    fill_rect(image, separator, kSeparatorColor);
  }
  draw_legend(image, layout->legend, legend_content(panels, options, scale));
  return image;
}

}  // namespace crease
