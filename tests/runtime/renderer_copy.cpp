#include "runtime/renderer_copy.h"

#include "runtime/draw_values.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <set>

namespace crease {

namespace {

template <typename T>
void fetch_ranges(std::vector<T>& to, std::span<const T> from, const std::vector<Range>& ranges,
                  std::size_t per_element) {
  to.resize(std::max(to.size(), from.size()));
  std::size_t end = 0;
  for (const Range& r : ranges) {
    REQUIRE(r.count > 0);
    REQUIRE(r.first >= end);  // sorted and disjoint
    end = std::size_t(r.first) + r.count;
    if (from.empty()) continue;
    REQUIRE(end * per_element <= from.size());
    std::copy_n(from.begin() + std::ptrdiff_t(r.first * per_element), r.count * per_element,
                to.begin() + std::ptrdiff_t(r.first * per_element));
  }
}

template <typename T>
bool begins_with(const std::vector<T>& copy, std::span<const T> active) {
  return copy.size() >= active.size() &&
         (active.empty() || std::memcmp(copy.data(), active.data(), active.size_bytes()) == 0);
}

const DrawPart& part_of(const DrawList& list, std::size_t p) {
  return p == 0 ? list.sn : p == 1 ? list.fn : list.nsn;
}

constexpr std::size_t kNormals[] = {0, 1, 3};

template <typename T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

RendererCopy::RendererCopy(const DrawList& list)
    : positions_(list.positions.begin(), list.positions.end()),
      vertex_normals_(list.vertex_normals.begin(), list.vertex_normals.end()) {
  for (std::size_t p = 0; p < 3; ++p) {
    const DrawPart& part = part_of(list, p);
    parts_[p].indices.assign(part.indices.begin(), part.indices.end());
    parts_[p].materials.assign(part.materials.begin(), part.materials.end());
    parts_[p].normals.assign(part.normals.begin(), part.normals.end());
    parts_[p].colors.assign(part.colors.begin(), part.colors.end());
    parts_[p].texcoords.assign(part.texcoords.begin(), part.texcoords.end());
  }
}

void RendererCopy::fetch(const DrawList& list, const DrawChanges& changes) {
  const std::vector<Range> none;
  const std::vector<Range>* const indices[] = {&changes.sn_indices, &changes.fn_indices,
                                               &changes.nsn_indices};
  const std::vector<Range>* const normals[] = {&none, &changes.fn_normals, &changes.nsn_normals};
  const std::vector<Range>* const colors[] = {&changes.sn_colors, &changes.fn_colors,
                                              &changes.nsn_colors};
  fetch_ranges(positions_, list.positions, changes.positions, 1);
  fetch_ranges(vertex_normals_, list.vertex_normals, changes.vertex_normals, 1);
  for (std::size_t p = 0; p < 3; ++p) {
    const DrawPart& part = part_of(list, p);
    fetch_ranges(parts_[p].indices, part.indices, *indices[p], 3);
    fetch_ranges(parts_[p].materials, part.materials, *indices[p], 1);
    fetch_ranges(parts_[p].normals, part.normals, *normals[p], kNormals[p]);
    fetch_ranges(parts_[p].colors, part.colors, *colors[p], 3);
    fetch_ranges(parts_[p].texcoords, part.texcoords, *colors[p], 3);
  }
}

std::string RendererCopy::difference(const DrawList& list) const {
  for (std::size_t p = 0; p < 3; ++p) {
    const DrawPart& part = part_of(list, p);
    if (!begins_with(parts_[p].indices, part.indices)) return "indices";
    if (!begins_with(parts_[p].materials, part.materials)) return "materials";
    if (!begins_with(parts_[p].normals, part.normals)) return "normals";
    if (!begins_with(parts_[p].colors, part.colors)) return "colours";
    if (!begins_with(parts_[p].texcoords, part.texcoords)) return "texture coordinates";
    for (const std::uint32_t slot : part.indices) {
      if (!(positions_[slot] == list.positions[slot])) return "position";
      if (p == 0 && !(vertex_normals_[slot] == list.vertex_normals[slot])) return "vertex normal";
    }
  }
  return {};
}

std::vector<std::string> shown_triangles(const DrawList& list) {
  std::vector<std::string> all;
  for (std::size_t p = 0; p < 3; ++p) {
    const DrawPart& part = part_of(list, p);
    for (std::size_t t = 0; t < part.triangle_count(); ++t) {
      std::string bytes;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t slot = part.indices[3 * t + k];
        append(bytes, list.positions[slot]);
        append(bytes, p == 0   ? list.vertex_normals[slot]
                      : p == 1 ? part.normals[t]
                               : part.normals[3 * t + k]);
        if (!part.texcoords.empty()) append(bytes, part.texcoords[3 * t + k]);
        if (!part.colors.empty()) append(bytes, part.colors[3 * t + k]);
      }
      if (!part.materials.empty()) append(bytes, part.materials[t]);
      all.push_back(std::move(bytes));
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

// Of a mesh whose positions are around the origin, as those of test meshes are.
std::vector<std::string> shown_triangles(const Mesh& mesh, const Grid& grid) {
  const auto color = std::find_if(mesh.layers.begin(), mesh.layers.end(), [](const auto& layer) {
    return layer.role == AttributeRole::Color;
  });
  const std::uint32_t painted = drawn_texcoords(mesh.layers);
  std::vector<std::string> all;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    std::string bytes;
    for (std::size_t k = 0; k < 3; ++k) {
      append(bytes,
             draw_position(grid, grid.nearest(mesh.positions[index_of(mesh.triangles[t][k])])));
      const auto n = mesh.normals()->value(mesh.normals()->of_corner[3 * t + k]);
      append(bytes, Vec3f{n[0], n[1], n[2]});
      if (painted != kNone) {
        const AttributeLayer& layer = mesh.layers[painted];
        const auto uv = layer.value(layer.of_corner[3 * t + k]);
        append(bytes, std::array<float, 2>{uv[0], uv[1]});
      }
      if (color != mesh.layers.end()) {
        append(bytes, draw_color(color->value(color->of_corner[3 * t + k])));
      }
    }
    if (!mesh.material_of_triangle.empty()) {
      append(bytes, static_cast<std::uint32_t>(index_of(mesh.material_of_triangle[t])));
    }
    all.push_back(std::move(bytes));
  }
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace crease
