// What the user does, and what is told about it.
#include "view/app.h"
#include "view/camera_moves.h"
#include "view/words.h"

#include <algorithm>
#include <utility>

namespace crease {

namespace {

std::string name_of(TriangleKind kind) {
  switch (kind) {
    case TriangleKind::SN:
      return "SN: shared normals";
    case TriangleKind::FN:
      return "FN: one normal";
    case TriangleKind::NSN:
      return "NSN: three normals";
  }
  return {};
}

std::string in_words(const LevelError& error, double pixels) {
  std::string words =
      in_digits(double(std::max(error.surface, error.line))) + ", " + in_digits(pixels) + " pixels";
  if (error.degrees > 0) words += ", " + in_digits(double(error.degrees)) + " degrees";
  return words;
}

// `block`: where by block the same place is, or empty.
Lines lines_of(const Hit& hit, const HitFacts& facts, const std::string& block, double pixels) {
  Lines lines;
  if (!block.empty()) lines.emplace_back("block", block);
  lines.emplace_back("level", facts.level);
  lines.emplace_back("error", in_words(facts.error, pixels));
  lines.emplace_back("kind", name_of(hit.kind));
  lines.emplace_back("triangle", grouped(hit.triangle) + " of its kind");
  lines.emplace_back("normal", in_digits(Vec3d{hit.normal.x, hit.normal.y, hit.normal.z}));
  lines.emplace_back("position", in_digits(hit.position));
  if (!hit.material.empty()) lines.emplace_back("material", hit.material);
  if (!facts.part.empty()) lines.emplace_back("part", facts.part);
  return lines;
}

}  // namespace

void App::take_events() {
  for (const WindowEvent& event : window_.take_events()) take_event(event);
  if (const std::optional<Click> click = input_.take_click()) take_click(*click);
}

void App::take_event(const WindowEvent& event) {
  draws_left_ = kSettlingFrames;
  if (event.kind == WindowEvent::Kind::Drop) {
    if (event.paths.empty()) return;
    if (event.paths.size() > 1) say("opens the first of " + std::to_string(event.paths.size()));
    return open(event.paths.front());
  }
  if (event.kind == WindowEvent::Kind::Key) {
    if (!event.is_down || gui_.wants_keys()) return;
    if (const std::optional<Action> action = action_of(event.code)) act(*action);
    return;
  }
  const bool is_press = event.kind == WindowEvent::Kind::Button && event.is_down;
  if ((is_press || event.kind == WindowEvent::Kind::Scroll) && gui_.wants_mouse() &&
      !input_.is_flying()) {
    return;
  }
  if (!input_.is_flying() && take_divider(event)) return;
  const auto point_under = [this](double x, double y) -> std::optional<Vec3d> {
    const std::optional<Hit> hit = hit_at(x, y);
    if (!hit) return std::nullopt;
    return hit->position;
  };
  if (!input_.take(event, now(), camera_, point_under)) return;
  is_fitted_ = false;
  if (flight_began_) flight_began_ = -1e9;  // the user takes over
}

void App::take_click(const Click& click) {
  picked_ = hit_at(click.x, click.y);
  if (!picked_) return;
  const std::size_t side = side_at(click.x);
  const HitFacts facts = session_.shown(side)->facts_of(*picked_);
  const Camera cut_camera = sized(frozen_.value_or(camera_), side);
  const double distance = length(picked_->position - cut_camera.position);
  picked_lines_ = lines_of(*picked_, facts, block_at(click.x, click.y),
                           in_pixels(facts.error, cut_camera, std::max(distance, 1e-12)));
  picked_->block = nullptr;  // it may go while the lines stay
  if (click.is_double) camera_ = retargeted(camera_, picked_->position);
}

// Of what is shown, or of what was last there by block; empty where nothing has streamed.
std::string App::block_at(double x, double y) const {
  const std::size_t side = side_at(x);
  const ShownBlocks* blocks = session_.blocks(side);
  if (blocks == nullptr) return {};
  const std::optional<Hit> hit = blocks->pick(ray_at(x, y));
  if (!hit) return {};
  const std::string number = std::to_string(index_of(hit->block->id()));
  return session_.shown(side) == blocks ? number : number + ", if it were by block";
}

PanelContent App::panel_content() const {
  PanelContent content;
  content.model = session_.facts();
  if (content.model != nullptr) content.source = &session_.source();
  content.bytes_read = session_.bytes_read();
  content.frame = frame_;
  content.histories = &histories_;
  if (picked_) content.picked = picked_lines_;
  content.message = session_.message();
  content.notice = notice_;
  if (side_count() > 1) content.halves = half_labels();
  content.switches = switches_;
  content.switches.is_flying = input_.is_flying();
  content.switches.is_frozen = frozen_.has_value();
  content.switches.is_recording = recorder_.is_on();
  return content;
}

}  // namespace crease
