#include "render/gl_occlusion.h"

#include <algorithm>

namespace crease {

namespace {

constexpr double kRadius = 0.035;  // of the picture's height

constexpr const char* kOcclusionFragmentShader = R"(#version 330 core
uniform sampler2D depths;
uniform ivec4 viewport;
uniform vec2 inverse_distance;  // its factor of the depth, and what is added
uniform float far_depth;        // where nothing is drawn
uniform vec4 ray;               // x and y at distance 1: of the first pixel, and from pixel to pixel
uniform float radius_px;
out vec4 color;

const int kDirections = 8, kSteps = 4;

float depth_at(ivec2 at) {
  return texelFetch(depths, clamp(at, viewport.xy, viewport.xy + viewport.zw - 1), 0).r;
}

// From the eye: x right, y above, z the distance.
vec3 point_of(ivec2 at, float depth) {
  float distance = 1 / (inverse_distance.x * depth + inverse_distance.y);
  return vec3(ray.xy + ray.zw * vec2(at - viewport.xy), 1) * distance;
}
vec3 point_at(ivec2 at) { return point_of(at, depth_at(at)); }

// Of the two differences the one that stays on the surface.
vec3 nearer(vec3 a, vec3 b) { return abs(a.z) < abs(b.z) ? a : b; }

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  float depth = depth_at(at);
  color = vec4(1);
  if (depth == far_depth) return;
  vec3 p = point_of(at, depth);
  vec3 x = nearer(point_at(at + ivec2(1, 0)) - p, p - point_at(at - ivec2(1, 0)));
  vec3 y = nearer(point_at(at + ivec2(0, 1)) - p, p - point_at(at - ivec2(0, 1)));
  vec3 n = normalize(cross(y, x));  // towards the eye: z is away from it
  float radius = radius_px * ray.w * p.z;
  float least = 0.02 * radius;  // what rises by less is the plane itself
  float turn = 0.0625 * float((5 * at.x + 3 * at.y) & 15) * 6.2832 / float(kDirections);
  // Two by two pixels, which become one of the picture, look at different distances: no rings.
  float near = (float(2 * (at.x & 1) + ((at.x ^ at.y) & 1)) + 0.5) / 4;
  float sum = 0;
  for (int d = 0; d < kDirections; ++d) {
    float angle = turn + 6.2832 * float(d) / float(kDirections);
    for (int s = 0; s < kSteps; ++s) {
      float share = (float(s) + near) / float(kSteps);
      vec2 step_px = vec2(cos(angle), sin(angle)) * (1 + radius_px * share * share);
      ivec2 there = at + ivec2(round(step_px));
      float other = depth_at(there);
      if (other == far_depth) continue;
      vec3 v = point_of(there, other) - p;
      float square = dot(v, v);
      float weight = max(1 - square / (radius * radius), 0);
      sum += weight * max(dot(v, n) - least, 0) / sqrt(square + least * least);
    }
  }
  float open = max(1 - 2.6 * sum / float(kDirections * kSteps), 0);
  color = vec4(vec3(open), 1);
}
)";

}  // namespace

Status draw_occlusion(ProgramCache& programs, const GlTexture& depth, const DrawPass& pass,
                      const DrawStyle& style) {
  const Result<const GlProgram*> got =
      programs.get("occlusion", kCoverVertexShader, kOcclusionFragmentShader);
  if (!got.ok()) return got.failure();
  const GLuint program = (*got)->id();
  const auto at = [program](const char* name) { return glGetUniformLocation(program, name); };
  GLint viewport[4];
  glGetIntegerv(GL_VIEWPORT, viewport);
  glUseProgram(program);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, depth.id());
  glUniform1i(at("depths"), 0);
  glUniform4i(at("viewport"), viewport[0], viewport[1], viewport[2], viewport[3]);
  const double unit = unit_of(pass.depth), n = unit * pass.depth.near, f = unit * pass.depth.far;
  const double slope = (f - n) / (f * n);
  glUniform2f(at("inverse_distance"), float(style.reversed_depth ? slope : -slope),
              float(style.reversed_depth ? 1 / f : 1 / n));
  glUniform1f(at("far_depth"), style.reversed_depth ? 0.0f : 1.0f);
  const Window& window = pass.window;
  const double step_x = 2 * pass.view.tan_half_width * (window.right - window.left) / viewport[2];
  const double step_y = 2 * pass.view.tan_half_height * (window.top - window.bottom) / viewport[3];
  glUniform4f(at("ray"), float((2 * window.left - 1) * pass.view.tan_half_width + step_x / 2),
              float((2 * window.bottom - 1) * pass.view.tan_half_height + step_y / 2),
              float(step_x), float(step_y));
  glUniform1f(at("radius_px"), float(kRadius * viewport[3] / (window.top - window.bottom)));

  const GlVertexArray no_attributes = GlVertexArray::make();
  glBindVertexArray(no_attributes.id());
  glDisable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_ZERO, GL_SRC_COLOR, GL_ZERO, GL_ONE);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glEnable(GL_DEPTH_TEST);
  return Done{};
}

}  // namespace crease
