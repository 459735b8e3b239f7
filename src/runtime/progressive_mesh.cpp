#include "crease/progressive_mesh.h"

#include "base/assert.h"
#include "hierarchy/geometric_normal.h"
#include "runtime/extract_level.h"
#include "runtime/progressive_impl.h"

#include <algorithm>

namespace crease {

namespace {

// Of the coarsest level of which `measure` is at most `most`.
template <typename Measure>
std::size_t applied_for(const PackedContractions& contractions, float most, Measure measure) {
  if (most < 0) return 0;
  const std::vector<ErrorStep>& errors = contractions.errors;
  const auto too_coarse =
      std::partition_point(errors.begin(), errors.end(),
                           [&](const ErrorStep& step) { return measure(step.error) <= most; });
  return too_coarse == errors.end() ? contractions.count() : too_coarse->applied - 1;
}

}  // namespace

ProgressiveMesh::Impl::Impl(ProgressiveArraysPtr given) : arrays(std::move(given)), state(*arrays) {
  const SectionCounts& full = arrays->full;
  base_triangles = full.triangles();
  std::size_t wide = 0;
  for (std::uint32_t word : arrays->contractions.headers) {
    const PackedHeader h = unpack_header(word);
    base_triangles -= (h.is_wide ? arrays->contractions.wide[wide++].lost : h.lost).triangles();
  }
  positions.reserve(state.positions.size());
  for (const Vec3i& g : state.positions) positions.push_back(draw_position(arrays->grid, g));
  for (std::uint32_t l = 0; l < arrays->layers.size() && color_layer == kMaxLayers; ++l) {
    if (arrays->layers[l].role == AttributeRole::Color) color_layer = l;
  }
  const std::uint32_t painted = drawn_texcoords(arrays->layers);
  if (painted != kNone) texcoord_layer = painted;
  position_changes.resize(full.vertices());
  own_normal_changes.resize(full.sn_vertices);
  const std::uint32_t counts[] = {full.sn_triangles, full.fn_triangles, full.nsn_triangles};
  const std::uint32_t normals_per_triangle[] = {0, 1, 3};
  std::uint32_t first = 0;
  for (int s = 0; s < kSectionCount; ++s) {
    TrianglePart& part = parts[s];
    part.first = first;
    first += counts[s];
    part.normals_per_triangle = normals_per_triangle[s];
    part.normals.resize(std::size_t(counts[s]) * part.normals_per_triangle);
    if (color_layer != kMaxLayers) part.colors.resize(3 * std::size_t(counts[s]));
    if (texcoord_layer != kMaxLayers) part.texcoords.resize(3 * std::size_t(counts[s]));
    part.index_changes.resize(counts[s]);
    part.normal_changes.resize(part.normals.empty() ? 0 : counts[s]);
    part.color_changes.resize(part.is_painted() ? counts[s] : 0);
    for (std::uint32_t t = 0; t < counts[s]; ++t) {
      refresh_normals(part, t);
      refresh_colors(part, t);
    }
  }
}

Vec3f ProgressiveMesh::Impl::shown_normal(std::uint32_t c) const {
  const std::uint32_t t = c / 3;
  if (state.is_derived(t)) {
    const std::uint32_t* slots = &state.indices[3 * std::size_t(t)];
    const Vec3f n = geometric_normal(state.positions[slots[0]], state.positions[slots[1]],
                                     state.positions[slots[2]]);
    if (n != Vec3f{}) return n;
  }
  return state.stored_normal(c);
}

void ProgressiveMesh::Impl::refresh_normals(TrianglePart& part, std::size_t t) {
  const std::uint32_t n = part.normals_per_triangle;
  const std::uint32_t first_corner = 3 * (part.first + static_cast<std::uint32_t>(t));
  for (std::uint32_t k = 0; k < n; ++k) {
    const auto i = static_cast<std::uint32_t>(t * n + k);
    Vec3f& drawn = part.normals[i];
    const Vec3f own = shown_normal(first_corner + k);
    const bool was_drawn = seconds > 0 && t < part.drawn;
    const Way* const way = part.ways.find(i);
    const bool is_known = way != nullptr && (way->is_leaving || way->to == own);
    if (was_drawn && !is_known) {
      part.ways.set(i, own, {drawn, own, now});
    } else if (!was_drawn) {
      part.ways.erase(i);
    }
    const Way* const now_on = part.ways.find(i);
    drawn = now_on == nullptr ? own : part.ways.shown(*now_on, now, seconds);
  }
}

void ProgressiveMesh::Impl::refresh_colors(TrianglePart& part, std::size_t t) {
  const std::uint32_t first_corner = 3 * (part.first + static_cast<std::uint32_t>(t));
  for (std::uint32_t k = 0; k < 3 && !part.colors.empty(); ++k) {
    part.colors[3 * t + k] = draw_color(state.value_of_corner(color_layer, first_corner + k));
  }
  for (std::uint32_t k = 0; k < 3 && !part.texcoords.empty(); ++k) {
    const std::span<const float> uv = state.value_of_corner(texcoord_layer, first_corner + k);
    part.texcoords[3 * t + k] = {uv[0], uv[1]};
  }
}

void ProgressiveMesh::Impl::move_to(std::size_t count) {
  Marks marks{*this};
  while (state.applied() < count) state.apply(marks);
  while (state.applied() > count) state.undo(marks);
}

void ProgressiveMesh::Impl::arrive() {
  position_changes.take(positions.size(), changes.positions, [this](std::size_t v) {
    positions[v] = shown_position(static_cast<std::uint32_t>(v));
  });
  own_normal_changes.take(state.own_normals.size(), changes.vertex_normals, [this](std::size_t v) {
    if (!own_normals.empty()) own_normals[v] = shown_own_normal(static_cast<std::uint32_t>(v));
  });
  std::vector<Range> none;
  std::vector<Range>* const index_ranges[] = {&changes.sn_indices, &changes.fn_indices,
                                              &changes.nsn_indices};
  std::vector<Range>* const normal_ranges[] = {&none, &changes.fn_normals, &changes.nsn_normals};
  std::vector<Range>* const color_ranges[] = {&changes.sn_colors, &changes.fn_colors,
                                              &changes.nsn_colors};
  for (int s = 0; s < kSectionCount; ++s) {
    TrianglePart& part = parts[s];
    const std::size_t active = active_of(s);
    part.index_changes.take(active, *index_ranges[s], [](std::size_t) {});
    if (!part.normals.empty()) {
      part.normal_changes.take(active, *normal_ranges[s],
                               [&](std::size_t t) { refresh_normals(part, t); });
    }
    if (part.is_painted()) {
      part.color_changes.take(active, *color_ranges[s],
                              [&](std::size_t t) { refresh_colors(part, t); });
    }
    part.drawn = active;
  }
}

DrawPart ProgressiveMesh::Impl::draw_part(int section) const {
  const TrianglePart& part = parts[section];
  const std::size_t count = active_of(section);
  DrawPart draw;
  draw.indices = triangles_of(state.indices, part.first, count, 3);
  draw.normals = triangles_of(part.normals, 0, count, part.normals_per_triangle);
  draw.materials = triangles_of(arrays->material_of_triangle, part.first, count, 1);
  draw.colors = triangles_of(part.colors, 0, count, 3);
  draw.texcoords = triangles_of(part.texcoords, 0, count, 3);
  return draw;
}

ProgressiveMesh::ProgressiveMesh(ProgressiveArraysPtr arrays)
    : impl_(std::make_unique<Impl>(std::move(arrays))) {}
ProgressiveMesh::~ProgressiveMesh() = default;
ProgressiveMesh::ProgressiveMesh(ProgressiveMesh&&) noexcept = default;

std::size_t ProgressiveMesh::contraction_count() const {
  return impl_->arrays->contractions.count();
}
std::size_t ProgressiveMesh::applied() const {
  return impl_->state.applied();
}

void ProgressiveMesh::set_applied(std::size_t count) {
  CREASE_ASSERT(count <= contraction_count());
  impl_->want(count);
}

void ProgressiveMesh::set_triangle_count(std::size_t count) {
  LinearState& state = impl_->state;
  const std::size_t before = state.applied();
  NoMarks none;
  while (triangle_count() > count && state.applied() < contraction_count()) state.apply(none);
  // Contractions that lose no triangle are undone as well.
  while (state.applied() > 0 && triangle_count() + state.triangles_won_previous() <= count) {
    state.undo(none);
  }
  const std::size_t wanted = state.applied();
  while (state.applied() < before) state.apply(none);
  while (state.applied() > before) state.undo(none);
  impl_->want(wanted);
}

void ProgressiveMesh::set_error(float surface_error) {
  set_applied(applied_for_error(surface_error));
}

std::size_t ProgressiveMesh::applied_for_error(float surface_error) const {
  return applied_for(impl_->arrays->contractions, surface_error,
                     [](const LevelError& e) { return e.surface; });
}

std::size_t ProgressiveMesh::applied_for_view(float error) const {
  return applied_for(impl_->arrays->contractions, error,
                     [](const LevelError& e) { return std::max(e.surface, e.line); });
}

void ProgressiveMesh::set_geomorph_seconds(double seconds) {
  impl_->seconds = seconds;
  if (seconds > 0 && impl_->own_normals.empty()) impl_->own_normals = impl_->state.own_normals;
}
void ProgressiveMesh::advance(double seconds) {
  impl_->advance(seconds);
}
bool ProgressiveMesh::is_moving() const {
  return impl_->is_moving();
}
PartId ProgressiveMesh::part_of(TriangleKind kind, std::size_t triangle) const {
  const ProgressiveArrays& arrays = *impl_->arrays;
  if (arrays.part_of_triangle.empty()) return PartId{0};
  return PartId{
      arrays.part_of_triangle[impl_->parts[static_cast<std::size_t>(kind)].first + triangle]};
}

std::size_t ProgressiveMesh::wanted_triangle_count() const {
  return impl_->is_coarsening() ? impl_->wanted_triangles : triangle_count();
}

std::size_t ProgressiveMesh::triangle_count() const {
  return impl_->state.active().triangles();
}
std::size_t ProgressiveMesh::vertex_count() const {
  return impl_->state.active().vertices();
}
std::size_t ProgressiveMesh::full_triangle_count() const {
  return impl_->arrays->full.triangles();
}
std::size_t ProgressiveMesh::base_triangle_count() const {
  return impl_->base_triangles;
}

LevelError ProgressiveMesh::error() const {
  const std::vector<ErrorStep>& errors = impl_->arrays->contractions.errors;
  const auto next = std::upper_bound(
      errors.begin(), errors.end(), applied(),
      [](std::size_t count, const ErrorStep& step) { return count < step.applied; });
  return next == errors.begin() ? LevelError{} : std::prev(next)->error;
}

DrawList ProgressiveMesh::draw_list() const {
  DrawList list;
  list.origin = impl_->arrays->grid.origin;
  list.positions = impl_->positions;
  list.vertex_normals = impl_->own_normals.empty() ? impl_->state.own_normals : impl_->own_normals;
  list.sn = impl_->draw_part(kSn);
  list.fn = impl_->draw_part(kFn);
  list.nsn = impl_->draw_part(kNsn);
  list.materials = impl_->arrays->materials;
  return list;
}

const DrawChanges& ProgressiveMesh::changes() const {
  return impl_->changes;
}
const ProgressiveArrays& ProgressiveMesh::arrays() const {
  return *impl_->arrays;
}
Mesh ProgressiveMesh::extract() const {
  return extract_level(*impl_->arrays, impl_->state);
}

}  // namespace crease
