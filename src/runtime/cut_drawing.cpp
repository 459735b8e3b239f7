#include "runtime/cut_drawing.h"

#include "hierarchy/geometric_normal.h"
#include "runtime/draw_values.h"

#include <algorithm>
#include <array>

namespace crease {

namespace {

constexpr std::size_t kNormalsPerTriangle[] = {0, 1, 3};

// Of scratch, which stays as large as it ever was.
template <typename T>
void make_room(std::vector<T>& items, std::size_t count) {
  if (items.size() < count) items.resize(count);
}

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

// The marked elements, and the ranges that they make up.
void CutDrawing::take(ChangeSet& marked, std::size_t active) {
  taken_.clear();
  marked.take(active, ranges_,
              [this](std::size_t i) { taken_.push_back(static_cast<std::uint32_t>(i)); });
}

void CutDrawing::sort_touched(ActiveCut& cut, const Geomorphs& geomorphs) {
  for (const Part p : {kSnPart, kFnPart, kNsnPart}) {
    ActiveTriangles& part = cut.parts()[p];
    take(part.touched, part.size());
    for (std::size_t i = 0; i < taken_.size(); ++i) {
      const std::uint32_t t = taken_[i];
      if (i + 8 < taken_.size()) cut.prefetch_vertices_of(part, taken_[i + 8]);
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

// The first ones in values_, into decoded_, all at once.
void CutDrawing::decode_values(const ActiveCut& cut, std::size_t count) {
  if (count == 0) return;
  make_room(decoded_, count);
  const StoredValues& directions = cut.hierarchy().layers[cut.normal_layer()].values;
  directions.directions({values_.data(), count}, {decoded_.data(), count});
}

void CutDrawing::refresh_vertices(ActiveCut& cut, const Geomorphs& geomorphs) {
  positions_.resize(cut.vertices().size());
  vertex_normals_.resize(cut.vertices().size());
  take(cut.vertex_changes(), positions_.size());
  changes_.positions = changes_.vertex_normals = ranges_;
  const bool is_moving = geomorphs.moving_count() > 0;
  std::size_t with_normals = 0;  // in front of taken_
  make_room(values_, taken_.size());
  for (const std::uint32_t slot : taken_) {
    const ActiveVertex& v = cut.vertices()[slot];
    if (v.node == kNoNode) continue;
    positions_[slot] = geomorphs.position(cut, slot);
    if (v.normal >= ActiveVertex::kNoNormal) continue;
    if (is_moving) {
      vertex_normals_[slot] = geomorphs.normal(slot, v.normal);
      continue;
    }
    values_[with_normals] = v.normal;
    taken_[with_normals++] = slot;
  }
  decode_values(cut, with_normals);
  for (std::size_t i = 0; i < with_normals; ++i) vertex_normals_[taken_[i]] = decoded_[i];
}

// Of the triangles in taken_.
template <std::size_t kPerTriangle>
void CutDrawing::refresh_normals(const ActiveCut& cut, const Geomorphs& geomorphs,
                                 ActiveTriangles& part) {
  const bool is_moving = geomorphs.moving_count() > 0;
  make_room(values_, kPerTriangle * taken_.size());
  std::uint32_t* value = values_.data();
  for (const std::uint32_t t : taken_) {
    if (is_moving || part.is_derived[t] != 0) {
      show_normals(cut, geomorphs, part, t, {&part.normals[kPerTriangle * t], kPerTriangle});
      continue;
    }
    const std::array<std::uint32_t, 3> values = cut.sorted_normals(part, t);
    for (std::size_t k = 0; k < kPerTriangle; ++k) *value++ = values[k];
  }
  if (is_moving) return;
  decode_values(cut, static_cast<std::size_t>(value - values_.data()));
  const Vec3f* decoded = decoded_.data();
  for (const std::uint32_t t : taken_) {
    if (part.is_derived[t] != 0) continue;
    Vec3f* const normals = &part.normals[kPerTriangle * t];
    for (std::size_t k = 0; k < kPerTriangle; ++k) normals[k] = *decoded++;
  }
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
  std::vector<Range>* const index_ranges[] = {&changes_.sn_indices, &changes_.fn_indices,
                                              &changes_.nsn_indices};
  std::vector<Range>* const normal_ranges[] = {nullptr, &changes_.fn_normals,
                                               &changes_.nsn_normals};
  std::vector<Range>* const color_ranges[] = {&changes_.sn_colors, &changes_.fn_colors,
                                              &changes_.nsn_colors};
  const auto& materials = hierarchy.vertices.material_of_triangle;
  if (materials.empty()) {
    part.moved.take(part.size(), *index_ranges[p], [](std::size_t) {});
  } else {
    part.materials.resize(part.size());
    part.moved.take(part.size(), *index_ranges[p], [&](std::size_t t) {
      part.materials[t] = static_cast<std::uint32_t>(index_of(materials[index_of(part.ids[t])]));
    });
  }
  take(part.shaded, part.size());
  if (p == kFnPart) refresh_normals<1>(cut, geomorphs, part);
  if (p == kNsnPart) refresh_normals<3>(cut, geomorphs, part);
  for (const std::uint32_t t : taken_) {
    for (std::uint32_t c = 3 * t; color_layer != kNone && c < 3 * t + 3; ++c) {
      const std::size_t value = cut.value_index(part, c, color_layer);
      const StoredValue color = hierarchy.layers[color_layer].values[value];
      part.colors[c] = draw_color(color);
    }
    for (std::uint32_t c = 3 * t; texcoord_layer != kNone && c < 3 * t + 3; ++c) {
      const std::size_t value = cut.value_index(part, c, texcoord_layer);
      const StoredValue uv = hierarchy.layers[texcoord_layer].values[value];
      part.texcoords[c] = {uv[0], uv[1]};
    }
  }
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
