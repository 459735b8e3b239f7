#include "hierarchy/linear_state.h"

#include <algorithm>

namespace crease {

LinearState::LinearState(const ProgressiveArrays& arrays)
    : positions(arrays.positions),
      indices(arrays.indices),
      own_normals(arrays.normals.begin(), arrays.normals.begin() + arrays.full.sn_vertices),
      nsn_normals(arrays.nsn_normals),
      arrays_(&arrays),
      own_words_(own_value_words(arrays)),
      active_(arrays.full) {
  if (!arrays.contractions.blocks.empty()) {
    is_derived_.assign(std::size_t(arrays.full.fn_triangles) + arrays.full.nsn_triangles, 0);
  }
  for (const ProgressiveLayer& source : arrays.layers) {
    Layer layer;
    layer.indices = source.indices;
    if (source.storage == ProgressiveLayer::Storage::Vertex) {
      const std::size_t own_floats = arrays.full.vertices() * source.dimension;
      layer.own.assign(source.values.begin(),
                       source.values.begin() + static_cast<std::ptrdiff_t>(own_floats));
    }
    layers.push_back(std::move(layer));
  }
}

std::uint32_t LinearState::index_of_corner(std::size_t layer, std::uint32_t c) const {
  const ProgressiveLayer& source = arrays_->layers[layer];
  switch (source.storage) {
    case ProgressiveLayer::Storage::Corner:
      return layers[layer].indices[c];
    case ProgressiveLayer::Storage::Face:
      return layers[layer].indices[c / 3];
    case ProgressiveLayer::Storage::Vertex:
      break;
  }
  if (source.row_of_triangle.empty()) return kNone;
  const std::uint32_t row = source.row_of_triangle[c / 3];
  return row == kNone ? kNone : layers[layer].indices[3 * row + c % 3];
}

std::span<const float> LinearState::value_of_corner(std::size_t layer, std::uint32_t c) const {
  const std::size_t d = arrays_->layers[layer].dimension;
  const std::uint32_t index = index_of_corner(layer, c);
  if (index == kNone) {
    return std::span<const float>(layers[layer].own).subspan(indices[c] * d, d);
  }
  return std::span<const float>(arrays_->layers[layer].values).subspan(index * d, d);
}

std::uint32_t LinearState::normal_index(std::uint32_t c) const {
  const std::uint32_t t = c / 3;
  const std::uint32_t first_nsn = arrays_->full.sn_triangles + arrays_->full.fn_triangles;
  if (t < arrays_->full.sn_triangles) return kNone;
  if (t < first_nsn) return arrays_->fn_normals[t - arrays_->full.sn_triangles];
  return nsn_normals[c - 3 * first_nsn];
}

Vec3f LinearState::stored_normal(std::uint32_t c) const {
  const std::uint32_t index = normal_index(c);
  return index == kNone ? own_normals[indices[c]] : arrays_->normals[index];
}

}  // namespace crease
