#include "render/fit_camera.h"

#include <algorithm>
#include <map>
#include <vector>

namespace crease {

namespace {

constexpr double kFieldOfViewDeg = 35;  // a portrait lens: little distortion at the borders
constexpr double kMargin = 1.06;        // the picture over the scene

constexpr double kSameSize = 2;  // sizes of what lies at one place, larger over smaller

constexpr double kStrays = 0.01;  // of the points at each end of each axis: not where most are
constexpr double kFarLarger = 8;  // the whole than where most points are, so that these are shown
constexpr double kSurrounding = 0.2;  // and as much of their size around them

struct Direction {
  Vec3d towards_eye, up;
};

Vec3d unit_up(const Vec3d& wanted) {
  const Vec3d up = normalized(wanted);
  return up == Vec3d{} ? Vec3d{0, 0, 1} : up;
}

// Three-quarter view from the front right. Low scenes from 33 degrees above, so that streets show;
// objects as tall as wide from 20, so that they stand.
Direction three_quarter(const Box& box, const Vec3d& up_wanted) {
  const Vec3d up = unit_up(up_wanted);
  // Right-handed frame with `up` as its third axis: x to the right unless up is along x.
  const Vec3d first_axis = std::abs(up.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d depth_axis = normalized(cross(up, first_axis));  // away from the viewer
  const Vec3d right_axis = cross(depth_axis, up);

  const Vec3d size = box.high - box.low;
  const auto extent = [&](const Vec3d& axis) {
    return std::abs(axis.x) * size.x + std::abs(axis.y) * size.y + std::abs(axis.z) * size.z;
  };
  const double tall = extent(up) / std::max({extent(right_axis), extent(depth_axis), 1e-300});
  const double elevation = radians(33 - 13 * std::clamp((tall - 0.1) / 0.5, 0.0, 1.0));
  const double azimuth = radians(32);  // from the front towards the right
  const Vec3d level = right_axis * std::sin(azimuth) - depth_axis * std::cos(azimuth);
  return {level * std::cos(elevation) + up * std::sin(elevation), up};
}

// From behind to the right of someone who looks along `forward`, and from above.
Direction beside(const Box& box, const Vec3d& forward, const Vec3d& up_wanted) {
  const Vec3d up = unit_up(up_wanted);
  const Vec3d level = forward - up * dot(forward, up);
  if (length(level) < 0.2 * length(forward)) return three_quarter(box, up);
  const Vec3d ahead = normalized(level);
  const double azimuth = radians(55), elevation = radians(35);
  const Vec3d out = cross(ahead, up) * std::sin(azimuth) - ahead * std::cos(azimuth);
  return {out * std::cos(elevation) + up * std::sin(elevation), up};
}

Vec3d origin_of(Scene scene) {
  return scene.empty() ? Vec3d{} : scene[0].origin;
}

// All points, less the first set's origin.
std::vector<Vec3d> points_of(Scene scene) {
  std::vector<Vec3d> points;
  for (const PointSet& set : scene) {
    const Vec3d shift = set.origin - origin_of(scene);
    for (const Vec3f& p : set.points) points.push_back(shift + Vec3d{p.x, p.y, p.z});
  }
  return points;
}

Box box_of(std::span<const Vec3d> points) {
  Box box;
  for (const Vec3d& p : points) box.add(p);
  return box;
}

bool contains(const Box& box, const Vec3d& p) {
  for (int i = 0; i < 3; ++i) {
    if (p[i] < box.low[i] || p[i] > box.high[i]) return false;
  }
  return true;
}

// The box of the points but for the outermost at both ends of each axis.
Box box_without_strays(std::span<const Vec3d> points) {
  const auto strays = std::ptrdiff_t(kStrays * double(points.size()));
  Vec3d low, high;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Vec3d& p : points) values.push_back(p[axis]);
    const auto first = values.begin() + strays, last = values.end() - 1 - strays;
    std::nth_element(values.begin(), first, values.end());
    low[axis] = *first;
    std::nth_element(first, last, values.end());
    high[axis] = *last;
  }
  Box box;
  box.add(low);
  box.add(high);
  return box;
}

// What a picture is of: all points, or those near the others where a few make the scene many times
// as large. A town on a ground of two triangles would be some pixels, and so would a scan with one
// vertex far away.
std::vector<Vec3d> points_in_picture(Scene scene) {
  std::vector<Vec3d> points = points_of(scene);
  if (points.empty()) return points;
  const Box all = box_of(points), most = box_without_strays(points);
  const Vec3d size = most.high - most.low;
  if (length(all.high - all.low) < kFarLarger * length(size) || length(size) == 0) return points;
  Box near;
  near.add(most.low - size * kSurrounding);
  near.add(most.high + size * kSurrounding);
  std::erase_if(points, [&](const Vec3d& p) { return !contains(near, p); });
  return points;
}

bool is_one_place(const Box& a, const Box& b) {
  if (a.empty || b.empty) return true;
  const double size_a = length(a.high - a.low), size_b = length(b.high - b.low);
  const Box& smaller = size_a < size_b ? a : b;
  const Box& larger = size_a < size_b ? b : a;
  return contains(larger, (smaller.low + smaller.high) * 0.5) &&
         std::max(size_a, size_b) <= kSameSize * std::min(size_a, size_b);
}

Camera fit(const Vec3d& origin, std::span<const Vec3d> points, const Direction& direction,
           int width_px, int height_px) {
  Camera camera;
  camera.up = direction.up;
  camera.width_px = width_px;
  camera.height_px = height_px;
  camera.vertical_fov_deg = kFieldOfViewDeg;
  camera.position = direction.towards_eye;  // for the frame only
  View frame = make_view(camera, double(width_px) / height_px);
  const double tan_x = frame.tan_half_width / kMargin, tan_y = frame.tan_half_height / kMargin;

  // With coordinates (r, u, b) in the frame, a point is between the left and right planes of an eye
  // at (er, eu, eb) iff |r - er| <= tan_x (eb - b). So er lies between max(r + tan_x b) - tan_x eb
  // and min(r - tan_x b) + tan_x eb, which leaves room for eb from half their distance on.
  double r_high = -1e300, r_low = 1e300, u_high = -1e300, u_low = 1e300, b_high = -1e300;
  double b_low = 1e300;
  for (const Vec3d& p : points) {
    const double r = dot(p, frame.right), u = dot(p, frame.above), b = dot(p, frame.back);
    r_high = std::max(r_high, r + tan_x * b);
    r_low = std::min(r_low, r - tan_x * b);
    u_high = std::max(u_high, u + tan_y * b);
    u_low = std::min(u_low, u - tan_y * b);
    b_high = std::max(b_high, b);
    b_low = std::min(b_low, b);
  }
  double eye_back = std::max((r_high - r_low) / (2 * tan_x), (u_high - u_low) / (2 * tan_y));
  const double reach = std::abs(eye_back) + std::abs(b_high);
  eye_back = std::max(eye_back, b_high + (reach > 0 ? 1e-6 * reach : 1.0));  // a single point
  camera.position = origin + frame.right * ((r_high + r_low) / 2) +
                    frame.above * ((u_high + u_low) / 2) + frame.back * eye_back;
  camera.target = camera.position - frame.back * (eye_back - (b_low + b_high) / 2);
  return camera;
}

}  // namespace

Camera fit_camera_to(Scene scene, const Vec3d& up, int width_px, int height_px) {
  std::vector<Vec3d> points = points_in_picture(scene);
  const Direction direction = three_quarter(box_of(points), up);
  if (points.empty()) points.push_back({});
  return fit(origin_of(scene), points, direction, width_px, height_px);
}

Camera fit_camera_beside(Scene scene, const Vec3d& forward, const Vec3d& up, int width_px,
                         int height_px) {
  const std::vector<Vec3d> points = points_of(scene);
  const Direction direction = beside(box_of(points), forward, up);
  return fit(origin_of(scene), points, direction, width_px, height_px);
}

Camera fit_camera(const Vec3d& low, const Vec3d& high, int width_px, int height_px,
                  const Vec3d& up) {
  const Vec3d middle = (low + high) * 0.5;
  std::vector<Vec3f> corners;
  for (int i = 0; i < 8; ++i) {
    const Vec3d corner{(i & 1) ? high.x : low.x, (i & 2) ? high.y : low.y,
                       (i & 4) ? high.z : low.z};
    const Vec3d p = corner - middle;
    corners.push_back({float(p.x), float(p.y), float(p.z)});
  }
  const PointSet points{middle, corners};
  return fit_camera_to(std::span(&points, 1), up, std::max(1, width_px), std::max(1, height_px));
}

double projected_aspect(Scene scene, const Vec3d& up) {
  const std::vector<Vec3d> points = points_in_picture(scene);
  if (points.empty()) return 1;
  const Direction direction = three_quarter(box_of(points), up);
  Camera camera;
  camera.up = direction.up;
  camera.position = direction.towards_eye;
  const View frame = make_view(camera, 1);
  Box flat;
  for (const Vec3d& p : points) flat.add({dot(p, frame.right), dot(p, frame.above), 0});
  const Vec3d size = flat.high - flat.low;
  return std::clamp((size.x + 1e-30) / (size.y + 1e-30), 0.1, 10.0);
}

std::vector<std::size_t> places_of(Scene scene, std::span<const std::uint32_t> models) {
  std::map<std::uint32_t, Box> boxes;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const Box box = box_of(points_of(scene.subspan(i, 1)));
    if (box.empty) continue;
    boxes[models[i]].add(scene[i].origin + box.low);
    boxes[models[i]].add(scene[i].origin + box.high);
  }
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    std::size_t first = 0;
    while (first < i &&
           (places[first] != first || (models[first] != models[i] &&
                                       !is_one_place(boxes[models[first]], boxes[models[i]])))) {
      ++first;
    }
    places.push_back(first);
  }
  return places;
}

}  // namespace crease
