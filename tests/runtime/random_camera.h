#pragma once

#include "crease/camera.h"
#include "crease/mesh_hierarchy.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace crease {

// Somewhere around the model, looking about at it, with 1/20 to 20 pixels of error.
inline Camera random_camera(const MeshHierarchy& h, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto point = [&] {
    const double x = unit(random), y = unit(random), z = unit(random);
    return Vec3d{x, y, z};
  };
  double size = 2000 * h.vertices.grid.step;
  for (const SplitBounds& bounds : h.vertices.bounds) {
    size = std::max(size, double(bounds.radius.value()));
  }
  Camera camera;
  camera.position = h.vertices.grid.origin + point() * (2 * size);
  camera.target = h.vertices.grid.origin + point() * (0.5 * size);
  camera.width_px = 400, camera.height_px = 300;
  camera.pixels = std::exp(3 * unit(random));
  return camera;
}

}  // namespace crease
