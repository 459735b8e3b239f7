#include "render/transform.h"

#include "runtime/view_frame.h"

#include <algorithm>
#include <cmath>

namespace crease {

namespace {

Vec3d corner_of(const Vec3d& low, const Vec3d& high, int i) {
  return {(i & 1) ? high.x : low.x, (i & 2) ? high.y : low.y, (i & 4) ? high.z : low.z};
}

}  // namespace

View make_view(const Camera& camera, double aspect) {
  View view;
  view.eye = camera.position;
  const ViewFrame frame = view_frame(camera);
  view.back = frame.forward * -1;
  view.right = frame.right;
  view.above = frame.up;

  const double camera_aspect = double(camera.width_px) / camera.height_px;
  const double tan_half = std::tan(radians(camera.vertical_fov_deg) / 2);
  view.tan_half_height = tan_half * std::max(1.0, camera_aspect / aspect);
  view.tan_half_width = view.tan_half_height * aspect;
  return view;
}

Camera camera_for_shape(const Camera& camera, int width_px, int height_px) {
  Camera shaped = camera;
  shaped.width_px = width_px;
  shaped.height_px = height_px;
  const View view = make_view(camera, double(width_px) / height_px);
  const double fov_deg = degrees(2 * std::atan(view.tan_half_height));
  shaped.vertical_fov_deg = std::max(camera.vertical_fov_deg, fov_deg);
  return shaped;
}

DepthRange depth_range(const View& view, const Vec3d& low, const Vec3d& high) {
  double near = 1e300, far = 0;
  for (int i = 0; i < 8; ++i) {
    const double distance = -dot(corner_of(low, high, i) - view.eye, view.back);
    near = std::min(near, distance);
    far = std::max(far, distance);
  }
  if (far <= 0) return {};  // everything is behind the viewer
  const double margin = 1e-3 * length(high - low) + 1e-6 * far;
  far += margin;
  return {std::max(near - margin, far / 20000), far};
}

double unit_of(const DepthRange& depth) {
  constexpr int kMost = 126;  // what a float holds
  return std::ldexp(1.0, std::clamp(-std::ilogb(depth.far), -kMost, kMost));
}

Matrix4f clip_from_list(const View& view, const Vec3d& origin, const DepthRange& depth,
                        const Window& window, bool reversed_depth) {
  const Vec3d shift = origin - view.eye;
  const double n = depth.near, f = depth.far;
  // The window of the frustum at distance 1.
  const double x0 = (2 * window.left - 1) * view.tan_half_width;
  const double x1 = (2 * window.right - 1) * view.tan_half_width;
  const double y0 = (2 * window.bottom - 1) * view.tan_half_height;
  const double y1 = (2 * window.top - 1) * view.tan_half_height;

  // Rows of the clip matrix as (direction, constant) of the point's offset from the eye.
  const Vec3d forward = -view.back;
  const Vec3d row_x = view.right * (2 / (x1 - x0)) - forward * ((x1 + x0) / (x1 - x0));
  const Vec3d row_y = view.above * (2 / (y1 - y0)) - forward * ((y1 + y0) / (y1 - y0));
  const Vec3d row_z = forward * (reversed_depth ? -n / (f - n) : (f + n) / (f - n));
  const double constant_z = (reversed_depth ? 1 : -2) * f * n / (f - n);

  const std::array<Vec3d, 4> rows{row_x, row_y, row_z, forward};
  const double unit = unit_of(depth);
  Matrix4f m{};
  for (std::size_t r = 0; r < 4; ++r) {
    m[0 + r] = float(unit * rows[r].x);
    m[4 + r] = float(unit * rows[r].y);
    m[8 + r] = float(unit * rows[r].z);
    m[12 + r] = float(unit * (dot(rows[r], shift) + (r == 2 ? constant_z : 0)));
  }
  return m;
}

Vec3d corner_of(const Box& box, int i) {
  return corner_of(box.low, box.high, i);
}

bool is_beside(const View& view, const Box& box) {
  int beyond[5] = {};
  for (int i = 0; i < 8; ++i) {
    const Vec3d to = corner_of(box, i) - view.eye;
    const double depth = -dot(to, view.back);
    const double x = dot(to, view.right), y = dot(to, view.above);
    beyond[0] += x > view.tan_half_width * depth;
    beyond[1] += -x > view.tan_half_width * depth;
    beyond[2] += y > view.tan_half_height * depth;
    beyond[3] += -y > view.tan_half_height * depth;
    beyond[4] += depth < 0;
  }
  for (const int count : beyond) {
    if (count == 8) return true;
  }
  return false;
}

void Box::add(const Vec3d& p) {
  if (empty) {
    low = high = p;
    empty = false;
    return;
  }
  low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
  high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
}

}  // namespace crease
