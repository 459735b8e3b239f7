// What a draw list shows, as the multiset of its triangles: corner positions, normals and texture
// coordinates.
#pragma once

#include "crease/draw_changes.h"
#include "crease/draw_list.h"
#include "crease/mesh.h"

#include <array>
#include <map>
#include <tuple>
#include <vector>

namespace crease {

using FloatKey = std::tuple<float, float, float>;
inline FloatKey key(const Vec3f& v) {
  return {v.x, v.y, v.z};
}

using TriangleBag = std::map<std::vector<FloatKey>, int>;

// `ranges`: in triangles, of SN, FN and NSN.
inline void add_drawn(const DrawList& list, const std::array<Range, 3>& ranges, TriangleBag& bag) {
  const std::array<const DrawPart*, 3> parts{&list.sn, &list.fn, &list.nsn};
  for (std::size_t i = 0; i < 3; ++i) {
    const DrawPart& part = *parts[i];
    for (std::size_t t = ranges[i].first; t < std::size_t(ranges[i].first) + ranges[i].count; ++t) {
      std::vector<FloatKey> corners;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = part.indices[3 * t + k];
        corners.push_back(key(list.positions[v]));
        corners.push_back(key(i == 0   ? list.vertex_normals[v]
                              : i == 1 ? part.normals[t]
                                       : part.normals[3 * t + k]));
        if (part.texcoords.empty()) continue;
        const std::array<float, 2>& uv = part.texcoords[3 * t + k];
        corners.push_back({uv[0], uv[1], 0});
      }
      ++bag[corners];
    }
  }
}

inline TriangleBag drawn(const DrawList& list) {
  const auto all = [](const DrawPart& part) {
    return Range{0, static_cast<std::uint32_t>(part.triangle_count())};
  };
  TriangleBag bag;
  add_drawn(list, {all(list.sn), all(list.fn), all(list.nsn)}, bag);
  return bag;
}

// Whose texture coordinates are drawn, or null.
inline const AttributeLayer* texcoords_of(const Mesh& mesh) {
  for (const AttributeLayer& layer : mesh.layers) {
    if (layer.role == AttributeRole::TexCoord && layer.dimension == 2) return &layer;
  }
  return nullptr;
}

// What should be drawn. `place`: Vec3d to the Vec3f that a renderer gets.
template <typename Place>
TriangleBag drawn_of_mesh(const Mesh& mesh, Place place) {
  TriangleBag bag;
  const AttributeLayer* painted = texcoords_of(mesh);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    std::vector<FloatKey> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners.push_back(key(place(mesh.positions[index_of(mesh.triangles[t][k])])));
      const auto n = mesh.normals()->value(mesh.normals()->of_corner[3 * t + k]);
      corners.push_back({n[0], n[1], n[2]});
      if (painted == nullptr) continue;
      const auto uv = painted->value(painted->of_corner[3 * t + k]);
      corners.push_back({uv[0], uv[1], 0});
    }
    ++bag[corners];
  }
  return bag;
}

}  // namespace crease
