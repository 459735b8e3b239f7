#include "view/app.h"

#include "view/remembered_views.h"
#include "view/split_of.h"
#include "view/words.h"
#include "view/write_text.h"

#include <algorithm>
#include <utility>

namespace crease {

namespace {

constexpr int kFitsInARow = 3;
constexpr double kSameView = 1e-3;  // of the distance
constexpr double kNoticeSeconds = 4;
constexpr double kStreamPause = 2;  // times the last frame's time
constexpr double kBusySeconds = 0.01, kIdleSeconds = 0.1;
constexpr std::size_t kTries = 3;  // of blocks that fail, before a picture is given up

template <typename Enum>
Enum next_of(Enum value, int count) {
  return Enum((int(value) + 1) % count);
}

}  // namespace

App::App(const ViewerOptions& options, ViewerWindow& window, GlCanvas canvas)
    : options_(options),
      window_(window),
      canvas_(std::move(canvas)),
      gui_(window),
      session_(options) {
  settings_.mode = options.mode;
  settings_.coloring = options.coloring;
  settings_.wireframe = options.wireframe;
  settings_.creases = options.creases;
  settings_.ambient_occlusion = options.ambient_occlusion;
  settings_.vertices_in_blocks = options.vertices_in_blocks;
  settings_.pixels = options.pixels;
  settings_.degrees = options.degrees;
  settings_.max_triangles = options.max_triangles;
  settings_.max_bytes = options.max_bytes;
  split_ = split_of(options);
  stream_.max_bytes_per_second = options.max_bytes_per_second;
  camera_.up = options.up.value_or(camera_.up);
  if (!options.source.empty()) session_.open(options.source);
}

double App::now() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void App::say(std::string notice) {
  notice_ = std::move(notice);
  notice_until_ = now() + kNoticeSeconds;
  draws_left_ = kSettlingFrames;
}

void App::open(const std::string& source) {
  remember();
  session_.open(source);
  draws_left_ = kSettlingFrames;
}

// Pictures on the disk are to be the same whoever looked at the model before.
void App::remember() {
  if (session_.facts() == nullptr || is_fitted_ || !options_.screenshot.empty()) return;
  const Status done = remember_view(session_.source().source, frozen_.value_or(camera_));
  if (!done.ok()) say(done.failure().message);
}

void App::welcome() {
  frozen_.reset();
  picked_.reset();
  frame_ = {};
  std::optional<Camera> camera;
  if (is_first_) camera = options_.camera;
  if (!camera && options_.screenshot.empty()) camera = remembered_view(session_.source().source);
  is_first_ = false;
  is_fitted_ = !camera.has_value();
  fits_left_ = kFitsInARow;
  if (camera) {
    camera_ = *camera;
    // A picture of another shape shows at least what the camera's own does.
    const Camera shown = sized(camera_);
    if (window_.size_px().second > 0) {
      const View view = make_view(camera_, double(shown.width_px) / shown.height_px);
      camera_.vertical_fov_deg = degrees(2 * std::atan(view.tan_half_height));
    }
  }
  window_.set_title(session_.source().name + " - crease");
}

void App::fit() {
  ShownMesh* mesh = session_.shown();
  if (mesh == nullptr) return;
  const std::vector<Vec3f> points = mesh->outline();
  if (points.empty()) return;
  const PointSet set{mesh->origin(), points};
  Camera narrowest = camera_;
  for (std::size_t side = 0; side < side_count(); ++side) {
    const Camera of_side = sized(camera_, side);
    if (of_side.width_px < narrowest.width_px) narrowest = of_side;
  }
  const ModelFacts* facts = session_.facts();
  const Vec3d up =
      options_.up.value_or(direction_of(facts == nullptr ? UpAxis::Unknown : facts->up));
  camera_ = fit_camera_to(std::span(&set, 1), up, narrowest.width_px, narrowest.height_px);
}

// A cut for another camera has another outline, so this might go on for ever. The outline of a
// whole model takes its time, so that it waits for the cut's end.
bool App::fit_again() {
  if (settings_.mode != ViewMode::Blocks && !frame_.is_complete) return false;
  if (frame_.uploaded_bytes > 0) fits_left_ = kFitsInARow;
  if (fits_left_ == 0) return false;
  --fits_left_;
  const Camera before = camera_;
  fit();
  const double distance = length(camera_.position - camera_.target);
  if (length(before.position - camera_.position) > kSameView * distance ||
      length(before.target - camera_.target) > kSameView * distance) {
    return true;
  }
  camera_ = before;
  return false;
}

void App::move_camera() {
  const double time = now(), seconds = std::min(0.1, time - std::exchange(last_step_, time));
  ShownMesh* mesh = session_.shown();
  if (mesh == nullptr || frame_.triangles == 0) return;
  const Box box = mesh->box();
  if (input_.fly(seconds, window_, length(box.high - box.low), camera_)) {
    is_fitted_ = false;
    draws_left_ = std::max(draws_left_, 1);
  }
  if (!options_.flight.empty() && !flight_began_) flight_began_ = time;
  if (flight_began_ && time - *flight_began_ <= options_.flight.back().seconds + 0.5) {
    camera_ = sized(camera_of(options_.flight, time - *flight_began_));
    is_fitted_ = false;
    draws_left_ = std::max(draws_left_, 1);
  }
  recorder_.add(camera_, time);
}

Status App::step() {
  window_.wait(wait_seconds());
  const std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now();
  if (options_.stopped && options_.stopped()) window_.close();
  camera_ = sized(camera_);
  take_events();
  if (poll_session()) welcome();
  move_camera();
  session_.limit().set(stream_.max_bytes_per_second);
  if (ShownMesh* mesh = session_.shown()) {
    ViewSettings wanted = settings_;
    const bool knows_where = !is_fitted_ || frame_.triangles > 0;
    if (!knows_where) wanted.max_triangles = 0;  // the coarsest there is, to fit the camera to
    const std::size_t calls = frame_.draw_calls;
    const std::size_t not_drawn = has_arrived_ ? frame_.uploaded_bytes : 0;
    const bool was_complete = frame_.is_complete;
    frame_ = mesh->update(wanted, sized(frozen_.value_or(camera_)));
    frame_.draw_calls = calls;
    frame_.uploaded_bytes += not_drawn;
    frame_.has_changed |= std::exchange(last_shown_, mesh) != mesh;
    update_right();
    const bool has_become_complete = frame_.is_complete && !was_complete;
    const bool may_be_larger = frame_.has_changed || has_become_complete || !knows_where;
    if (is_fitted_ && may_be_larger && fit_again()) {
      frame_.has_changed = true;
      frame_.is_complete = false;  // not for this camera
    }
    if (frame_.is_complete != was_complete) frame_.has_changed = true;
  }
  frame_.bytes_per_second = pace_.add(now(), session_.bytes_transferred());
  if (!is_drawing_due()) return finish_screenshot();
  const auto [width, height] = window_.size_px();
  if (width == 0 || height == 0) return Done{};
  if (const Status drawn = draw(); !drawn.ok()) return drawn;
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
  histories_.add(took.count(), frame_);
  stream_draw_at_ = now() + kStreamPause * took.count() / 1000;
  return finish_screenshot();
}

bool App::is_drawing_due() {
  if (!notice_.empty() && now() > notice_until_) say("");
  has_arrived_ |= frame_.has_changed || session_.is_busy() || session_.has_repainted();
  if (has_arrived_ && (frame_.is_complete || frame_.is_moving || now() >= stream_draw_at_)) {
    draws_left_ = std::max(draws_left_, 1);
  }
  if (draws_left_ == 0) return false;
  --draws_left_;
  has_arrived_ = false;
  return true;
}

Status App::draw() {
  const auto [width, height] = window_.size_px();
  if (const Status begun = canvas_.begin(width, height); !begun.ok()) return begun;
  if (const Status drawn = draw_sides(); !drawn.ok()) return drawn;
  if (const Status shown = canvas_.show(); !shown.ok()) return shown;
  gui_.begin();
  const ViewSettings before = settings_;
  const SplitSettings split_before = split_;
  for (const Action action : draw_panels(panel_content(), edited(), split_, stream_)) act(action);
  if (!(before == settings_ && split_before == split_)) draws_left_ = kSettlingFrames;
  gui_.draw();
  if (window_picture_) window_picture_ = canvas_.read_window();
  window_.show();
  return Done{};
}

std::vector<Segment> App::lines() const {
  std::vector<Segment> all;
  if (frozen_) all = frustum_;
  if (picked_) {
    for (std::size_t c = 0; c < 3; ++c) {
      all.push_back({picked_->corners[c], picked_->corners[(c + 1) % 3]});
    }
  }
  return all;
}

double App::wait_seconds() const {
  if (draws_left_ > 0 || input_.is_flying() || frame_.is_moving) return 0;
  const bool is_streaming = session_.shown() != nullptr && !frame_.is_complete;
  return is_streaming || flight_began_ ? kBusySeconds : kIdleSeconds;
}

void App::freeze(bool on) {
  ShownMesh* mesh = session_.shown();
  if (!on || mesh == nullptr) {
    frozen_.reset();
    return;
  }
  frozen_ = camera_;
  is_fitted_ = false;
  const std::vector<Vec3f> points = mesh->outline();
  const PointSet set{mesh->origin(), points};
  frustum_ = frustum_lines(std::span(&set, 1), camera_);
}

void App::look_from_outside() {
  ShownMesh* mesh = session_.shown();
  if (mesh == nullptr) return;
  if (!frozen_) freeze(true);
  const std::vector<Vec3f> points = mesh->outline();
  const PointSet set{mesh->origin(), points};
  camera_ = fit_outside(std::span(&set, 1), *frozen_, camera_.width_px, camera_.height_px);
}

void App::write_picture() {
  const std::string stem = session_.facts() == nullptr
                               ? std::string("crease")
                               : std::filesystem::path(session_.source().name).stem().string();
  const std::filesystem::path path = unused_path({}, stem, ".png");
  const Result<Image> image = canvas_.read();
  const Status written = image.ok() ? write_png(*image, path) : Status(image.failure());
  say(written.ok() ? "wrote " + path.string() : written.failure().message);
}

void App::toggle_recording() {
  if (!recorder_.is_on()) {
    recorder_.start();
    return;
  }
  const Flight flight = recorder_.stop();
  if (flight.empty()) return;
  const std::string stem = std::filesystem::path(session_.source().name).stem().string();
  const std::filesystem::path path = unused_path({}, stem + "-flight", ".json");
  const Status written = write_text(path, format_flight(flight));
  say(written.ok() ? "wrote " + path.string() : written.failure().message);
}

void App::act(Action action) {
  draws_left_ = kSettlingFrames;
  switch (action) {
    case Action::Help:
      switches_.shows_help = !switches_.shows_help;
      break;
    case Action::Fit:
      fit();
      break;
    case Action::Fly:
      input_.set_flying(!input_.is_flying());
      window_.capture_mouse(input_.is_flying());
      break;
    case Action::NextMode:
      edited().set_cut(next_of(edited().cut(), kCutCount));
      break;
    case Action::NextColoring:
      edited().coloring = next_of(edited().coloring, 5);
      break;
    case Action::Wireframe:
      edited().wireframe = !edited().wireframe;
      break;
    case Action::Creases:
      edited().creases = !edited().creases;
      break;
    case Action::Occlusion:
      edited().ambient_occlusion = !edited().ambient_occlusion;
      break;
    case Action::Freeze:
      freeze(!frozen_);
      break;
    case Action::Outside:
      look_from_outside();
      break;
    case Action::Finer:
      edited().pixels = std::max(0.1, edited().pixels / 2);
      break;
    case Action::Coarser:
      edited().pixels = std::min(64.0, edited().pixels * 2);
      break;
    case Action::NextSplit:
      split_.kind = next_of(split_.kind, 3);
      break;
    case Action::OtherHalf:
      split_.edits_right = !split_.edits_right;
      break;
    case Action::Screenshot:
      write_picture();
      break;
    case Action::Record:
      toggle_recording();
      break;
    case Action::HidePanels:
      switches_.shows_panels = !switches_.shows_panels;
      break;
    case Action::Leave:
      switches_.shows_help = false;
      picked_.reset();
      session_.forget_failures();
      if (input_.is_flying()) act(Action::Fly);
      break;
    case Action::Quit:
      window_.close();
      break;
  }
}

std::optional<Failure> App::cannot_finish() const {
  if (session_.failure()) return session_.failure();
  if (const std::optional<Message> message = session_.message();
      message && message->is_failure && settings_.mode != options_.mode) {
    return fail(Error::NotSupported, message->text);
  }
  return session_.stream_failure(kTries);
}

bool App::is_all_there() const {
  const bool is_flight_over =
      options_.flight.empty() ||
      (flight_began_ && now() - *flight_began_ > options_.flight.back().seconds + 0.5);
  return frame_.is_complete && !frame_.has_changed && session_.shown(side_count() - 1) != nullptr &&
         !session_.is_busy() && is_flight_over && draws_left_ == 0 && !has_arrived_ &&
         session_.shown() != nullptr;
}

Result<Image> App::final_picture() {
  if (!options_.panels_on_screenshot) return canvas_.read();
  window_picture_.emplace();
  if (const Status drawn = draw(); !drawn.ok()) return drawn.failure();
  return *std::exchange(window_picture_, std::nullopt);
}

Status App::finish_screenshot() {
  if (is_done_) return Done{};
  if (options_.outside && !is_outside_ && is_all_there()) {
    is_outside_ = true;
    act(Action::Outside);
    return Done{};
  }
  if (options_.screenshot.empty()) return Done{};
  if (const std::optional<Failure> failure = cannot_finish()) return *failure;
  if (!is_all_there()) return Done{};
  const Result<Image> image = final_picture();
  if (!image.ok()) return image.failure();
  is_done_ = true;
  window_.close();
  return write_png(*image, options_.screenshot);
}

Result<ViewerReport> App::run() {
  while (!window_.is_closed()) {
    if (const Status stepped = step(); !stepped.ok()) return stepped.failure();
  }
  window_.hide();
  remember();
  if (session_.failure() && session_.facts() == nullptr) return *session_.failure();
  if (!options_.screenshot.empty() && !is_done_) {
    return fail(Error::Interrupted, "closed before the picture was complete");
  }
  return ViewerReport{histories_.frame_count(), histories_.median_frame_ms(), session_.bytes_read(),
                      frame_.triangles, frame_.error_pixels};
}

}  // namespace crease
