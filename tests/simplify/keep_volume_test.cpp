// Levels of what is closed have its volume: they do not shrink, although triangles cut off what
// bends outward.
#include "simplify/reduce.h"
#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

namespace crease {
namespace {

double volume_of(const Mesh& mesh) {
  double volume = 0;
  for (const auto& corners : mesh.triangles) {
    const auto at = [&](std::size_t c) { return mesh.positions[index_of(corners[c])]; };
    volume += dot(at(0), cross(at(1), at(2))) / 6;
  }
  return volume;
}

}  // namespace

TEST_CASE("levels keep the volume") {
  constexpr double kShares[] = {0.25, 0.1, 0.05};
  struct Case {
    std::string name;
    Mesh mesh;
    double most[3];  // of the volume; by the quadrics alone it is four times as much
  };
  for (const Case& c : {Case{"sphere", smooth_sphere(40, 60), {0.0006, 0.0016, 0.003}},
                        Case{"torus", torus(40, 60), {0.0012, 0.003, 0.006}},
                        Case{"cylinder", hard_cylinder(60, 20), {1e-6, 1e-6, 0.0013}}}) {
    CAPTURE(c.name);
    const double whole = volume_of(c.mesh);
    for (std::size_t i = 0; i < 3; ++i) {
      CAPTURE(kShares[i]);
      const Reached level =
          reduce(c.mesh, std::size_t(kShares[i] * double(c.mesh.triangle_count())));
      CHECK(std::abs(volume_of(level.mesh) / whole - 1) < c.most[i]);
    }
  }
}

}  // namespace crease
