#include "render/gl_canvas.h"

#include "render/gl_occlusion.h"

#include <cstring>
#include <utility>
#include <vector>

namespace crease {

namespace {

// As render_panels() does it: the background is linear in encoded values, what covers it is light,
// and an ordered dither hides the steps.
constexpr const char* kComposeFragmentShader = R"(#version 330 core
uniform sampler2D picture;
uniform vec3 background_top, background_bottom;  // encoded
uniform float height;
out vec4 color;

vec3 to_linear(vec3 e) {
  return mix(e / 12.92, pow((e + 0.055) / 1.055, vec3(2.4)), greaterThan(e, vec3(0.04045)));
}
vec3 to_srgb(vec3 l) {
  return mix(12.92 * l, 1.055 * pow(l, vec3(1 / 2.4)) - 0.055, greaterThan(l, vec3(0.0031308)));
}

void main() {
  vec4 drawn = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
  vec3 background = mix(background_bottom, background_top, gl_FragCoord.y / height);
  int x = int(gl_FragCoord.x) & 3, y = int(gl_FragCoord.y) & 3;
  float dither = float(((x ^ y) & 1) * 8 + (y & 1) * 4 + (((x ^ y) >> 1) & 1) * 2 + (y >> 1)) / 16;
  background += (1 - drawn.a) * (dither - 0.5) / 255;
  color = vec4(to_srgb(clamp(drawn.rgb + (1 - drawn.a) * to_linear(background), 0, 1)), 1);
}
)";

void set_color(GLuint program, const char* name, const ColorSrgb& c) {
  glUniform3f(glGetUniformLocation(program, name), float(c[0]) / 255, float(c[1]) / 255,
              float(c[2]) / 255);
}

}  // namespace

Result<GlCanvas> GlCanvas::make() {
  Result<GlLimits> limits = read_gl_limits();
  if (!limits.ok()) return limits.failure();
  GlCanvas canvas;
  canvas.limits_ = *std::move(limits);
  canvas.no_attributes_ = GlVertexArray::make();
  return canvas;
}

Status GlCanvas::begin(int width_px, int height_px) {
  if (!target_ || width_px != width_ || height_px != height_) {
    target_.reset();
    Result<GlTarget> made = GlTarget::make(limits_, width_px, height_px);
    if (!made.ok()) return made.failure();
    target_ = *std::move(made);
    width_ = width_px;
    height_ = height_px;
  }
  target_->begin(width_, height_);
  return Done{};
}

void GlCanvas::set_columns(int left, int width) {
  glViewport(left, 0, width, height_);
}

Status GlCanvas::occlude(const DrawPass& pass, const DrawStyle& style) {
  const Result<const GlTexture*> depths = target_->resolve_depth(width_, height_);
  if (!depths.ok()) return depths.failure();
  return draw_occlusion(programs_, **depths, pass, style);
}

void GlCanvas::fill_columns(int left, int width, const ColorSrgb& color) {
  const Color linear = linear_from_srgb(color);
  glEnable(GL_SCISSOR_TEST);
  glScissor(left, 0, width, height_);
  glClearColor(linear[0], linear[1], linear[2], 1);
  glClear(GL_COLOR_BUFFER_BIT);
  glDisable(GL_SCISSOR_TEST);
}

Status GlCanvas::compose(GLuint framebuffer) {
  const Result<const GlProgram*> got =
      programs_.get("compose", kCoverVertexShader, kComposeFragmentShader);
  if (!got.ok()) return got.failure();
  const GLuint program = (*got)->id();
  const GlTexture& picture = target_->resolve(width_, height_);
  if (limits_.can_reverse_depth) glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glDisable(GL_DEPTH_TEST);
  glViewport(0, 0, width_, height_);
  glUseProgram(program);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, picture.id());
  glUniform1i(glGetUniformLocation(program, "picture"), 0);
  set_color(program, "background_top", kBackgroundTop);
  set_color(program, "background_bottom", kBackgroundBottom);
  glUniform1f(glGetUniformLocation(program, "height"), float(height_));
  glBindVertexArray(no_attributes_.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  return Done{};
}

Status GlCanvas::show() {
  return compose(0);
}

Result<Image> GlCanvas::read() {
  if (!target_) return fail(Error::NotFound, "nothing has been drawn yet");
  const GlRenderbuffer storage = GlRenderbuffer::make();
  glBindRenderbuffer(GL_RENDERBUFFER, storage.id());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width_, height_);
  const GlFramebuffer framebuffer = GlFramebuffer::make();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, storage.id());
  if (const Status composed = compose(framebuffer.id()); !composed.ok()) return composed.failure();
  Image image = read_bound();
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  return image;
}

Image GlCanvas::read_window() const {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glReadBuffer(GL_BACK);
  Image image = read_bound();
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  return image;
}

Image GlCanvas::read_bound() const {
  Image image;
  image.width = width_;
  image.height = height_;
  const std::size_t row = 4 * std::size_t(width_);
  std::vector<std::uint8_t> upside_down(row * std::size_t(height_));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, upside_down.data());
  image.rgba.resize(upside_down.size());
  for (std::size_t y = 0; y < std::size_t(height_); ++y) {
    std::memcpy(&image.rgba[y * row], &upside_down[(std::size_t(height_) - 1 - y) * row], row);
  }
  return image;
}

}  // namespace crease
