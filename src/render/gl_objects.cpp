#include "render/gl_objects.h"

#include <algorithm>

namespace crease {

GlArray upload_bytes(std::span<const std::byte> bytes, std::size_t texel_bytes, GLenum format,
                     GLenum usage) {
  GlArray array;
  if (bytes.empty()) return array;
  array.count = bytes.size() / texel_bytes;
  array.bytes = bytes.size();
  array.buffer = GlBuffer::make();
  glBindBuffer(GL_TEXTURE_BUFFER, array.buffer.id());
  glBufferData(GL_TEXTURE_BUFFER, GLsizeiptr(bytes.size()), bytes.data(), usage);
  array.texels = GlTexture::make();
  glBindTexture(GL_TEXTURE_BUFFER, array.texels.id());
  glTexBuffer(GL_TEXTURE_BUFFER, format, array.buffer.id());
  return array;
}

namespace {

// Ranges that are nearer than this are sent in one call. On a GPU (docs/rendering.md) that halves
// to quarters the time of geomorphs' many small ranges; gaps of 1 KiB send 4 times the bytes for
// little.
constexpr std::size_t kGapBytes = 128;

// Half as much again, so that a mesh that grows frame by frame is not uploaded whole every time.
void make_room(GlArray& array, std::size_t bytes, std::size_t texel_bytes, GLenum format) {
  array.bytes = bytes + bytes / 2 / texel_bytes * texel_bytes;
  if (!array.buffer) array.buffer = GlBuffer::make();
  if (!array.texels) array.texels = GlTexture::make();
  glBindBuffer(GL_TEXTURE_BUFFER, array.buffer.id());
  glBufferData(GL_TEXTURE_BUFFER, GLsizeiptr(array.bytes), nullptr, GL_DYNAMIC_DRAW);
  glBindTexture(GL_TEXTURE_BUFFER, array.texels.id());
  glTexBuffer(GL_TEXTURE_BUFFER, format, array.buffer.id());
}

}  // namespace

std::size_t refresh(GlArray& array, std::span<const std::byte> bytes, std::size_t texel_bytes,
                    GLenum format, std::span<const Range> changes, std::size_t per_element) {
  array.count = bytes.size() / texel_bytes;
  if (bytes.empty()) return 0;
  if (bytes.size() > array.bytes) {
    make_room(array, bytes.size(), texel_bytes, format);
    glBufferSubData(GL_TEXTURE_BUFFER, 0, GLsizeiptr(bytes.size()), bytes.data());
    return bytes.size();
  }
  glBindBuffer(GL_TEXTURE_BUFFER, array.buffer.id());
  std::size_t uploaded = 0, begin = 0, end = 0;
  const auto send = [&] {
    if (begin == end) return;
    glBufferSubData(GL_TEXTURE_BUFFER, GLintptr(begin), GLsizeiptr(end - begin),
                    bytes.data() + begin);
    uploaded += end - begin;
  };
  for (const Range& range : changes) {
    const std::size_t first = range.first * per_element * texel_bytes;
    if (first >= bytes.size()) break;
    if (first > end + kGapBytes) {
      send();
      begin = first;
    }
    end = std::max(end, std::min(first + range.count * per_element * texel_bytes, bytes.size()));
  }
  send();
  return uploaded;
}

void bind_texels(const GlArray& array, int unit) {
  glActiveTexture(GLenum(GL_TEXTURE0 + unit));
  glBindTexture(GL_TEXTURE_BUFFER, array.texels.id());
}

Result<GlProgram> link_program(const std::string& vertex_source,
                               const std::string& fragment_source) {
  GlProgram program = GlProgram::make();
  char log[2048] = "";
  for (const auto& [stage, source] : {std::pair(GL_VERTEX_SHADER, &vertex_source),
                                      std::pair(GL_FRAGMENT_SHADER, &fragment_source)}) {
    const GLuint shader = glCreateShader(GLenum(stage));
    const char* text = source->c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    GLint compiled = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (!compiled) glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    glAttachShader(program.id(), shader);
    glDeleteShader(shader);  // it lives on in the program
    if (!compiled) return fail(Error::NotSupported, std::string("OpenGL shader: ") + log);
  }
  glLinkProgram(program.id());
  GLint linked = 0;
  glGetProgramiv(program.id(), GL_LINK_STATUS, &linked);
  if (!linked) {
    glGetProgramInfoLog(program.id(), sizeof log, nullptr, log);
    return fail(Error::NotSupported, std::string("OpenGL program: ") + log);
  }
  return program;
}

}  // namespace crease
