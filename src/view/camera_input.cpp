#include "view/camera_input.h"

#include "view/camera_moves.h"
#include "view/keys.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace crease {

namespace {

constexpr double kZoomStep = 0.86;  // a notch of the wheel
constexpr double kStillPx = 4;      // a click moves by less
constexpr double kDoubleClickSeconds = 0.35;
constexpr double kFlySeconds = 8;  // to cross the model
constexpr double kFast = 5;

}  // namespace

bool CameraInput::take(const WindowEvent& event, double now, Camera& camera,
                       const PointUnder& point_under) {
  switch (event.kind) {
    case WindowEvent::Kind::Button:
      if (event.is_down && button_ < 0) {
        button_ = event.code;
        moved_px_ = 0;
        x_ = event.x;
        y_ = event.y;
        knows_place_ = true;
      } else if (!event.is_down && event.code == button_) {
        release(now);
      }
      return false;
    case WindowEvent::Kind::Move:
      return move_to(event.x, event.y, camera);
    case WindowEvent::Kind::Scroll: {
      if (is_flying_) {
        speed_ = std::clamp(speed_ * std::pow(1 / kZoomStep, event.y), 1e-3, 1e3);
        return false;
      }
      const std::optional<Vec3d> focus = point_under(x_, y_);
      camera = zoomed(camera, std::pow(kZoomStep, event.y), focus.value_or(camera.target));
      return event.y != 0;
    }
    default:
      return false;
  }
}

bool CameraInput::move_to(double x, double y, Camera& camera) {
  const double dx = x - x_, dy = y - y_;
  x_ = x;
  y_ = y;
  if (!std::exchange(knows_place_, true)) return false;
  if (is_flying_) {
    camera = turned(camera, dx, dy);
    return true;
  }
  if (button_ < 0) return false;
  moved_px_ += std::abs(dx) + std::abs(dy);
  if (moved_px_ < kStillPx) return false;
  camera = button_ == 0 ? orbited(camera, dx, dy) : panned(camera, dx, dy);
  return true;
}

void CameraInput::release(double now) {
  if (button_ == 0 && moved_px_ < kStillPx) {
    click_ = Click{x_, y_, now - last_click_at_ < kDoubleClickSeconds};
    last_click_at_ = now;
  }
  button_ = -1;
}

void CameraInput::set_flying(bool on) {
  is_flying_ = on;
  knows_place_ = false;
  button_ = -1;
}

bool CameraInput::fly(double seconds, const ViewerWindow& window, double model_size,
                      Camera& camera) const {
  if (!is_flying_) return false;
  const FlyKeys keys = fly_keys();
  const auto along = [&](int forward, int backward) {
    return double(window.is_key_down(forward)) - double(window.is_key_down(backward));
  };
  const Vec3d wanted{along(keys.right, keys.left), along(keys.above, keys.below),
                     along(keys.ahead, keys.back)};
  if (wanted == Vec3d{}) return false;
  const double pace =
      model_size / kFlySeconds * speed_ * (window.is_key_down(keys.fast) ? kFast : 1);
  camera = flown(camera, normalized(wanted) * (pace * seconds));
  return true;
}

}  // namespace crease
