#include "view/shown_whole.h"

#include "crease/build_hierarchy.h"
#include "crease/build_progressive_arrays.h"
#include "crease/decode_model.h"
#include "crease/threads.h"
#include "view/level_walk.h"
#include "view/whole_creases.h"
#include "view/words.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <utility>

namespace crease {

namespace {

// Of a frame, for moving the cut; what is left is done by the next ones.
constexpr double kUpdateSeconds = 0.012;

double seconds_now(void*) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// How long the last frame took, for what is on its way. A frame that took long is a short one: so
// is what is seen of it.
class FrameTime {
 public:
  double seconds() {
    const double now = seconds_now(nullptr), last = std::exchange(last_, now);
    return last < 0 ? 0 : std::min(now - last, kLongest);
  }

 private:
  static constexpr double kLongest = 0.05;
  double last_ = -1;
};

double distance_to(const Box& box, const Vec3d& eye) {
  double square = 0;
  for (int i = 0; i < 3; ++i) {
    const double off = std::max({box.low[i] - eye[i], eye[i] - box.high[i], 0.0});
    square += off * off;
  }
  return std::sqrt(square);
}

constexpr double kCells = 48;  // along the longest side of the model

// Of the triangles whose middles are in one cell of a grid.
std::vector<Box> parts_of(const Mesh& mesh, const Box& whole) {
  const Vec3d sides = whole.high - whole.low;
  const double cell = std::max({sides.x, sides.y, sides.z, 1e-300}) / kCells;
  std::map<std::array<int, 3>, Box> parts;
  for (const Triangle& t : mesh.triangles) {
    Vec3d middle;
    for (const VertexId v : t) middle = middle + mesh.positions[index_of(v)] * (1.0 / 3);
    std::array<int, 3> place{};
    for (int i = 0; i < 3; ++i) place[std::size_t(i)] = int((middle[i] - whole.low[i]) / cell);
    Box& part = parts[place];
    for (const VertexId v : t) part.add(mesh.positions[index_of(v)]);
  }
  std::vector<Box> boxes;
  for (const auto& [place, box] : parts) boxes.push_back(box);
  return boxes;
}

float share_of(std::size_t full, std::size_t base, std::size_t shown) {
  if (full <= base || base == 0) return 0;
  const double share = std::log(double(full) / double(std::max(shown, base))) /
                       std::log(double(full) / double(base));
  return float(std::clamp(share, 0.0, 1.0));
}

std::vector<Vec3f> used_positions(const DrawList& list) {
  std::vector<Vec3f> used;
  for (const DrawPart* part : {&list.sn, &list.fn, &list.nsn}) {
    for (const std::uint32_t i : part->indices) used.push_back(list.positions[i]);
  }
  return used;
}

DrawStyle styled(DrawStyle style, ViewColoring coloring, float level_share) {
  if (coloring == ViewColoring::Kind) style.coloring = Coloring::Kind;
  if (coloring == ViewColoring::Level) style.coloring = Coloring::Level;
  if (coloring == ViewColoring::Error) style.coloring = Coloring::Error;
  style.level_share = level_share;
  return style;
}

std::string in_words(std::size_t shown, std::size_t full) {
  return grouped(shown) + " of " + grouped(full) + " triangles";
}

// What both have.
class ShownWhole : public ShownMesh {
 public:
  ShownWhole(const DrawList& list, const WholeData& data, const GlMaterialsPtr& materials)
      : scene_(list, {}, materials, GL_DYNAMIC_DRAW),
        box_(data.box),
        parts_(data.parts),
        materials_(materials),
        origin_(list.origin) {}

  Vec3d origin() const override { return origin_; }
  Box box() const override { return box_; }

 protected:
  // `list`: what is shown now.
  void update_creases(const ViewSettings& settings, const DrawList& list, FrameFacts& facts) {
    if (!settings.creases) return creases_.forget();
    const std::size_t uploaded = creases_.update(list, facts.has_changed);
    facts.uploaded_bytes += uploaded;
    facts.has_changed |= uploaded > 0;
    facts.gpu_bytes += creases_.bytes();
    facts.is_complete &= !creases_.is_behind();
  }

  Result<DrawCount> draw_scene(ProgramCache& programs, const DrawPass& pass,
                               const DrawStyle& style) const {
    if (const Status drawn = scene_.draw(programs, pass, style); !drawn.ok()) {
      return drawn.failure();
    }
    if (const Status drawn = creases_.draw(programs, pass, style); !drawn.ok()) {
      return drawn.failure();
    }
    const DrawRanges all = scene_.all();
    const auto calls = (all.sn.count > 0) + (all.fn.count > 0) + (all.nsn.count > 0);
    return DrawCount{std::size_t(calls), all.triangle_count()};
  }

  // On the GPU, but for creases.
  std::size_t scene_bytes() const { return scene_.bytes() + materials_->bytes(); }

  GlScene scene_;
  const Box box_;
  const std::vector<Box> parts_;

 private:
  const GlMaterialsPtr materials_;
  const Vec3d origin_;
  WholeCreases creases_;
};

class ShownVertices final : public ShownWhole {
 public:
  ShownVertices(std::unique_ptr<AdaptiveMesh> mesh, const WholeData& data,
                const GlMaterialsPtr& materials)
      : ShownWhole(mesh->draw_list(), data, materials),
        mesh_(std::move(mesh)),
        hierarchy_bytes_(hierarchy_bytes(mesh_->hierarchy()).total()) {}

  FrameFacts update(const ViewSettings& settings, const Camera& camera) override {
    ViewParameters view;
    view.camera = camera;
    view.camera.pixels = settings.pixels;
    view.degrees = settings.degrees;
    view.max_triangles = settings.max_triangles;
    view.max_seconds = kUpdateSeconds;
    view.clock = seconds_now;
    mesh_->set_geomorph_seconds(settings.geomorph_seconds);
    const UpdateReport report = mesh_->update(view, time_.seconds());
    FrameFacts facts;
    facts.is_moving = report.moving > 0;
    facts.has_changed = report.splits + report.merges > 0 || facts.is_moving || was_moving_;
    was_moving_ = facts.is_moving;
    if (facts.has_changed) {
      facts.uploaded_bytes = scene_.update(mesh_->draw_list(), mesh_->changes());
      painted_ = ViewColoring::Shaded;
    }
    facts.triangles = mesh_->triangle_count();
    facts.error_pixels = worst_error(camera, settings);
    facts.gpu_bytes = scene_bytes();
    facts.resident_bytes = mesh_->active_bytes() + hierarchy_bytes_;
    facts.is_complete = report.complete && !facts.is_moving;
    update_creases(settings, mesh_->draw_list(), facts);
    return facts;
  }

  Result<DrawCount> draw(ProgramCache& programs, const DrawPass& pass, DrawStyle style,
                         const ViewSettings& settings, const Camera& cut_camera) override {
    style = styled(style, settings.coloring, 0);  // levels are by position
    set_scalars(settings.coloring, cut_camera);
    style.error_full = float(2 * settings.pixels);
    return draw_scene(programs, pass, style);
  }

  std::optional<Hit> pick(const Ray& ray) const override {
    return crease::pick(mesh_->draw_list(), ray);
  }
  HitFacts facts_of(const Hit& hit) const override {
    const DrawList list = mesh_->draw_list();
    const std::vector<float> errors = mesh_->error_of_position();
    HitFacts facts{in_words(mesh_->triangle_count(), mesh_->hierarchy().vertices.triangles.size()),
                   {},
                   name_of(mesh_->part_of(hit.kind, hit.triangle), mesh_->hierarchy().parts)};
    const DrawPart& part = part_of_kind(list, hit.kind);
    for (std::size_t c = 0; c < 3; ++c) {
      const float error = errors[part.indices[3 * std::size_t(hit.triangle) + c]];
      facts.error.surface = std::max(facts.error.surface, error);
    }
    return facts;
  }
  std::vector<Vec3f> outline() const override { return used_positions(mesh_->draw_list()); }

 private:
  // Bounds of what the cut allows: an update that is complete leaves no more.
  double worst_error(const Camera& camera, const ViewSettings& settings) {
    if (settings.max_triangles == std::numeric_limits<std::size_t>::max()) return settings.pixels;
    return in_pixels(mesh_->error(), camera, std::max(distance_to(parts_, camera.position), 1e-9));
  }

  // What `coloring` paints; errors are in pixels of `camera`.
  void set_scalars(ViewColoring coloring, const Camera& camera) {
    const bool by_error = coloring == ViewColoring::Error;
    if (!by_error && coloring != ViewColoring::Level) return;
    if (coloring == painted_ && (!by_error || camera == errors_camera_)) return;
    scene_.set_scalars(by_error ? errors_in_pixels(camera) : mesh_->level_of_position());
    errors_camera_ = camera;
    painted_ = coloring;
  }

  std::vector<float> errors_in_pixels(const Camera& camera) const {
    const DrawList list = mesh_->draw_list();
    std::vector<float> errors = mesh_->error_of_position();
    for (std::size_t i = 0; i < errors.size(); ++i) {
      const Vec3f& p = list.positions[i];
      const Vec3d to = list.origin + Vec3d{p.x, p.y, p.z} - camera.position;
      errors[i] = float(double(errors[i]) / pixel_size(camera, std::max(length(to), 1e-12)));
    }
    return errors;
  }

  std::unique_ptr<AdaptiveMesh> mesh_;
  const std::size_t hierarchy_bytes_;
  FrameTime time_;
  bool was_moving_ = false;
  ViewColoring painted_ = ViewColoring::Shaded;  // what the scene's scalars are for; or none
  Camera errors_camera_;
};

class ShownLinear final : public ShownWhole {
 public:
  ShownLinear(std::unique_ptr<ProgressiveMesh> mesh, const WholeData& data,
              const GlMaterialsPtr& materials)
      : ShownWhole(mesh->draw_list(), data, materials), mesh_(std::move(mesh)) {}

  // One level everywhere: as fine as the nearest part of the model needs it, and all of it inside
  // of one.
  FrameFacts update(const ViewSettings& settings, const Camera& camera) override {
    const double distance = distance_to(parts_, camera.position);
    const double wanted = distance > 0 ? settings.pixels * pixel_size(camera, distance) : -1;
    FrameFacts facts;
    const std::size_t before = mesh_->applied();
    const double seconds = time_.seconds();
    bool has_moved = mesh_->is_moving();
    if (has_moved) {
      mesh_->advance(seconds);
      take_changes(facts);
    }
    const LevelGoal goal{float(wanted), settings.max_triangles};
    if (!mesh_->is_moving() || !(goal == goal_)) {
      goal_ = goal;
      mesh_->set_geomorph_seconds(is_near(goal) ? settings.geomorph_seconds : 0);
      facts.is_complete = walk_.go(*mesh_, goal, kUpdateSeconds, [&] { take_changes(facts); });
    }
    facts.is_moving = mesh_->is_moving();
    facts.is_complete &= !facts.is_moving;
    has_moved |= facts.is_moving;
    facts.has_changed = mesh_->applied() != before || has_moved;
    facts.triangles = mesh_->triangle_count();
    facts.error_pixels = in_pixels(mesh_->error(), camera, std::max(distance, 1e-9));
    facts.gpu_bytes = scene_bytes();
    facts.resident_bytes = scene_.bytes();
    update_creases(settings, mesh_->draw_list(), facts);
    return facts;
  }

  Result<DrawCount> draw(ProgramCache& programs, const DrawPass& pass, DrawStyle style,
                         const ViewSettings& settings, const Camera& cut_camera) override {
    style = styled(style, settings.coloring,
                   share_of(mesh_->full_triangle_count(), mesh_->base_triangle_count(),
                            mesh_->triangle_count()));
    if (settings.coloring == ViewColoring::Error) {
      const double distance = std::max(distance_to(parts_, cut_camera.position), 1e-9);
      const double pixels = in_pixels(mesh_->error(), cut_camera, distance);
      style.surface = error_color(float(std::min(1.0, pixels / (2 * settings.pixels))));
    }
    return draw_scene(programs, pass, style);
  }

  std::optional<Hit> pick(const Ray& ray) const override {
    return crease::pick(mesh_->draw_list(), ray);
  }
  HitFacts facts_of(const Hit& hit) const override {
    return {in_words(mesh_->triangle_count(), mesh_->full_triangle_count()), mesh_->error(),
            name_of(mesh_->part_of(hit.kind, hit.triangle), mesh_->arrays().parts)};
  }
  std::vector<Vec3f> outline() const override { return used_positions(mesh_->draw_list()); }

 private:
  // Whether one step of the walk leads there: then it goes by a geomorph. A budget of triangles
  // that may be met is looked for step by step.
  bool is_near(const LevelGoal& goal) const {
    if (goal.max_triangles < mesh_->full_triangle_count()) return false;
    const std::size_t now = mesh_->applied(), there = mesh_->applied_for_view(goal.error);
    return std::max(now, there) - std::min(now, there) <= LevelWalk::kStep;
  }

  void take_changes(FrameFacts& facts) {
    facts.uploaded_bytes += scene_.update(mesh_->draw_list(), mesh_->changes());
  }

  std::unique_ptr<ProgressiveMesh> mesh_;
  LevelWalk walk_;
  LevelGoal goal_;
  FrameTime time_;
};

std::size_t largest_array(const DrawList& list) {
  return std::max({list.positions.size(), list.sn.indices.size(), list.fn.indices.size(),
                   list.nsn.indices.size()});
}

}  // namespace

double distance_to(std::span<const Box> parts, const Vec3d& eye) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Box& part : parts) nearest = std::min(nearest, distance_to(part, eye));
  return nearest;
}

Result<WholeModel> load_whole(const ModelSource& model, ViewMode mode, Note& note) {
  note.say("loading the whole model", 0);
  const Result<BlockFile> file = open_again(model, note);
  if (!file.ok()) return file.failure();
  Result<DecodedModel> decoded = decode_model(*file, {.for_each = loop_on_threads(1)});
  if (!decoded.ok()) return decoded.failure();
  if (note.is_stopped()) return fail(Error::Interrupted, "interrupted");
  WholeData data;
  for (const Vec3d& p : decoded->mesh.positions) data.box.add(p);
  data.parts = parts_of(decoded->mesh, data.box);
  if (mode == ViewMode::Linear) {
    note.say("sorting the levels");
    data.levels = build_progressive_arrays(decoded->mesh, decoded->sequence);
  } else {
    note.say("building the hierarchy");
    Result<MeshHierarchy> hierarchy = build_hierarchy(decoded->mesh, decoded->sequence, {});
    if (!hierarchy.ok()) return hierarchy.failure();
    data.hierarchy = std::make_shared<const MeshHierarchy>(*std::move(hierarchy));
  }
  WholeModel whole = mesh_of(std::move(data));
  whole.bytes_read = file->source().bytes_read();
  return whole;
}

WholeModel mesh_of(WholeData data) {
  WholeModel whole;
  if (data.levels) whole.linear = std::make_unique<ProgressiveMesh>(data.levels);
  if (data.hierarchy) whole.vertices = std::make_unique<AdaptiveMesh>(data.hierarchy);
  whole.data = std::move(data);
  return whole;
}

Result<std::unique_ptr<ShownMesh>> show_whole(WholeModel model, const GlLimits& limits,
                                              GlMaterialsPtr materials) {
  const std::size_t largest = model.linear
                                  ? largest_array(model.linear->draw_list())
                                  : 3 * model.vertices->hierarchy().vertices.triangles.size();
  if (largest > std::size_t(limits.max_texel_count)) {
    return fail(Error::OverLimit, "the whole model has arrays of " + std::to_string(largest) +
                                      " elements, this device draws " +
                                      std::to_string(limits.max_texel_count));
  }
  if (model.linear) {
    return std::unique_ptr<ShownMesh>(
        std::make_unique<ShownLinear>(std::move(model.linear), model.data, materials));
  }
  return std::unique_ptr<ShownMesh>(
      std::make_unique<ShownVertices>(std::move(model.vertices), model.data, materials));
}

}  // namespace crease
