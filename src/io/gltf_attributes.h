// Vertex attributes of many glTF primitives, put together into layers of one mesh.
//
//   GltfLayers layers;
//   layers.add(reader, primitive, place, vertex_count, instances);   // per primitive
//   layers.finish(raw);                                              // once
//
// Primitives need not agree: a layer that a primitive lacks has no value there (colours are white,
// 3.9.2), and a colour layer has alpha if any primitive's has.
#pragma once

#include "crease/result.h"
#include "io/gltf_document.h"
#include "io/gltf_images.h"
#include "io/gltf_skin.h"
#include "io/raw_mesh.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace crease {

class GltfLayers {
 public:
  explicit GltfLayers(const Source& source) : source_(source) {}

  // Reads every attribute of a primitive but POSITION and, where there are joints, those of its
  // skin, and appends its values once for each placement. The texture coordinates that `use` names
  // become set 0, transformed, and set 0 takes their place. Set 0 is the first in the end, whatever
  // was met first.
  Status add(GltfReader& reader, const Json& attributes, const std::string& place,
             std::size_t vertex_count, const std::vector<Placement>& placements,
             const TextureUse& use);

  // Moves the layers and notes into `raw`, whose triangles are complete.
  void finish(RawMesh& raw);

  // Floats held so far: what a hostile file would multiply.
  std::size_t value_count() const { return vertex_count_ * total_dimension_; }

 private:
  struct Layer {
    std::string semantic;  // "TEXCOORD_0"
    RawLayer raw;
    Rounded rounded;
    std::vector<std::pair<std::size_t, std::size_t>> missing;  // ranges of vertices without a value
  };

  Layer* layer_of(const std::string& semantic, std::size_t dimension, bool integers);
  void append(Layer& layer, const GltfReader::Floats& values,
              const std::vector<Placement>& placements);
  void append_missing(Layer& layer, std::size_t count);
  void put_first_set_first();

  const Source& source_;
  std::vector<Layer> layers_;
  std::size_t vertex_count_ = 0, total_dimension_ = 0;
  std::map<std::string, std::size_t> ignored_;  // semantic: primitives that have it
};

}  // namespace crease
