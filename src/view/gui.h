// Dear ImGui in our window: its life, its font and its colours.
#pragma once

#include "view/window.h"

namespace crease {

class Gui {
 public:
  // After the window's callbacks are set, which it calls as well.
  explicit Gui(const ViewerWindow& window);
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;
  ~Gui();

  void begin();
  void draw();  // into the window's framebuffer

  // The mouse or the keys are for a panel.
  bool wants_mouse() const;
  bool wants_keys() const;
};

}  // namespace crease
