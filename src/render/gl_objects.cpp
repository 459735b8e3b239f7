#include "render/gl_objects.h"

namespace crease {

GlArray upload(std::span<const std::byte> bytes, std::size_t texel_bytes, GLenum format) {
  GlArray array;
  if (bytes.empty()) return array;
  array.count = bytes.size() / texel_bytes;
  array.buffer = GlBuffer::make();
  glBindBuffer(GL_TEXTURE_BUFFER, array.buffer.id());
  glBufferData(GL_TEXTURE_BUFFER, GLsizeiptr(bytes.size()), bytes.data(), GL_STATIC_DRAW);
  array.texels = GlTexture::make();
  glBindTexture(GL_TEXTURE_BUFFER, array.texels.id());
  glTexBuffer(GL_TEXTURE_BUFFER, format, array.buffer.id());
  return array;
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
