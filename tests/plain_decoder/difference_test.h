// What the codec and the plain decoder have, side by side.
#pragma once

#include "codec/decode_block.h"
#include "plain_decoder/block.h"

#include <cstddef>
#include <span>
#include <string>

namespace crease {

// Empty, or what differs first.
inline std::string difference(const codec::PatchMesh& mesh,
                              std::span<const codec::VertexName> names,
                              const codec::BlockCoding& coding, const plain::End& end) {
  if (mesh.positions.size() != end.places.size()) return "how many vertices";
  if (mesh.triangles.size() != end.triangles.size()) return "how many triangles";
  for (std::size_t v = 0; v < end.places.size(); ++v) {
    const std::string at = " of vertex " + std::to_string(v);
    const Vec3i& p = mesh.positions[v];
    if (plain::Point{p.x, p.y, p.z} != end.places[v]) return "place" + at;
    if (plain::Name{names[v].block, names[v].vertex} != end.names[v]) return "name" + at;
  }
  if (mesh.triangles.empty()) return {};
  if (mesh.values.size() != end.codes.size()) return "how many layers";
  for (std::size_t t = 0; t < end.triangles.size(); ++t) {
    const std::string at = " of triangle " + std::to_string(t);
    if (mesh.triangles[t] != end.triangles[t]) return "corners" + at;
    const plain::Category category{mesh.category[t] % coding.material_count,
                                   mesh.category[t] / coding.material_count};
    if (category != end.categories[t]) return "category" + at;
    if ((mesh.derived[t] != 0) != end.derived[t]) return "derived" + at;
    for (std::size_t l = 0; l < end.codes.size(); ++l) {
      if (coding.layers[l].is_normal && end.derived[t]) continue;
      for (std::size_t c = 3 * t; c < 3 * t + 3; ++c) {
        if (mesh.values[l][c] != end.codes[l][c]) return "code in layer " + std::to_string(l) + at;
      }
    }
  }
  return {};
}

inline std::string difference(const codec::DecodedBlock& block, const codec::BlockCoding& coding,
                              const plain::Block& other) {
  const plain::End& end = other.fine;
  const std::string what = difference(block.end.mesh, block.end.names, coding, end);
  if (!what.empty()) return what;
  if (block.end.labels != end.labels) return "labels";
  if (block.splits.size() != other.splits.size()) return "how many splits";
  const std::size_t first_second = end.places.size() - other.splits.size();
  for (std::size_t i = 0; i < other.splits.size(); ++i) {
    const codec::Split& a = block.splits[i];
    const plain::Split& b = other.splits[i];
    const Vec3i& p = a.parent_position;
    if (a.vertex != b.vertex || first_second + i != b.second ||
        a.first_triangle != b.first_triangle || a.triangle_count != b.triangle_count ||
        plain::Point{p.x, p.y, p.z} != b.place) {
      return "split " + std::to_string(i);
    }
  }
  return {};
}

}  // namespace crease
