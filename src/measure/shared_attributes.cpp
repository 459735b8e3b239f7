#include "measure/shared_attributes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <unordered_map>

namespace crease {

namespace {

constexpr std::size_t kMostNumbers = 4;  // of a value
using Value = std::array<double, kMostNumbers>;

std::span<const float> value_at(const AttributeLayer& layer, std::size_t triangle, std::size_t c) {
  return layer.value(layer.of_corner[3 * triangle + c]);
}

Value blended(const AttributeLayer& layer, std::size_t triangle,
              const std::array<double, 3>& weights) {
  Value sum{};
  for (std::size_t c = 0; c < 3; ++c) {
    const std::span<const float> value = value_at(layer, triangle, c);
    for (std::size_t k = 0; k < value.size(); ++k) sum[k] += weights[c] * double(value[k]);
  }
  return sum;
}

// A category is that of the nearest corner.
std::span<const float> category_at(const AttributeLayer& layer, std::size_t triangle,
                                   const std::array<double, 3>& weights) {
  const auto nearest = std::max_element(weights.begin(), weights.end());
  return value_at(layer, triangle, static_cast<std::size_t>(nearest - weights.begin()));
}

// Formats name what has a role as they like.
bool are_the_same(const AttributeLayer& a, const AttributeLayer& b) {
  if (a.role != b.role || a.interpolation != b.interpolation) return false;
  if (a.role == AttributeRole::Color) return true;  // one may lack alpha
  return a.dimension == b.dimension && (a.role == AttributeRole::TexCoord || a.name == b.name);
}

DeviationUnit unit_of(const AttributeLayer& layer) {
  switch (layer.interpolation) {
    case Interpolation::Direction:
      return DeviationUnit::Degrees;
    case Interpolation::Linear:
      return DeviationUnit::Values;
    case Interpolation::Categorical:
      break;
  }
  return DeviationUnit::Share;
}

bool have_name(const std::vector<Material>& materials, const std::string& name) {
  return std::ranges::find(materials, name, &Material::name) != materials.end();
}

// To what a format with colours in bytes or a few digits keeps of them.
bool look_alike(const Material& a, const Material& b) {
  constexpr float kShades = 0.004f;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!(std::abs(a.base_color[i] - b.base_color[i]) <= kShades)) return false;
  }
  return a.base_color_texture.empty() == b.base_color_texture.empty();
}

// What a material is told by: its name. One that has none has got one in a format that asks for it,
// so it is told by that of one of `others` that looks alike and has no other counterpart, and by
// its look where there is none.
std::vector<std::string> names_of(const std::vector<Material>& materials,
                                  const std::vector<Material>& others) {
  std::vector<std::string> names;
  std::vector<bool> is_taken(others.size());  // or has a name that one of `materials` has
  for (std::size_t k = 0; k < others.size(); ++k) {
    is_taken[k] = others[k].name.empty() || have_name(materials, others[k].name);
  }
  for (const Material& material : materials) {
    if (!material.name.empty()) {
      names.push_back(material.name);
      continue;
    }
    std::size_t k = 0;
    while (k < others.size() && (is_taken[k] || !look_alike(material, others[k]))) ++k;
    if (k < others.size()) {
      is_taken[k] = true;
      names.push_back(others[k].name);
      continue;
    }
    char color[80];
    const std::array<float, 4>& c = material.base_color;
    std::snprintf(color, sizeof color, "\n%.3f %.3f %.3f %.3f ", double(c[0]), double(c[1]),
                  double(c[2]), double(c[3]));
    names.push_back(color + material.base_color_texture);
  }
  return names;
}

// Equal names, equal numbers.
class Labels {
 public:
  template <typename Id>
  std::vector<std::uint32_t> of_triangles(const std::vector<Id>& id_of_triangle,
                                          const std::vector<std::string>& names) {
    std::vector<std::uint32_t> label_of_id, label_of_triangle;
    for (const std::string& name : names) {
      const auto next = static_cast<std::uint32_t>(label_of_name_.size());
      label_of_id.push_back(label_of_name_.try_emplace(name, next).first->second);
    }
    for (const Id id : id_of_triangle) label_of_triangle.push_back(label_of_id[index_of(id)]);
    return label_of_triangle;
  }

 private:
  std::unordered_map<std::string, std::uint32_t> label_of_name_;
};

}  // namespace

SharedAttributes::SharedAttributes(const Mesh& a, const Mesh& b) {
  share_layers(a, b);
  if (!a.material_of_triangle.empty() && !b.material_of_triangle.empty()) {
    Labels labels;
    shared_.push_back(
        {.name = "material",
         .unit = DeviationUnit::Share,
         .label_of_triangle = {
             labels.of_triangles(a.material_of_triangle, names_of(a.materials, b.materials)),
             labels.of_triangles(b.material_of_triangle, names_of(b.materials, a.materials))}});
  }
  if (!a.parts.empty() && !b.parts.empty()) {
    Labels labels;
    shared_.push_back({.name = "part",
                       .unit = DeviationUnit::Share,
                       .label_of_triangle = {labels.of_triangles(a.part_of_triangle, a.parts),
                                             labels.of_triangles(b.part_of_triangle, b.parts)}});
  }
}

void SharedAttributes::share_layers(const Mesh& a, const Mesh& b) {
  std::vector<bool> is_taken(b.layers.size());
  for (const AttributeLayer& layer : a.layers) {
    if (layer.role == AttributeRole::Normal) continue;
    for (std::size_t k = 0; k < b.layers.size(); ++k) {
      if (is_taken[k] || !are_the_same(layer, b.layers[k])) continue;
      is_taken[k] = true;
      shared_.push_back(
          {.name = layer.name, .unit = unit_of(layer), .layers = {&layer, &b.layers[k]}});
      break;
    }
  }
}

double SharedAttributes::deviation(const Shared& shared, std::size_t from, std::size_t triangle,
                                   const Weights& weights, std::size_t other,
                                   const Weights& other_weights) {
  const std::size_t to = 1 - from;
  if (shared.layers[0] == nullptr) {
    const auto& labels = shared.label_of_triangle;
    return labels[from][triangle] == labels[to][other] ? 0 : 1;
  }
  const AttributeLayer &a = *shared.layers[from], &b = *shared.layers[to];
  if (shared.unit == DeviationUnit::Share) {
    return std::ranges::equal(category_at(a, triangle, weights),
                              category_at(b, other, other_weights))
               ? 0
               : 1;
  }
  const Value x = blended(a, triangle, weights), y = blended(b, other, other_weights);
  if (shared.unit == DeviationUnit::Degrees) {
    return degrees(angle_between({x[0], x[1], x[2]}, {y[0], y[1], y[2]}));
  }
  double squares = 0;
  for (std::size_t k = 0; k < std::min(a.dimension, b.dimension); ++k) {
    squares += (x[k] - y[k]) * (x[k] - y[k]);
  }
  return std::sqrt(squares);
}

double SharedAttributes::deviation(std::size_t attribute, const SurfacePoint& sample,
                                   std::span<const Surface::Scratch::Candidate> candidates,
                                   std::size_t from) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Surface::Scratch::Candidate& candidate : candidates) {
    least = std::min(least, deviation(shared_[attribute], from, sample.triangle, sample.weights,
                                      candidate.triangle, candidate.weights));
  }
  return least;
}

}  // namespace crease
