#include "flight.h"

#include <algorithm>
#include <cmath>

namespace crease::bench {

Box box_of(std::span<const Vec3d> positions) {
  Box box{positions[0], positions[0]};
  for (const Vec3d& p : positions) {
    for (int i = 0; i < 3; ++i) {
      box.low[i] = std::min(box.low[i], p[i]);
      box.high[i] = std::max(box.high[i], p[i]);
    }
  }
  return box;
}

Camera camera_at(const Box& box, bool is_city, double share) {
  const double a = 2 * kPi * share;
  Camera camera;
  camera.pixels = 1;
  if (is_city) {
    const auto point = [&](double t) {
      return box.at(0.5 + 0.35 * std::sin(t), 0.5 + 0.35 * std::sin(2 * t), 0) +
             Vec3d{0, 0, 0.04 * box.diagonal()};
    };
    camera.position = point(a);
    camera.target = point(a + 0.3) - Vec3d{0, 0, 0.02 * box.diagonal()};
  } else {
    const Vec3d middle = box.at(0.5, 0.5, 0.5);
    const double distance = box.diagonal() * (0.6 + 0.3 * std::cos(3 * a));
    camera.position = middle + Vec3d{std::cos(a), std::sin(a), 0.5 * std::sin(2 * a)} * distance;
    camera.target = middle;
  }
  return camera;
}

}  // namespace crease::bench
