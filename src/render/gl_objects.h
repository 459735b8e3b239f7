// OpenGL objects that delete themselves. The context that made them must be current when they do.
#pragma once

#include "crease/draw_changes.h"
#include "crease/result.h"

#include <epoxy/gl.h>

#include <cstddef>
#include <span>
#include <string>
#include <utility>

namespace crease {

template <typename Traits>
class GlObject {
 public:
  GlObject() = default;
  static GlObject make() {
    GlObject object;
    object.id_ = Traits::make();
    return object;
  }
  GlObject(GlObject&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~GlObject() {
    if (id_ != 0) Traits::drop(id_);
  }
  GLuint id() const { return id_; }
  explicit operator bool() const { return id_ != 0; }

 private:
  GLuint id_ = 0;
};

#define CREASE_GL_TRAITS(Name, plural)                        \
  struct Name##Traits {                                       \
    static GLuint make() {                                    \
      GLuint id = 0;                                          \
      glGen##plural(1, &id);                                  \
      return id;                                              \
    }                                                         \
    static void drop(GLuint id) { glDelete##plural(1, &id); } \
  };                                                          \
  using Name = GlObject<Name##Traits>

CREASE_GL_TRAITS(GlBuffer, Buffers);
CREASE_GL_TRAITS(GlTexture, Textures);
CREASE_GL_TRAITS(GlVertexArray, VertexArrays);
CREASE_GL_TRAITS(GlFramebuffer, Framebuffers);
CREASE_GL_TRAITS(GlRenderbuffer, Renderbuffers);
#undef CREASE_GL_TRAITS

struct GlProgramTraits {
  static GLuint make() { return glCreateProgram(); }
  static void drop(GLuint id) { glDeleteProgram(id); }
};
using GlProgram = GlObject<GlProgramTraits>;

// A buffer that is read as a vertex or index array, as a texture of texels, or as both.
struct GlArray {
  GlBuffer buffer;
  GlTexture texels;       // a buffer texture over all of it
  std::size_t count = 0;  // texels
  std::size_t bytes = 0;  // that the buffer takes: those of `count` texels or more

  explicit operator bool() const { return count != 0; }
};

// `format` is the texel: GL_R32UI, GL_RGB32F, ...; `bytes` a whole number of texels. `usage`:
// GL_DYNAMIC_DRAW for what is to be refreshed.
GlArray upload_bytes(std::span<const std::byte> bytes, std::size_t texel_bytes, GLenum format,
                     GLenum usage = GL_STATIC_DRAW);

template <typename T>
GlArray upload(std::span<const T> values, GLenum format, GLenum usage = GL_STATIC_DRAW) {
  return upload_bytes(std::as_bytes(values), sizeof(T), format, usage);
}

// Makes a copy that was right but for `changes` right again: ranges of elements of `per_element`
// texels each, in ascending order; and some between them. What does not fit is uploaded whole, with
// room to grow. Returns the bytes uploaded.
std::size_t refresh(GlArray& array, std::span<const std::byte> bytes, std::size_t texel_bytes,
                    GLenum format, std::span<const Range> changes, std::size_t per_element);

template <typename T>
std::size_t refresh(GlArray& array, std::span<const T> values, GLenum format,
                    std::span<const Range> changes, std::size_t per_element = 1) {
  return refresh(array, std::as_bytes(values), sizeof(T), format, changes, per_element);
}

void bind_texels(const GlArray& array, int unit);

// Fails with NotSupported and the driver's log; the sources are ours, so the driver is to blame.
Result<GlProgram> link_program(const std::string& vertex_source,
                               const std::string& fragment_source);

}  // namespace crease
