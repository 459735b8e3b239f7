#include "render/gl_debug.h"

#include <epoxy/gl.h>

#include <cstdio>
#include <cstdlib>

namespace crease {

namespace {

void report(GLenum, GLenum type, GLuint id, GLenum severity, GLsizei, const GLchar* message,
            const void*) {
  if (severity == GL_DEBUG_SEVERITY_NOTIFICATION) return;
  std::fprintf(stderr, "OpenGL: %s (type 0x%x, id %u, severity 0x%x)\n", message, type, id,
               severity);
}

}  // namespace

bool wants_gl_debug() {
  return std::getenv("CREASE_GL_DEBUG") != nullptr;
}

void report_gl_messages() {
  if (!wants_gl_debug()) return;
  if (epoxy_gl_version() < 43 && !epoxy_has_gl_extension("GL_KHR_debug")) {
    std::fprintf(stderr, "OpenGL: this driver has no debug messages\n");
    return;
  }
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(report, nullptr);
}

}  // namespace crease
