// The picture's halves: where they are, what each shows, and the divider between them.
#include "view/app.h"
#include "view/split_of.h"
#include "view/words.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace crease {

namespace {

constexpr double kLeastShare = 0.1;  // of the width
constexpr int kDividerPx = 2;
constexpr double kGrabPx = 6;  // from the divider's middle

}  // namespace

SplitSettings split_of(const ViewerOptions& options) {
  SplitSettings split;
  split.kind = options.split;
  split.divider = std::clamp(options.divider, kLeastShare, 1 - kLeastShare);
  const HalfSettings& right = options.right;
  split.right.mode = right.mode;
  split.right.vertices_in_blocks = right.vertices_in_blocks;
  split.right.coloring = right.coloring;
  split.right.wireframe = right.wireframe;
  split.right.creases = right.creases;
  split.right.ambient_occlusion = right.ambient_occlusion;
  split.right.pixels = right.pixels;
  split.right.degrees = right.degrees;
  split.right.max_triangles = right.max_triangles;
  split.right.max_bytes = options.max_bytes;
  return split;
}

std::pair<int, int> App::size_px() const {
  const std::pair<int, int> now = window_.size_px();
  if (now.first > 0 && now.second > 0) last_size_px_ = now;
  return last_size_px_;
}

App::Columns App::columns_of(std::size_t side) const {
  const int width = std::max(1, size_px().first);
  if (side_count() == 1) return {0, width};
  const int left = std::clamp(int(std::lround(split_.divider * width)), 1, std::max(1, width - 1));
  return side == 0 ? Columns{0, left} : Columns{left, std::max(1, width - left)};
}

Camera App::sized(Camera camera, std::size_t side) const {
  camera.width_px = columns_of(side).width;
  camera.height_px = std::max(1, size_px().second);
  return camera;
}

ViewSettings App::settings_of(std::size_t side) const {
  if (side == 0) return settings_;
  if (split_.kind == ViewSplit::Settings) return split_.right;
  ViewSettings original = settings_;
  original.mode = ViewMode::Blocks;
  original.is_original = true;
  original.degrees = 0;
  original.max_triangles = std::numeric_limits<std::size_t>::max();
  return original;
}

ViewSettings& App::edited() {
  const bool is_right = split_.kind == ViewSplit::Settings && split_.edits_right;
  return is_right ? split_.right : settings_;
}

bool App::poll_session() {
  std::array<ViewSettings, 2> sides{settings_, settings_of(1)};
  const bool is_new = session_.poll(std::span(sides).first(side_count()), canvas_.limits());
  settings_.mode = sides[0].mode;
  if (split_.kind == ViewSplit::Settings) split_.right.mode = sides[1].mode;
  return is_new;
}

// What the graphs and the end of a screenshot need to know is of both.
void App::update_right() {
  ShownMesh* mesh = session_.shown(1);
  if (mesh == nullptr) {
    right_frame_ = {};
    return;
  }
  ViewSettings wanted = settings_of(1);
  if (is_fitted_ && frame_.triangles == 0) wanted.max_triangles = 0;
  right_frame_ = mesh->update(wanted, sized(frozen_.value_or(camera_), 1));
  frame_.uploaded_bytes += right_frame_.uploaded_bytes;
  frame_.gpu_bytes += right_frame_.gpu_bytes;
  frame_.resident_bytes = std::max(frame_.resident_bytes, right_frame_.resident_bytes);
  frame_.pending_bytes = std::max(frame_.pending_bytes, right_frame_.pending_bytes);
  frame_.has_changed |= right_frame_.has_changed;
  frame_.is_complete &= right_frame_.is_complete;
}

Status App::draw_sides() {
  std::size_t calls = 0;
  for (std::size_t side = 0; side < side_count(); ++side) {
    ShownMesh* mesh = session_.shown(side);
    if (mesh == nullptr) continue;
    const Columns columns = columns_of(side);
    canvas_.set_columns(columns.left, columns.width);
    const Picture picture{sized(camera_, side), sized(frozen_.value_or(camera_), side),
                          window_.scale()};
    const Result<DrawCount> count = paint(canvas_, *mesh, picture, settings_of(side), lines());
    if (!count.ok()) return count.failure();
    calls += count->calls;
  }
  frame_.draw_calls = calls;
  if (side_count() > 1) {
    canvas_.fill_columns(columns_of(1).left - kDividerPx / 2, kDividerPx, kDividerColor);
  }
  return Done{};
}

std::size_t App::side_at(double x) const {
  return side_count() > 1 && x >= columns_of(1).left ? 1 : 0;
}

std::optional<Hit> App::hit_at(double x, double y) const {
  const ShownMesh* mesh = session_.shown(side_at(x));
  return mesh == nullptr ? std::nullopt : mesh->pick(ray_at(x, y));
}

Ray App::ray_at(double x, double y) const {
  const std::size_t side = side_at(x);
  return ray_through(sized(camera_, side), x - columns_of(side).left, y);
}

std::vector<HalfLabel> App::half_labels() const {
  std::vector<HalfLabel> labels;
  for (std::size_t side = 0; side < side_count(); ++side) {
    const ViewSettings settings = settings_of(side);
    const std::size_t triangles = (side == 0 ? frame_ : right_frame_).triangles;
    const std::string what =
        settings.is_original
            ? std::string("original")
            : kCutNames[settings.cut()] + (", " + in_digits(settings.pixels)) + " pixels";
    const bool is_edited = split_.kind != ViewSplit::Settings || split_.edits_right == (side == 1);
    labels.push_back({what + ", " + grouped(triangles) + " triangles",
                      float(columns_of(1).left) / float(std::max(1, size_px().first)), side == 1,
                      is_edited});
  }
  return labels;
}

// True if the event is the divider's and nobody else's.
bool App::take_divider(const WindowEvent& event) {
  if (side_count() == 1) return std::exchange(drags_divider_, false);
  if (event.kind == WindowEvent::Kind::Button && event.code == 0) {
    const bool was_dragging = drags_divider_;
    drags_divider_ = event.is_down && std::abs(event.x - columns_of(1).left) <= kGrabPx;
    return was_dragging || drags_divider_;
  }
  if (event.kind != WindowEvent::Kind::Move || !drags_divider_) return false;
  const double share = event.x / std::max(1, size_px().first);
  split_.divider = std::clamp(share, kLeastShare, 1 - kLeastShare);
  return true;
}

}  // namespace crease
