#include "render/gl_lines.h"

#include "render/gl_objects.h"
#include "render/palette.h"

#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace crease {

namespace {

using Clip = std::array<double, 4>;

constexpr float kLinePx = 2.5f;  // beside the lines of a wireframe

struct LineView {
  View view;
  Vec3d origin;     // what clip_from_list takes points less of
  double near = 1;  // lines begin there
  Matrix4f clip_from_list{};
  float width_px = 1;  // in pixels of the framebuffer
  bool reversed_depth = false;
};

constexpr const char* kLineVertexShader = R"(#version 330 core
layout(location = 0) in vec4 position;
void main() { gl_Position = position; }
)";

constexpr const char* kLineFragmentShader = R"(#version 330 core
uniform vec4 line_color;
out vec4 color;
void main() { color = line_color; }
)";

Clip to_clip(const Matrix4f& m, const Vec3d& p) {
  Clip clip;
  for (std::size_t r = 0; r < 4; ++r) {
    clip[r] =
        double(m[r]) * p.x + double(m[4 + r]) * p.y + double(m[8 + r]) * p.z + double(m[12 + r]);
  }
  return clip;
}

// A rectangle along each line, as wide as asked on the screen, longer by half its width at both
// ends.
class Strips {
 public:
  Strips(const LineView& view, double viewport_width, double viewport_height)
      : view_(view), to_pixels_{viewport_width / 2, viewport_height / 2} {}

  std::vector<float> of(std::span<const Segment> lines, float width_px) {
    corners_.clear();
    for (const Segment& line : lines) add(line, double(width_px) / 2);
    return corners_;
  }

 private:
  void add(Segment line, double half_px) {
    const auto depth = [&](const Vec3d& p) { return -dot(p - view_.view.eye, view_.view.back); };
    if (depth(line.from) > depth(line.to)) std::swap(line.from, line.to);
    const double from = depth(line.from), to = depth(line.to);
    if (to <= view_.near) return;
    if (from < view_.near) {
      line.from += (line.to - line.from) * ((view_.near - from) / (to - from));
    }
    const Clip a = to_clip(view_.clip_from_list, line.from - view_.origin);
    const Clip b = to_clip(view_.clip_from_list, line.to - view_.origin);
    double along[2];
    for (std::size_t i = 0; i < 2; ++i) along[i] = (b[i] / b[3] - a[i] / a[3]) * to_pixels_[i];
    const double pixels = std::hypot(along[0], along[1]);
    if (!(pixels > 0)) return;
    for (double& d : along) d *= half_px / pixels;
    const double across[2] = {-along[1], along[0]};
    const auto corner = [&](const Clip& at, double end, double side) {
      for (std::size_t i = 0; i < 2; ++i) {
        const double off = (end * along[i] + side * across[i]) / to_pixels_[i];
        corners_.push_back(float(at[i] + off * at[3]));
      }
      corners_.push_back(float(at[2]));
      corners_.push_back(float(at[3]));
    };
    corner(a, -1, -1), corner(b, 1, -1), corner(b, 1, 1);
    corner(a, -1, -1), corner(b, 1, 1), corner(a, -1, 1);
  }

  const LineView& view_;
  const double to_pixels_[2];
  std::vector<float> corners_;
};

struct Stroke {
  bool behind;  // the scene, else before it
  float extra_px;
  ColorSrgb color;
  float opacity;
};

// A light seam keeps a line apart from dark surfaces and from the lines of a wireframe.
constexpr Stroke kStrokes[] = {
    {true, 0, kFrustumColor, 0.5f}, {false, 4, kPageColor, 0.75f}, {false, 0, kFrustumColor, 1}};

void draw_strips(std::span<const float> corners) {
  const GlVertexArray array = GlVertexArray::make();
  const GlBuffer buffer = GlBuffer::make();
  glBindVertexArray(array.id());
  glBindBuffer(GL_ARRAY_BUFFER, buffer.id());
  glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(corners.size_bytes()), corners.data(), GL_STREAM_DRAW);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
  glDrawArrays(GL_TRIANGLES, 0, GLsizei(corners.size() / 4));
}

}  // namespace

DrawPass pass_over(const Camera& camera, double aspect, Box box, std::span<const Segment> lines) {
  DrawPass pass{.view = make_view(camera, aspect), .up = camera.up};
  for (const Segment& line : lines) {
    box.add(line.from);
    box.add(line.to);
  }
  pass.depth = depth_range(pass.view, box.low, box.high);
  return pass;
}

Status draw_lines(ProgramCache& programs, std::span<const Segment> lines, const DrawPass& pass,
                  const DrawStyle& style) {
  if (lines.empty()) return Done{};
  const Vec3d origin = pass.view.eye;  // so that floats suffice
  const LineView view{.view = pass.view,
                      .origin = origin,
                      .near = pass.depth.near,
                      .clip_from_list = clip_from_list(pass.view, origin, pass.depth, pass.window,
                                                       style.reversed_depth),
                      .width_px = kLinePx * style.line_px,
                      .reversed_depth = style.reversed_depth};
  const Result<const GlProgram*> got =
      programs.get("lines", kLineVertexShader, kLineFragmentShader);
  if (!got.ok()) return got.failure();
  const GlProgram& program = **got;
  GLint viewport[4];
  glGetIntegerv(GL_VIEWPORT, viewport);
  Strips strips(view, viewport[2], viewport[3]);

  glUseProgram(program.id());
  const GLint line_color = glGetUniformLocation(program.id(), "line_color");
  // The target's alpha is how much is covered, its colours are times that.
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  for (const Stroke& stroke : kStrokes) {
    glDepthFunc(stroke.behind == view.reversed_depth ? GL_LESS : GL_GREATER);
    const Color c = linear_from_srgb(stroke.color);
    glUniform4f(line_color, c[0], c[1], c[2], stroke.opacity);
    draw_strips(strips.of(lines, view.width_px + stroke.extra_px));
  }
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  return Done{};
}

}  // namespace crease
