// Where the properties of a PLY element go, and the attribute layers that they fill row by row.
#pragma once

#include "io/ply_header.h"
#include "io/raw_mesh.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace crease {

// What a property is for. Layer: component `component` of layers[layer], less `zero`, times
// `scale`.
struct PlyTarget {
  enum class Kind { Position, Layer, Indices, CornerTexCoords, Ignored };
  Kind kind = Kind::Ignored;
  std::size_t layer = 0, component = 0;
  double scale = 1, zero = 0;
  bool is_float = false;  // says the file: decimals beyond one are none that it means
};

// The layers of one element, vertex or face, and where each property goes.
struct PlyLayers {
  std::vector<RawLayer> layers;
  std::vector<bool> is_told;       // of each, what it is: by a comment
  std::vector<Rounded> rounded;    // of each; what colours and normals lose is not told
  std::vector<PlyTarget> targets;  // one a property
  std::vector<float> row;          // values of all layers, one layer after another
  std::vector<std::size_t> begin;  // of each layer in `row`

  void add(RawLayer layer, bool told = false) {
    is_told.push_back(told);
    begin.push_back(row.size());
    row.resize(row.size() + layer.dimension, 0.0f);
    layers.push_back(std::move(layer));
    rounded.emplace_back();
  }
  void set(const PlyTarget& target, double x) {
    const double value = (x - target.zero) * target.scale;
    row[begin[target.layer] + target.component] =
        target.is_float ? static_cast<float>(value) : rounded[target.layer].to_float(value);
  }
  void keep_row() {
    for (std::size_t l = 0; l < layers.size(); ++l) {
      const auto from = row.begin() + static_cast<std::ptrdiff_t>(begin[l]);
      layers[l].values.insert(layers[l].values.end(), from, from + layers[l].dimension);
    }
  }
};

// The first property of this name that is no list.
std::optional<std::size_t> find_scalar(const PlyElement& element, std::string_view name);

// The corners of a face, or a strip.
bool is_index_list(const PlyProperty& property);

// By the names of its properties; `notes` says which lists have no place. Integers of faces are
// categories, and whatever of vertices has a name that says so, until settle_categories().
// Comments of ours go before names.
PlyLayers plan_layers(const PlyElement& element, RawLayer::Per per,
                      std::span<const std::string> comments, std::vector<std::string>& notes);

// Colours in floats are 0..1; some programs write 0..255.
void scale_float_colors(RawLayer& layer, std::vector<std::string>& notes);

// Of a layer of the vertices that is complete: numbers that are not whole, in floats or not, and of
// which nearly every vertex has its own, an id of each, are no categories. Notes those that are.
void settle_categories(RawLayer& layer, std::vector<std::string>& notes);

}  // namespace crease
