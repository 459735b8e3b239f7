#include "runtime/cut_drawing.h"

#include "hierarchy/geometric_normal.h"
#include "runtime/draw_values.h"

#include <algorithm>
#include <array>

namespace crease {

namespace {

constexpr std::size_t kNormalsPerTriangle[] = {0, 1, 3};

// Face normals that come from different ones are shown as three.
Part shown_kind(const ActiveCut& cut, const Geomorphs& geomorphs, ActiveTriangles& part,
                std::uint32_t triangle) {
  const Part kind = cut.sort(part, triangle);
  if (kind != kFnPart || part.is_derived[triangle] != 0 || geomorphs.moving_count() == 0) {
    return kind;
  }
  for (std::size_t c = 3 * std::size_t(triangle); c < 3 * std::size_t(triangle) + 3; ++c) {
    if (geomorphs.moves_normal(part.slots[c], cut.normal_index(part, c))) return kNsnPart;
  }
  return kind;
}

}  // namespace

Vec3f geometric_normal_of(const ActiveCut& cut, const ActiveTriangles& part,
                          std::uint32_t triangle) {
  const std::uint32_t* const slots = &part.slots[3 * std::size_t(triangle)];
  const std::span<const ActiveVertex> vertices = cut.vertices();
  return geometric_normal(vertices[slots[0]].position, vertices[slots[1]].position,
                          vertices[slots[2]].position);
}

// Of a derived triangle its geometric normal, as it is seen.
void CutDrawing::show_normals(const ActiveCut& cut, const Geomorphs& geomorphs,
                              const ActiveTriangles& part, std::uint32_t triangle,
                              std::span<Vec3f> shown) const {
  const std::uint32_t* const slots = &part.slots[3 * std::size_t(triangle)];
  if (part.is_derived[triangle] != 0) {
    Vec3f n = geometric_normal_of(cut, part, triangle);
    const bool is_plain = n != Vec3f{} || cut.normal_layer() == kNone;
    if (is_plain && geomorphs.moving_count() > 0 &&
        std::any_of(slots, slots + 3,
                    [&](std::uint32_t slot) { return geomorphs.is_moving(slot); })) {
      const Vec3f& a = positions_[slots[0]];
      const Vec3f now = normalized(cross(positions_[slots[1]] - a, positions_[slots[2]] - a));
      if (now != Vec3f{}) n = now;
    }
    std::fill(shown.begin(), shown.end(), n);
    if (is_plain) return;
  }
  const std::array<std::uint32_t, 3> values = cut.sorted_normals(part, triangle);
  if (geomorphs.moving_count() == 0) {
    const StoredValues& directions = cut.hierarchy().layers[cut.normal_layer()].values;
    return directions.directions({values.data(), shown.size()}, shown);
  }
  for (std::size_t k = 0; k < shown.size(); ++k) {
    shown[k] = geomorphs.normal(slots[k], values[k]);
  }
}

void CutDrawing::arrive(ActiveCut& cut, const Geomorphs& geomorphs) {
  sort_touched(cut, geomorphs);
  cut.fill_holes();
  refresh_vertices(cut, geomorphs);
  for (const Part p : {kSnPart, kFnPart, kNsnPart}) refresh_part(cut, geomorphs, p);
}

void CutDrawing::sort_touched(ActiveCut& cut, const Geomorphs& geomorphs) {
  for (const Part p : {kSnPart, kFnPart, kNsnPart}) {
    touched_.clear();
    ActiveTriangles& part = cut.parts()[p];
    part.touched.take(part.size(), ranges_,
                      [this](std::size_t i) { touched_.push_back(static_cast<std::uint32_t>(i)); });
    for (std::size_t i = 0; i < touched_.size(); ++i) {
      const std::uint32_t t = touched_[i];
      if (i + 8 < touched_.size()) cut.prefetch_vertices_of(part, touched_[i + 8]);
      if (part.ids[t] == kNoTriangle) continue;
      const Part now = shown_kind(cut, geomorphs, part, t);
      if (now == p) {
        part.shaded.mark(t);
      } else {
        cut.move_triangle(p, t, now);
      }
    }
  }
}

void CutDrawing::refresh_vertices(ActiveCut& cut, const Geomorphs& geomorphs) {
  positions_.resize(cut.vertices().size());
  vertex_normals_.resize(cut.vertices().size());
  const auto refresh = [&](std::size_t slot) {
    const ActiveVertex& v = cut.vertices()[slot];
    if (v.node == kNoNode) return;
    const auto at = static_cast<std::uint32_t>(slot);
    positions_[slot] = geomorphs.position(cut, at);
    if (v.normal >= ActiveVertex::kNoNormal) return;
    vertex_normals_[slot] = geomorphs.normal(at, v.normal);
  };
  cut.vertex_changes().take(positions_.size(), changes_.positions, refresh);
  changes_.vertex_normals = changes_.positions;
}

void CutDrawing::refresh_part(ActiveCut& cut, const Geomorphs& geomorphs, Part p) {
  const MeshHierarchy& hierarchy = cut.hierarchy();
  ActiveTriangles& part = cut.parts()[p];
  const std::size_t normal_count = kNormalsPerTriangle[p];
  const std::uint32_t color_layer = cut.color_layer();
  part.normals.resize(normal_count * part.size());
  const std::uint32_t texcoord_layer = cut.texcoord_layer();
  if (color_layer != kNone) part.colors.resize(3 * part.size());
  if (texcoord_layer != kNone) part.texcoords.resize(3 * part.size());
  const auto refresh_shading = [&](std::size_t t) {
    const auto corner = static_cast<std::uint32_t>(3 * t);
    if (normal_count > 0) {
      show_normals(cut, geomorphs, part, static_cast<std::uint32_t>(t),
                   std::span<Vec3f>(part.normals).subspan(normal_count * t, normal_count));
    }
    for (std::uint32_t k = 0; color_layer != kNone && k < 3; ++k) {
      const std::size_t value = cut.value_index(part, corner + k, color_layer);
      const StoredValue color = hierarchy.layers[color_layer].values[value];
      part.colors[3 * t + k] = draw_color(color);
    }
    for (std::uint32_t k = 0; texcoord_layer != kNone && k < 3; ++k) {
      const std::size_t value = cut.value_index(part, corner + k, texcoord_layer);
      const StoredValue uv = hierarchy.layers[texcoord_layer].values[value];
      part.texcoords[3 * t + k] = {uv[0], uv[1]};
    }
  };
  std::vector<Range>* const index_ranges[] = {&changes_.sn_indices, &changes_.fn_indices,
                                              &changes_.nsn_indices};
  std::vector<Range>* const normal_ranges[] = {nullptr, &changes_.fn_normals,
                                               &changes_.nsn_normals};
  std::vector<Range>* const color_ranges[] = {&changes_.sn_colors, &changes_.fn_colors,
                                              &changes_.nsn_colors};
  const auto& materials = hierarchy.vertices.material_of_triangle;
  if (!materials.empty()) part.materials.resize(part.size());
  part.moved.take(part.size(), *index_ranges[p], [&](std::size_t t) {
    if (materials.empty()) return;
    part.materials[t] = static_cast<std::uint32_t>(index_of(materials[index_of(part.ids[t])]));
  });
  part.shaded.take(part.size(), ranges_, refresh_shading);
  if (normal_ranges[p] != nullptr) *normal_ranges[p] = ranges_;
  if (color_layer != kNone || texcoord_layer != kNone) *color_ranges[p] = ranges_;
}

DrawList CutDrawing::draw_list(const ActiveCut& cut) const {
  DrawList list;
  list.origin = cut.hierarchy().vertices.grid.origin;
  list.positions = positions_;
  list.vertex_normals = vertex_normals_;
  DrawPart* const draw[] = {&list.sn, &list.fn, &list.nsn};
  for (const Part p : {kSnPart, kFnPart, kNsnPart}) {
    const ActiveTriangles& part = cut.parts()[p];
    *draw[p] = {part.slots, part.normals, part.materials, part.colors, part.texcoords};
  }
  list.materials = cut.hierarchy().materials;
  return list;
}

}  // namespace crease
