#include "render/gl_target.h"

#include <algorithm>

namespace crease {

namespace {

constexpr int kSamples = 4;

GlRenderbuffer make_storage(int samples, GLenum format, int width, int height) {
  GlRenderbuffer storage = GlRenderbuffer::make();
  glBindRenderbuffer(GL_RENDERBUFFER, storage.id());
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
  return storage;
}

GlTexture make_texture(int width, int height) {
  GlTexture texture = GlTexture::make();
  glBindTexture(GL_TEXTURE_2D, texture.id());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8_ALPHA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
               nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

bool is_complete() {
  return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

bool attach(GlFramebuffer& framebuffer, const GlRenderbuffer& color, const GlRenderbuffer& depth) {
  framebuffer = GlFramebuffer::make();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color.id());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth.id());
  return is_complete();
}

bool attach(GlFramebuffer& framebuffer, const GlTexture& color) {
  framebuffer = GlFramebuffer::make();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color.id(), 0);
  return is_complete();
}

void copy(const GlFramebuffer& from, const GlFramebuffer& to, int width, int height) {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, from.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, to.id());
  glBlitFramebuffer(0, 0, width, height, 0, 0, width, height,
                    GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT, GL_NEAREST);
}

}  // namespace

Result<GlTarget> GlTarget::make(const GlLimits& gl, int width, int height) {
  GlTarget target;
  target.reversed_depth_ = gl.can_reverse_depth;
  target.width_ = width;
  target.height_ = height;
  const int samples = target.samples_ = std::min(kSamples, gl.max_samples);
  target.color_ = make_storage(samples, GL_SRGB8_ALPHA8, width, height);
  target.depth_ = make_storage(samples, GL_DEPTH_COMPONENT32F, width, height);
  target.resolved_color_ = make_texture(width, height);
  if (!attach(target.multisampled_, target.color_, target.depth_) ||
      !attach(target.resolved_, target.resolved_color_)) {
    return fail(Error::NotSupported, "OpenGL (" + gl.renderer + ") has no framebuffer of " +
                                         std::to_string(width) + " x " + std::to_string(height) +
                                         " pixels with " + std::to_string(samples) + " samples");
  }
  return target;
}

void GlTarget::begin(int width, int height) {
  glBindFramebuffer(GL_FRAMEBUFFER, multisampled_.id());
  glViewport(0, 0, width, height);
  glEnable(GL_FRAMEBUFFER_SRGB);
  glEnable(GL_MULTISAMPLE);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glClearColor(0, 0, 0, 0);
  // Float depth is finest near 0. With 1 far away a lawn 5 cm above the pavement flickered into it
  // at 150 m (generated city, viewer inside); with 0 far away it does not.
  if (reversed_depth_) glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glClearDepth(reversed_depth_ ? 0 : 1);
  glDepthFunc(reversed_depth_ ? GL_GREATER : GL_LESS);
  glEnable(GL_DEPTH_TEST);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

const GlTexture& GlTarget::resolve(int width, int height) {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, multisampled_.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_.id());
  glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  return resolved_color_;
}

Result<const GlTexture*> GlTarget::resolve_depth(int width, int height) {
  if (!depths_) {
    depths_ = GlTexture::make();
    glBindTexture(GL_TEXTURE_2D, depths_.id());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, width_, height_, 0, GL_DEPTH_COMPONENT,
                 GL_FLOAT, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    resolved_depth_ = GlFramebuffer::make();
    glBindFramebuffer(GL_FRAMEBUFFER, resolved_depth_.id());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depths_.id(), 0);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
    if (!is_complete()) {
      return fail(Error::NotSupported, "OpenGL has no framebuffer of depths alone");
    }
  }
  glBindFramebuffer(GL_READ_FRAMEBUFFER, multisampled_.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_depth_.id());
  glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_DEPTH_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, multisampled_.id());
  return &depths_;
}

Status GlTarget::keep(int width, int height) {
  if (!kept_) {
    kept_color_ = make_storage(samples_, GL_SRGB8_ALPHA8, width_, height_);
    kept_depth_ = make_storage(samples_, GL_DEPTH_COMPONENT32F, width_, height_);
    if (!attach(kept_, kept_color_, kept_depth_)) {
      return fail(Error::NotSupported, "OpenGL has no second framebuffer of " +
                                           std::to_string(width_) + " x " +
                                           std::to_string(height_) + " pixels");
    }
  }
  copy(multisampled_, kept_, width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, multisampled_.id());
  return Done{};
}

void GlTarget::go_back(int width, int height) {
  copy(kept_, multisampled_, width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, multisampled_.id());
}

void GlTarget::read(int width, int height, std::span<std::uint8_t> rgba) {
  resolve(width, height);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, resolved_.id());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
}

}  // namespace crease
