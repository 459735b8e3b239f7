#include "render/gl_context.h"

#include "render/gl_debug.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>
#include <vector>

namespace crease {

namespace {

struct Candidate {
  std::string name;
  EGLDisplay display = EGL_NO_DISPLAY;
};

std::string hex(EGLint error) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%x", unsigned(error));
  return text;
}

// eglGetPlatformDisplayEXT, not EGL 1.5's function without EXT: epoxy looks up what the display
// supports before it calls that one, and aborts as there is no display yet.
std::vector<Candidate> candidates() {
  std::vector<Candidate> found;
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
    found.push_back({"surfaceless", eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA,
                                                             EGL_DEFAULT_DISPLAY, nullptr)});
  }
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") &&
      (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration") ||
       epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_base"))) {
    std::array<EGLDeviceEXT, 16> devices{};
    EGLint count = 0;
    if (eglQueryDevicesEXT(EGLint(devices.size()), devices.data(), &count)) {
      for (std::size_t i = 0; i < std::size_t(count); ++i) {
        found.push_back({"device " + std::to_string(i),
                         eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr)});
      }
    }
  }
  return found;
}

// The context, current; or null and the reason.
EGLContext try_open(EGLDisplay display, std::string& why) {
  if (display == EGL_NO_DISPLAY) {
    why = "no display";
    return EGL_NO_CONTEXT;
  }
  // Displays are shared by the whole process, so none is ever terminated here: somebody else may be
  // drawing on it. Initializing one again does nothing.
  if (!eglInitialize(display, nullptr, nullptr)) {
    why = "eglInitialize failed with " + hex(eglGetError());
    return EGL_NO_CONTEXT;
  }
  if (!epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context")) {
    why = "no EGL_KHR_surfaceless_context";
    return EGL_NO_CONTEXT;
  }
  if (!eglBindAPI(EGL_OPENGL_API)) {
    why = "no desktop OpenGL";
    return EGL_NO_CONTEXT;
  }
  const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                           EGL_NONE};
  EGLConfig config = nullptr;
  EGLint config_count = 0;
  if (!eglChooseConfig(display, wanted, &config, 1, &config_count) || config_count == 0) {
    why = "no configuration with OpenGL";
    return EGL_NO_CONTEXT;
  }
  const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION_KHR,
                            3,
                            EGL_CONTEXT_MINOR_VERSION_KHR,
                            3,
                            EGL_CONTEXT_OPENGL_PROFILE_MASK_KHR,
                            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT_KHR,
                            EGL_CONTEXT_FLAGS_KHR,
                            wants_gl_debug() ? EGL_CONTEXT_OPENGL_DEBUG_BIT_KHR : 0,
                            EGL_NONE};
  const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
  if (context == EGL_NO_CONTEXT) {
    why = "no OpenGL 3.3 core context, error " + hex(eglGetError());
    return EGL_NO_CONTEXT;
  }
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
    why = "eglMakeCurrent failed with " + hex(eglGetError());
    eglDestroyContext(display, context);
    return EGL_NO_CONTEXT;
  }
  if (const Result<GlLimits> limits = read_gl_limits(); !limits.ok()) {
    why = limits.failure().message;
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);
    return EGL_NO_CONTEXT;
  }
  return context;
}

}  // namespace

Result<GlLimits> read_gl_limits() {
  // Three floats a texel: core in 4.0, an extension of 3.3 that every driver at hand has.
  if (epoxy_gl_version() < 40 && !epoxy_has_gl_extension("GL_ARB_texture_buffer_object_rgb32")) {
    return fail(Error::NotSupported, "no GL_ARB_texture_buffer_object_rgb32");
  }
  GlLimits limits;
  limits.renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  GLint renderbuffer = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limits.max_texture_size);
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &renderbuffer);
  limits.max_texture_size = std::min(limits.max_texture_size, int(renderbuffer));
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &limits.max_texel_count);
  glGetIntegerv(GL_MAX_SAMPLES, &limits.max_samples);
  limits.can_reverse_depth =
      epoxy_gl_version() >= 45 || epoxy_has_gl_extension("GL_ARB_clip_control");
  return limits;
}

GlContext::GlContext(GlContext&& other) noexcept
    : display_(std::exchange(other.display_, nullptr)),
      context_(std::exchange(other.context_, nullptr)),
      previous_display_(other.previous_display_),
      previous_context_(other.previous_context_),
      previous_draw_(other.previous_draw_),
      previous_read_(other.previous_read_),
      limits_(std::move(other.limits_)) {}

GlContext::~GlContext() {
  if (context_ == nullptr) return;
  if (previous_context_ != nullptr) {
    eglMakeCurrent(previous_display_, previous_draw_, previous_read_, previous_context_);
  } else {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  eglDestroyContext(display_, context_);
}

Result<GlContext> open_gl() {
  GlContext gl;
  gl.previous_display_ = eglGetCurrentDisplay();
  gl.previous_context_ = eglGetCurrentContext();
  if (gl.previous_context_ != nullptr) {
    gl.previous_draw_ = eglGetCurrentSurface(EGL_DRAW);
    gl.previous_read_ = eglGetCurrentSurface(EGL_READ);
  }
  std::string tried;
  for (const Candidate& candidate : candidates()) {
    std::string why;
    gl.context_ = try_open(candidate.display, why);
    if (gl.context_ != nullptr) {
      gl.display_ = candidate.display;
      break;
    }
    tried += (tried.empty() ? "" : "; ") + candidate.name + ": " + why;
  }
  if (gl.context_ == nullptr) {
    if (tried.empty()) tried = "EGL offers neither the surfaceless nor the device platform";
    return fail(Error::NotSupported,
                "no EGL device can draw without a display (" + tried +
                    "); Mesa's software renderer is in the packages libegl-mesa0 and "
                    "libgl1-mesa-dri");
  }
  report_gl_messages();
  Result<GlLimits> limits = read_gl_limits();
  if (!limits.ok()) return limits.failure();
  gl.limits_ = *std::move(limits);
  return gl;
}

}  // namespace crease
