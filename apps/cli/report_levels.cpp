#include "cli/report_levels.h"

#include "cli/console.h"
#include "cli/facts.h"
#include "cli/text.h"
#include "crease/render.h"
#include "crease/shading.h"

#include <algorithm>
#include <utility>

namespace crease::cli {

namespace {

// Blocks lie from coarse to fine, so a level needs all from the start to the last of its finest
// band. One value a band, its coarse end, and a last one in front: full resolution.
Result<std::vector<std::uint64_t>> bytes_by_band(const BlockFile& blocks) {
  const std::size_t bands = blocks.facts().bands.size();
  std::vector<std::uint64_t> ends(bands + 1, blocks.head().head_bytes);  // by band, the base last
  for (std::uint32_t p = 0; p < blocks.page_count(); ++p) {
    const Result<DirectoryPage> page = blocks.read_page(p);
    if (!page.ok()) return page.failure();
    for (const BlockEntry& entry : page->blocks) {
      std::uint64_t& end = ends[entry.facts.band];
      end = std::max(end, entry.offset + entry.bytes);
    }
  }
  for (std::size_t b = bands; b-- > 0;) ends[b] = std::max(ends[b], ends[b + 1]);
  return ends;
}

Result<std::vector<std::byte>> draw_level(const ProgressiveMesh& mesh,
                                          std::span<const ImageFile> images, const Camera& camera,
                                          const ReportLevelOptions& options) {
  RenderOptions render;
  render.width_px = options.width_px;
  render.height_px = options.height_px;
  render.camera = camera;
  render.up = options.up;
  Panel panel;
  panel.list = mesh.draw_list();
  panel.list.images = images;
  const Result<Image> image = render_panels(std::span(&panel, 1), render);
  if (!image.ok()) return image.failure();
  return encode_png(*image);
}

// Kinds as info tells them, of the mesh: the arrays have some smooth triangles among the mixed
// ones, where a vertex is not smooth at other levels.
ReportLevel counts_of(const ProgressiveMesh& mesh, const Mesh& extracted) {
  const ShadingKinds kinds = classify_shading(extracted);
  const auto count = [&kinds](TriangleKind kind) {
    return std::size_t(std::ranges::count(kinds.of_triangle, kind));
  };
  ReportLevel level;
  level.triangles = mesh.triangle_count();
  level.vertices = mesh.vertex_count();
  level.sn_triangles = count(TriangleKind::SN);
  level.fn_triangles = count(TriangleKind::FN);
  level.nsn_triangles = count(TriangleKind::NSN);
  level.recorded = mesh.error();
  return level;
}

}  // namespace

Result<ReportLevels> make_report_levels(const ModelFile& file, const Mesh& full,
                                        const ProgressiveArraysPtr& arrays,
                                        const ReportLevelOptions& options, const Common& common) {
  const ModelFacts& facts = file.blocks().facts();
  const Result<std::vector<std::uint64_t>> bytes = bytes_by_band(file.blocks());
  if (!bytes.ok()) return bytes.failure();
  const auto [low, high] = bounds_of(full);
  const Camera camera =
      options.view.value_or(fit_camera(low, high, options.width_px, options.height_px, options.up));

  const Result<std::vector<ImageFile>> images = file.images(arrays->materials);
  if (!images.ok()) return images.failure();

  ReportLevels made;
  made.bytes_of_band.assign(bytes->begin() + 1, bytes->end());
  made.diagonal = length(high - low);
  std::vector<double> ratios = options.ratios;
  ratios.insert(ratios.begin(), 1.0);
  ProgressiveMesh mesh(arrays);
  for (const double ratio : ratios) {
    const Result<Chosen> chosen = choose_level(mesh, full, {.ratio = ratio}, common);
    if (!chosen.ok()) return chosen.failure();
    if (!made.levels.empty() && made.levels.back().triangles == mesh.triangle_count()) continue;
    const Mesh extracted = mesh.extract();
    ReportLevel level = counts_of(mesh, extracted);
    level.name = !chosen->target_met                             ? "coarsest"
                 : level.triangles == mesh.full_triangle_count() ? "original"
                                                                 : in_percent(ratio);
    level.stopped_by = chosen->stopped_by;
    level.bytes_needed = (*bytes)[finest_band_for(facts, level.triangles)];
    log(common, "  " + level.name + ": " + grouped(level.triangles) + " triangles");
    if (mesh.applied() > 0 && options.samples > 0) {
      const Result<Comparison> measured = measure_level(full, extracted, options.samples, common);
      if (!measured.ok()) return measured.failure();
      level.measured = *measured;
    }
    if (made.no_pictures.empty()) {
      Result<std::vector<std::byte>> png = draw_level(mesh, *images, camera, options);
      if (png.ok()) {
        level.png = *std::move(png);
      } else if (png.failure().error == Error::NotSupported) {
        made.no_pictures = png.failure().message;
      } else {
        return png.failure();
      }
    }
    made.levels.push_back(std::move(level));
    if (interrupted()) return interrupted_failure();
  }
  return made;
}

}  // namespace crease::cli
