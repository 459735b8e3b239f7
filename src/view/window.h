// A window with OpenGL 3.3, and what the user does in it. All of GLFW is here and in gui.cpp.
//
//   Result<std::unique_ptr<ViewerWindow>> window = ViewerWindow::open("crease", 1280, 800);
//   while (!(*window)->is_closed()) {
//     (*window)->wait(0.1);
//     for (const WindowEvent& event : (*window)->take_events()) ...
//     draw();
//     (*window)->show();
//   }
#pragma once

#include "crease/result.h"

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

struct GLFWwindow;

namespace crease {

struct WindowEvent {
  enum class Kind { Key, Button, Move, Scroll, Drop, Refresh };
  Kind kind{};
  int code = 0;                      // Key: GLFW's; Button: 0 left, 1 right, 2 middle
  bool is_down = false;              // Key, Button; a key that repeats is down again
  bool is_shift = false;             // Key
  double x = 0, y = 0;               // Button, Move: where, pixels of the picture; Scroll: how far
  std::vector<std::string> paths{};  // Drop
};

class ViewerWindow {
 public:
  // Its OpenGL is current on this thread while it lives. NotSupported without a display or
  // without OpenGL 3.3, with the system's reason. One at a time.
  static Result<std::unique_ptr<ViewerWindow>> open(const std::string& title, int width_px,
                                                    int height_px);
  ViewerWindow(const ViewerWindow&) = delete;
  ViewerWindow& operator=(const ViewerWindow&) = delete;
  ~ViewerWindow();

  bool is_closed() const;
  void close();
  void hide();  // while something takes its time to end
  // Until something happens in the window, so many seconds at most; 0: not at all.
  void wait(double seconds);
  std::vector<WindowEvent> take_events() { return std::exchange(events_, {}); }
  void show();  // what was drawn

  std::pair<int, int> size_px() const;  // of the picture; 0 x 0 while minimized
  double scale() const;                 // of text, 1 on ordinary displays
  bool is_key_down(int code) const;
  // Hides the mouse and lets it move without end.
  void capture_mouse(bool on);
  void set_title(const std::string& title);
  GLFWwindow* handle() const { return window_; }

  // What GLFW calls when files are dropped on the window.
  static void on_drop(GLFWwindow* window, int count, const char** paths);

 private:
  explicit ViewerWindow(GLFWwindow* window);
  static ViewerWindow& of(GLFWwindow* window);
  std::pair<double, double> in_pixels(double x, double y) const;
  void listen();

  GLFWwindow* window_;
  std::vector<WindowEvent> events_;
  std::optional<std::pair<double, double>> mouse_;  // where it was last seen, pixels
};

}  // namespace crease
