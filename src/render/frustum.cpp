#include "render/frustum.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace crease {

namespace {

constexpr double kFlat = 4;             // a scene is flat if the frustum is so much higher
constexpr double kRoom = 0.03;          // around a flat scene and the eye, of their size
constexpr double kShownRoom = 0.15;     // lines further off from the scene may leave the picture
constexpr double kPictureShare = 0.05;  // of the frustum's length: the picture near the eye

View view_of(const Camera& camera) {
  return make_view(camera, double(camera.width_px) / camera.height_px);
}

// How far the farthest point is that the camera sees, along its line of sight.
double reach(Scene scene, const View& view) {
  double seen = 0;
  Box box;
  for (const PointSet& set : scene) {
    const Vec3d shift = set.origin - view.eye;
    for (const Vec3f& p : set.points) {
      const Vec3d to = shift + Vec3d{p.x, p.y, p.z};
      box.add(to);
      const double depth = -dot(to, view.back);
      if (depth > seen && std::abs(dot(to, view.right)) <= view.tan_half_width * depth &&
          std::abs(dot(to, view.above)) <= view.tan_half_height * depth) {
        seen = depth;
      }
    }
  }
  if (seen > 0) return seen;
  const double size = box.empty ? 0 : length(box.high - box.low);
  return size > 0 ? size : 1;
}

Box bounds_of(Scene scene) {
  Box box;
  for (const PointSet& set : scene) {
    for (const Vec3f& p : set.points) box.add(set.origin + Vec3d{p.x, p.y, p.z});
  }
  return box;
}

// Of the rectangle at a depth, around it.
std::array<Vec3d, 4> rectangle(const View& view, double depth) {
  const Vec3d middle = view.eye - view.back * depth;
  const Vec3d right = view.right * (view.tan_half_width * depth);
  const Vec3d above = view.above * (view.tan_half_height * depth);
  return {middle - right - above, middle + right - above, middle + right + above,
          middle - right + above};
}

// Lines end at the sides of this box. Over a flat scene it is the scene's and the eye's, with some
// room but below, so that the frustum shows what it covers and does not fill the sky.
Box stage_of(Scene scene, const View& view, const Vec3d& up, double depth) {
  Box box = bounds_of(scene);
  int upright = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::abs(up[i]) > std::abs(up[upright])) upright = i;
  }
  const double height = box.high[upright] - box.low[upright];
  box.add(view.eye);
  const bool is_flat = kFlat * height < 2 * depth * view.tan_half_height;
  for (int i = 0; i < 3; ++i) {
    const double room = is_flat ? kRoom * (box.high[i] - box.low[i]) : HUGE_VAL;
    if (!is_flat || i != upright || up[i] < 0) box.low[i] -= room;
    if (!is_flat || i != upright || up[i] > 0) box.high[i] += room;
  }
  return box;
}

// How far a point is inside one of the six sides of a box.
double inside(const Box& box, int side, const Vec3d& p) {
  const int axis = side / 2;
  return side % 2 == 0 ? p[axis] - box.low[axis] : box.high[axis] - p[axis];
}

// The part of a convex polygon on the inner side, and the segment that is cut out of it.
std::vector<Vec3d> cut(const std::vector<Vec3d>& polygon, const Box& box, int side,
                       std::vector<Segment>& edges) {
  std::vector<Vec3d> kept, crossings;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double in_a = inside(box, side, a), in_b = inside(box, side, b);
    if (in_a >= 0) kept.push_back(a);
    if ((in_a >= 0) == (in_b >= 0)) continue;
    crossings.push_back(a + (b - a) * (in_a / (in_a - in_b)));
    kept.push_back(crossings.back());
  }
  if (crossings.size() == 2) edges.push_back({crossings[0], crossings[1]});
  return kept;
}

// The part of a segment inside the box, if any; `on_side` is the side that it lies in.
void add_clipped(const Box& box, Segment line, std::vector<Segment>& lines, int on_side = -1) {
  for (int side = 0; side < 6; ++side) {
    if (side == on_side) continue;
    const double from = inside(box, side, line.from), to = inside(box, side, line.to);
    if (from < 0 && to < 0) return;
    const Vec3d crossing = line.from + (line.to - line.from) * (from / (from - to));
    if (from < 0) line.from = crossing;
    if (to < 0) line.to = crossing;
  }
  lines.push_back(line);
}

// Where the box cuts the polygon.
void add_section(const Box& box, std::vector<Vec3d> polygon, std::vector<Segment>& lines) {
  for (int side = 0; side < 6; ++side) {
    std::vector<Segment> edges;
    polygon = cut(polygon, box, side, edges);
    for (const Segment& edge : edges) add_clipped(box, edge, lines, side);
  }
}

}  // namespace

std::vector<Segment> frustum_lines(Scene scene, const Camera& camera) {
  const View view = view_of(camera);
  const double depth = reach(scene, view);
  const Box stage = stage_of(scene, view, camera.up, depth);
  std::vector<Segment> lines;
  const std::array<Vec3d, 4> far = rectangle(view, depth);
  const std::array<Vec3d, 4> near = rectangle(view, kPictureShare * depth);
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t next = (i + 1) % 4;
    lines.push_back({near[i], near[next]});
    add_clipped(stage, {view.eye, far[i]}, lines);
    add_clipped(stage, {far[i], far[next]}, lines);
    add_section(stage, {view.eye, far[i], far[next]}, lines);
  }
  add_section(stage, {far.begin(), far.end()}, lines);
  const Vec3d mark =
      (near[2] + near[3]) * 0.5 + view.above * (0.6 * view.tan_half_height * kPictureShare * depth);
  lines.push_back({near[3] * 0.7 + near[2] * 0.3, mark});
  lines.push_back({near[3] * 0.3 + near[2] * 0.7, mark});
  return lines;
}

Camera fit_outside(Scene scene, const Camera& seen, int width_px, int height_px) {
  const View view = view_of(seen);
  Box near_scene = bounds_of(scene);
  near_scene.add(view.eye);
  const Vec3d room = (near_scene.high - near_scene.low) * kShownRoom;
  near_scene.low = near_scene.low - room;
  near_scene.high += room;
  std::vector<Vec3f> marks;
  const auto mark = [&](const Vec3d& p) {
    for (int side = 0; side < 6; ++side) {
      if (inside(near_scene, side, p) < 0) return;
    }
    const Vec3d from_eye = p - view.eye;
    marks.push_back({float(from_eye.x), float(from_eye.y), float(from_eye.z)});
  };
  for (const Segment& line : frustum_lines(scene, seen)) {
    mark(line.from);
    mark(line.to);
  }
  std::vector<PointSet> all(scene.begin(), scene.end());
  all.push_back({view.eye, marks});
  return fit_camera_beside(all, -view.back, seen.up, width_px, height_px);
}

}  // namespace crease
