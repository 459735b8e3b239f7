// An OpenGL 3.3 core context without a window, current on this thread while it lives.
//
//   Result<GlContext> gl = open_gl();
//
// First EGL's surfaceless platform (Mesa: a GPU where it finds one, else llvmpipe), then every EGL
// device (NVIDIA's driver). All OpenGL of the project is in the files gl_*.
#pragma once

#include "crease/result.h"

#include <string>

namespace crease {

// What the OpenGL that is current on this thread can do.
struct GlLimits {
  std::string renderer;
  int max_texture_size = 0, max_texel_count = 0, max_samples = 1;
  // Depth may run from 1 at the viewer to 0 far away, where floats are densest (GL 4.5 or
  // extension).
  bool can_reverse_depth = false;
};

// Fails with NotSupported where it lacks what the shaders need.
Result<GlLimits> read_gl_limits();

class GlContext {
 public:
  GlContext(GlContext&& other) noexcept;
  GlContext& operator=(GlContext&&) = delete;
  ~GlContext();  // the context that was current before is current again

  const GlLimits& limits() const { return limits_; }

 private:
  friend Result<GlContext> open_gl();
  GlContext() = default;

  // EGL's handles, which are pointers.
  void* display_ = nullptr;
  void* context_ = nullptr;
  void* previous_display_ = nullptr;
  void* previous_context_ = nullptr;
  void* previous_draw_ = nullptr;
  void* previous_read_ = nullptr;
  GlLimits limits_;
};

// Fails with NotSupported, saying what was tried and how each try ended.
Result<GlContext> open_gl();

}  // namespace crease
