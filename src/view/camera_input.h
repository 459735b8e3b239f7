// Mouse and keys to moves of a camera.
//
//   for (const WindowEvent& event : events) input.take(event, camera, point_under);
//   camera = input.flown_for(seconds, window, camera, model_size);
//   if (auto click = input.take_click()) pick(click->x, click->y);
#pragma once

#include "crease/camera.h"
#include "view/window.h"

#include <functional>
#include <optional>

namespace crease {

// Of the model, under a point of the picture; nothing beside it.
using PointUnder = std::function<std::optional<Vec3d>(double x_px, double y_px)>;

struct Click {
  double x = 0, y = 0;
  bool is_double = false;
};

class CameraInput {
 public:
  // `now`: any clock's seconds. True if the camera was moved. Presses are for the panels if the
  // mouse is over one: leave out those.
  bool take(const WindowEvent& event, double now, Camera& camera, const PointUnder& point_under);

  void set_flying(bool on);
  bool is_flying() const { return is_flying_; }
  bool is_dragging() const { return button_ >= 0; }
  // With the keys that are down; `model_size` is what a few seconds cross. True if it moved.
  bool fly(double seconds, const ViewerWindow& window, double model_size, Camera& camera) const;

  std::optional<Click> take_click() { return std::exchange(click_, std::nullopt); }

 private:
  bool move_to(double x, double y, Camera& camera);
  void release(double now);

  int button_ = -1;           // that is held down
  double x_ = 0, y_ = 0;      // where the mouse was
  double moved_px_ = 0;       // since it was pressed
  bool knows_place_ = false;  // not since the mouse was captured or let go
  bool is_flying_ = false;
  double speed_ = 1;
  std::optional<Click> click_;
  double last_click_at_ = -1e9;
};

}  // namespace crease
