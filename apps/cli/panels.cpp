#include "cli/panels.h"

#include "cli/console.h"
#include "cli/text.h"
#include "cli/up_option.h"
#include "cli/view.h"
#include "crease/build_progressive_arrays.h"
#include "crease/compare.h"

#include <algorithm>
#include <cmath>

namespace crease::cli {

namespace {

double corner_angle(const Mesh& mesh, const Triangle& t, std::size_t corner) {
  const Vec3d& at = mesh.positions[index_of(t[corner])];
  const Vec3d to_next = mesh.positions[index_of(t[(corner + 1) % 3])] - at;
  const Vec3d to_last = mesh.positions[index_of(t[(corner + 2) % 3])] - at;
  return std::atan2(length(cross(to_next, to_last)), dot(to_next, to_last));
}

// 0 for the full mesh, 1 for the base, even steps for even factors between.
float level_share(std::size_t full_count, std::size_t base_count, std::size_t count) {
  const double full = static_cast<double>(full_count);
  const double base = static_cast<double>(std::max<std::size_t>(1, base_count));
  const double now = static_cast<double>(std::max<std::size_t>(1, count));
  return full > base ? static_cast<float>(std::log(full / now) / std::log(full / base)) : 0.0f;
}

// What the error at each position looks like from where the camera is, whichever way it turns.
std::vector<float> errors_in_pixels(const AdaptiveMesh& mesh, const Camera& camera) {
  std::vector<float> errors = mesh.error_of_position();
  const DrawList list = mesh.draw_list();
  const double pixels_per_radian =
      camera.height_px / (2 * std::tan(radians(camera.vertical_fov_deg) / 2));
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const Vec3f& p = list.positions[i];
    const double away = length(list.origin + Vec3d{p.x, p.y, p.z} - camera.position);
    const double pixels = double(errors[i]) * pixels_per_radian / std::max(away, 1e-300);
    errors[i] = static_cast<float>(std::min(pixels, 1e30));
  }
  return errors;
}

std::string level_name(const ProgressiveMesh& mesh, std::size_t full) {
  if (mesh.triangle_count() == full) return "original";
  const double share = static_cast<double>(mesh.triangle_count()) / static_cast<double>(full);
  const double digit = std::pow(10.0, std::floor(std::log10(share)) - 1);
  return in_percent(std::round(share / digit) * digit);  // 19.98 % is 20 %
}

// As many levels as panels, by their counts where a share is asked for.
std::vector<LevelOptions> levels_of(const PanelOptions& options, std::size_t full) {
  std::vector<LevelOptions> levels;
  for (const double ratio : options.ratios) levels.push_back({.ratio = ratio});
  if (levels.empty()) levels.push_back(options.level);
  for (LevelOptions& level : levels) {
    if (!level.ratio) continue;
    const double count = *level.ratio * static_cast<double>(full);
    level.triangles = std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(count)));
    level.ratio = std::nullopt;
  }
  return levels;
}

// Of the finest level, where nothing is measured against the full model.
std::optional<std::size_t> triangles_needed(const std::vector<LevelOptions>& levels) {
  std::size_t most = 0;
  for (const LevelOptions& level : levels) {
    if (!level.triangles) return std::nullopt;
    most = std::max(most, *level.triangles);
  }
  return most;
}

}  // namespace

Mesh with_averaged_normals(Mesh mesh) {
  AttributeLayer* normals = mesh.normals();
  if (normals == nullptr) return mesh;
  std::vector<Vec3d> sums(mesh.vertex_count());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::span<const float> n = normals->value(normals->of_corner[3 * t + c]);
      const double angle = corner_angle(mesh, mesh.triangles[t], c);
      sums[index_of(mesh.triangles[t][c])] += Vec3d{n[0], n[1], n[2]} * angle;
    }
  }
  normals->values.clear();
  for (const Vec3d& sum : sums) {
    const Vec3d n = length(sum) > 0 ? normalized(sum) : Vec3d{0, 0, 1};
    for (int i = 0; i < 3; ++i) normals->values.push_back(static_cast<float>(n[i]));
  }
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t v = index_of(mesh.triangles[t][c]);
      normals->of_corner[3 * t + c] = AttributeId(static_cast<std::uint32_t>(v));
    }
  }
  return mesh;
}

void Panels::add(Source source, const std::string& title, Json json, const PanelOptions& options,
                 float share) {
  sources_.push_back(std::move(source));
  const Source& kept = sources_.back();
  Panel panel;
  panel.list = kept.progressive ? kept.progressive->draw_list()
               : kept.adaptive  ? kept.adaptive->draw_list()
                                : kept.arrays->draw_list();
  if (!kept.images.empty()) panel.list.images = kept.images;
  if (options.titles) panel.title = title;
  panel.level_share = share;
  panel.model = file_count_;
  if (up_ != UpAxis::Unknown) panel.up = up_direction(options.up, up_);
  panel.error_of_position = kept.errors;
  panel.level_of_position = kept.levels;
  panels_.push_back(std::move(panel));
  json["title"] = title;
  json_.push_back(std::move(json));
}

void Panels::add_level(ProgressiveMesh mesh, const Mesh& full, std::size_t full_count,
                       const std::string& name, const PanelOptions& options, const Common& common) {
  Source source;
  source.progressive = std::make_unique<ProgressiveMesh>(std::move(mesh));
  source.images = full.images;
  if (options.errors_of_positions) {
    const DrawList list = source.progressive->draw_list();
    std::vector<Vec3d> points;
    points.reserve(list.positions.size());
    for (const Vec3f& p : list.positions) points.push_back(list.origin + Vec3d{p.x, p.y, p.z});
    source.errors = distances_to(full, points, common.threads);
  }
  const std::size_t triangles = source.progressive->triangle_count();
  const float share = level_share(full_count, source.progressive->base_triangle_count(), triangles);
  add(std::move(source), name + ": " + grouped(triangles) + " triangles",
      {{"triangles", triangles}, {"control", false}}, options, share);
}

void Panels::add_control(const Mesh& level, const std::string& name, const PanelOptions& options,
                         float share) {
  Source source;
  source.arrays = std::make_unique<MeshDrawArrays>(with_averaged_normals(level));
  add(std::move(source), name + ", one normal a vertex",
      {{"triangles", level.triangle_count()}, {"control", true}}, options, share);
}

Status Panels::add_view(const std::filesystem::path& path, const PanelOptions& options,
                        const Common& common) {
  const Result<ModelFile> file = open_model(path, options.read, common);
  if (!file.ok()) return file.failure();
  learn_up(file->blocks().facts().up);
  const Camera& camera = options.view->camera;
  // What was not read has no errors and no levels.
  const bool reads_all = options.errors_of_positions || options.levels_of_positions;
  Result<ViewedModel> model =
      load_viewed(*file, *options.view, {.all = reads_all, .part_names = false});
  if (!model.ok()) return model.failure();
  bytes_read_ += model->bytes_read;
  const std::size_t full = file->triangle_count();
  Source source;
  source.adaptive = std::make_unique<AdaptiveMesh>(std::move(model->mesh));
  AdaptiveMesh& mesh = *source.adaptive;
  Result<std::vector<ImageFile>> images = file->images(mesh.hierarchy().materials);
  if (!images.ok()) return images.failure();
  source.images = *std::move(images);
  if (options.errors_of_positions) source.errors = errors_in_pixels(mesh, camera);
  if (options.levels_of_positions) source.levels = mesh.level_of_position();
  const std::size_t triangles = mesh.triangle_count();
  const std::size_t coarsest = mesh.hierarchy().vertices.coarse_triangles().size();
  const std::string name = file->name();
  Mesh shown = options.control ? mesh.extract() : Mesh{};
  shown.images = source.images;
  add(std::move(source), name + ": " + grouped(triangles) + " of " + grouped(full) + " triangles",
      {{"triangles", triangles},
       {"full_triangles", full},
       {"control", false},
       {"stopped_by", name_of(model->stopped_by)},
       {"camera", Json::parse(format_camera(camera))}},
      options, level_share(full, coarsest, triangles));
  if (options.control) add_control(shown, name, options, panels_.back().level_share);
  return Done{};
}

Status Panels::add_file(const std::filesystem::path& path, const PanelOptions& options,
                        const Common& common) {
  ++file_count_;
  if (options.view) return add_view(path, options, common);
  const LevelOptions& one = options.level;
  const bool whole = std::ranges::all_of(options.ratios, [](double r) { return r == 1; }) &&
                     !one.triangles && !one.ratio && !one.error;
  if (whole && !is_crease_file(path) && !options.errors_of_positions) {
    Result<Mesh> mesh = load_mesh(path, options.read, common);  // nothing to simplify
    if (!mesh.ok()) return mesh.failure();
    learn_up(mesh->up);
    Source source;
    source.arrays = std::make_unique<MeshDrawArrays>(*mesh);
    const std::string name = path.filename().string();
    add(std::move(source), name + ": " + grouped(mesh->triangle_count()) + " triangles",
        {{"triangles", mesh->triangle_count()}, {"control", false}}, options, 0.0f);
    if (options.control) add_control(*mesh, name, options, 0.0f);
    return Done{};
  }

  const Result<ModelFile> file = open_model(path, options.read, common);
  if (!file.ok()) return file.failure();
  learn_up(file->blocks().facts().up);
  const std::size_t full_count = file->triangle_count();
  const std::vector<LevelOptions> levels = levels_of(options, full_count);
  const auto needed = options.errors_of_positions ? std::nullopt : triangles_needed(levels);
  Result<Model> model = file->load({.triangles = needed, .part_names = false});
  if (!model.ok()) return model.failure();
  bytes_read_ += model->bytes_read;
  Result<std::vector<ImageFile>> images = file->images(model->decoded.mesh.materials);
  if (!images.ok()) return images.failure();
  model->decoded.mesh.images = *std::move(images);
  const Mesh& full = model->decoded.mesh;
  const ProgressiveArraysPtr arrays =
      build_progressive_arrays(model->decoded.mesh, model->decoded.sequence);
  struct Control {
    std::string name;
    Mesh mesh;
    float level_share = 0;
  };
  std::vector<Control> controls;
  for (const LevelOptions& level : levels) {
    ProgressiveMesh mesh(arrays);
    const Result<Chosen> chosen = choose_level(mesh, full, level, common);
    if (!chosen.ok()) return chosen.failure();
    const std::string of_file = options.file_names ? file->name() + ", " : "";
    if (!chosen->target_met) log(common, of_file + shortfall_of(mesh.triangle_count()));
    const std::string name = of_file + level_name(mesh, full_count);
    if (options.control) {
      controls.push_back({name, mesh.extract()});
      controls.back().mesh.images = full.images;
    }
    add_level(std::move(mesh), full, full_count, name, options, common);
    if (options.control) controls.back().level_share = panels_.back().level_share;
    if (interrupted()) return interrupted_failure();
  }
  for (const Control& c : controls) add_control(c.mesh, c.name, options, c.level_share);
  return Done{};
}

}  // namespace crease::cli
