// A mesh that uses everything a GLB can carry, for the writer's tests.
#pragma once

#include "crease/mesh.h"
#include "support/mesh_zoo.h"

#include <cstddef>

namespace crease {

// A hard box at city coordinates with texture coordinates, colours, two layers of its own, three
// materials (one without triangles) and two parts.
inline Mesh everything_mesh() {
  Mesh mesh = hard_box(2);
  for (Vec3d& p : mesh.positions) p += Vec3d{389'000.125, 5'819'000.25, 34.5};
  const std::size_t triangles = mesh.triangle_count();
  AttributeLayer uv{"uv", AttributeRole::TexCoord, Interpolation::Linear, 2, {}, {}};
  AttributeLayer color{"color", AttributeRole::Color, Interpolation::Linear, 4, {}, {}};
  AttributeLayer id{
      "semantic surface", AttributeRole::Other, Interpolation::Categorical, 1, {}, {}};
  AttributeLayer wind{"wind", AttributeRole::Other, Interpolation::Linear, 3, {}, {}};
  for (std::size_t t = 0; t < triangles; ++t) {
    const float share = float(t) / float(triangles);
    uv.values.insert(uv.values.end(), {share, 0.25f, 0.75f, 0.5f});
    color.values.insert(color.values.end(), {share, 1 - share, 0.5f, 1});
    id.values.push_back(float(t % 3));
    wind.values.insert(wind.values.end(), {share, -share, 12.5f});
    for (std::size_t c = 0; c < 3; ++c) {
      uv.of_corner.push_back(static_cast<AttributeId>(2 * t + c % 2));
      color.of_corner.push_back(static_cast<AttributeId>(t));
      id.of_corner.push_back(static_cast<AttributeId>(t));
      wind.of_corner.push_back(static_cast<AttributeId>(t));
    }
    mesh.material_of_triangle.push_back(static_cast<MaterialId>(t % 2));
    mesh.part_of_triangle.push_back(static_cast<PartId>(t * 2 / triangles));
  }
  for (AttributeLayer* layer : {&uv, &color, &id, &wind}) mesh.layers.push_back(std::move(*layer));
  mesh.materials = {{"brick", {0.5f, 0.2f, 0.1f, 1}, "brick wall.png"},
                    {"glass", {0.5f, 0.75f, 1, 0.25f}, ""},
                    {"nothing", {1, 1, 1, 1}, ""}};
  mesh.parts = {"north", "south"};
  return mesh;
}

}  // namespace crease
