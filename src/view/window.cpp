#include "view/window.h"

#include "render/gl_debug.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace crease {

namespace {

std::string last_error() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text == nullptr ? "no reason given" : text;
}

}  // namespace

Result<std::unique_ptr<ViewerWindow>> ViewerWindow::open(const std::string& title, int width_px,
                                                         int height_px) {
  if (!glfwInit()) {
    return fail(Error::NotSupported,
                "no window: " + last_error() + "; crease render makes pictures without a display");
  }
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, wants_gl_debug() ? GLFW_TRUE : GLFW_FALSE);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);  // the picture is drawn elsewhere
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  GLFWwindow* made = glfwCreateWindow(width_px, height_px, title.c_str(), nullptr, nullptr);
  if (made == nullptr) {
    return fail(Error::NotSupported, "no window with OpenGL 3.3: " + last_error());
  }
  std::unique_ptr<ViewerWindow> window(new ViewerWindow(made));
  glfwMakeContextCurrent(made);
  report_gl_messages();
  glfwSwapInterval(1);
  window->listen();
  return window;
}

ViewerWindow::ViewerWindow(GLFWwindow* window) : window_(window) {
  glfwSetWindowUserPointer(window_, this);
}

// GLFW stays initialized until the process ends: to end it would unload the driver, which keeps
// memory that leak checkers then cannot tell from ours.
ViewerWindow::~ViewerWindow() {
  glfwDestroyWindow(window_);
}

ViewerWindow& ViewerWindow::of(GLFWwindow* window) {
  return *static_cast<ViewerWindow*>(glfwGetWindowUserPointer(window));
}

std::pair<double, double> ViewerWindow::in_pixels(double x, double y) const {
  int width = 0, height = 0;
  glfwGetWindowSize(window_, &width, &height);
  const auto [width_px, height_px] = size_px();
  if (width <= 0 || height <= 0) return {x, y};
  return {x * width_px / width, y * height_px / height};
}

void ViewerWindow::on_drop(GLFWwindow* window, int count, const char** paths) {
  WindowEvent event{.kind = WindowEvent::Kind::Drop};
  event.paths.assign(paths, paths + count);
  of(window).events_.push_back(std::move(event));
}

void ViewerWindow::listen() {
  glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int mods) {
    of(w).events_.push_back({.kind = WindowEvent::Kind::Key,
                             .code = key,
                             .is_down = action != GLFW_RELEASE,
                             .is_shift = (mods & GLFW_MOD_SHIFT) != 0});
  });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int mods) {
    // Where it is now may be further on than where it was pressed.
    if (!of(w).mouse_) {
      double x = 0, y = 0;
      glfwGetCursorPos(w, &x, &y);
      of(w).mouse_ = of(w).in_pixels(x, y);
    }
    const auto [px, py] = *of(w).mouse_;
    of(w).events_.push_back({.kind = WindowEvent::Kind::Button,
                             .code = button,
                             .is_down = action != GLFW_RELEASE,
                             .is_shift = (mods & GLFW_MOD_SHIFT) != 0,
                             .x = px,
                             .y = py});
  });
  glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
    const auto [px, py] = of(w).in_pixels(x, y);
    of(w).mouse_ = {px, py};
    of(w).events_.push_back({.kind = WindowEvent::Kind::Move, .x = px, .y = py});
  });
  glfwSetScrollCallback(window_, [](GLFWwindow* w, double x, double y) {
    of(w).events_.push_back({.kind = WindowEvent::Kind::Scroll, .x = x, .y = y});
  });
  glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) {
    of(w).events_.push_back({.kind = WindowEvent::Kind::Refresh});
  });
  glfwSetDropCallback(window_, on_drop);
}

bool ViewerWindow::is_closed() const {
  return glfwWindowShouldClose(window_) != 0;
}

void ViewerWindow::close() {
  glfwSetWindowShouldClose(window_, GLFW_TRUE);
}

void ViewerWindow::hide() {
  glfwHideWindow(window_);
}

void ViewerWindow::wait(double seconds) {
  if (seconds > 0) {
    glfwWaitEventsTimeout(seconds);
  } else {
    glfwPollEvents();
  }
}

void ViewerWindow::show() {
  glfwSwapBuffers(window_);
}

std::pair<int, int> ViewerWindow::size_px() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  return {width, height};
}

double ViewerWindow::scale() const {
  float x = 1, y = 1;
  glfwGetWindowContentScale(window_, &x, &y);
  return x > 0 ? double(x) : 1;
}

bool ViewerWindow::is_key_down(int code) const {
  return glfwGetKey(window_, code) == GLFW_PRESS;
}

void ViewerWindow::capture_mouse(bool on) {
  glfwSetInputMode(window_, GLFW_CURSOR, on ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
}

void ViewerWindow::set_title(const std::string& title) {
  glfwSetWindowTitle(window_, title.c_str());
}

}  // namespace crease
