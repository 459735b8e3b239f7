#include "io/gltf_attributes.h"

#include "base/srgb.h"
#include "io/layer_fill.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace crease {
namespace {

constexpr std::size_t kMaxLayers = 32;

// "TEXCOORD_1": the name that follows "uv", empty for set 0; nothing if it is another semantic.
bool is_set_of(const std::string& semantic, std::string_view kind, std::string& suffix) {
  if (!semantic.starts_with(kind)) return false;
  suffix = semantic.substr(kind.size());
  if (suffix == "0") suffix.clear();
  return true;
}

// Feature ids are numbers that stand for things; blending two of them means nothing.
bool is_id(const std::string& semantic) {
  return semantic == "_BATCHID" || semantic.starts_with("_FEATURE_ID");
}

bool is_of_skin(const std::string& semantic) {
  return semantic.starts_with("JOINTS_") || semantic.starts_with("WEIGHTS_");
}

RawLayer make_layer(const std::string& semantic, std::size_t dimension, bool integers) {
  std::string suffix;
  if (semantic == "NORMAL") return normal_layer(RawLayer::Per::Vertex);
  if (is_set_of(semantic, "TEXCOORD_", suffix)) {
    return texcoord_layer("uv" + suffix, RawLayer::Per::Vertex);
  }
  const auto components = static_cast<std::uint32_t>(dimension);
  if (is_set_of(semantic, "COLOR_", suffix)) {
    RawLayer layer = color_layer(RawLayer::Per::Vertex, components);
    layer.name += suffix;
    return layer;
  }
  RawLayer layer;
  layer.name = semantic.substr(1);
  layer.dimension = components;
  if (integers || is_id(semantic)) layer.interpolation = Interpolation::Categorical;
  return layer;
}

// The set that a texture is painted by is set 0, if the primitive has it.
std::string swapped(const std::string& semantic, const Json& attributes, const TextureUse& use) {
  const std::string painted = "TEXCOORD_" + std::to_string(use.set);
  if (at(attributes, painted.c_str()).is_null()) return semantic;
  if (semantic == painted) return "TEXCOORD_0";
  return semantic == "TEXCOORD_0" ? painted : semantic;
}

void transform(GltfReader::Floats& uv, const TextureUse& use) {
  if (use.matrix == TextureUse{}.matrix && use.offset == TextureUse{}.offset) return;
  for (std::size_t i = 0; i + 1 < uv.values.size(); i += 2) {
    const float u = uv.values[i], v = uv.values[i + 1];
    uv.values[i] = use.matrix[0] * u + use.matrix[1] * v + use.offset[0];
    uv.values[i + 1] = use.matrix[2] * u + use.matrix[3] * v + use.offset[1];
  }
}

}  // namespace

GltfLayers::Layer* GltfLayers::layer_of(const std::string& semantic, std::size_t dimension,
                                        bool integers) {
  const auto found = std::ranges::find(layers_, semantic, &Layer::semantic);
  if (found != layers_.end()) {
    if (found->raw.dimension < dimension) {
      total_dimension_ += dimension - found->raw.dimension;
      widen(found->raw, static_cast<std::uint32_t>(dimension));
    }
    return &*found;
  }
  if (layers_.size() >= kMaxLayers) return nullptr;
  total_dimension_ += dimension;
  Layer& layer = layers_.emplace_back();
  layer.semantic = semantic;
  layer.raw = make_layer(semantic, dimension, integers);
  if (vertex_count_ > 0) append_missing(layer, vertex_count_);
  return &layer;
}

void GltfLayers::append_missing(Layer& layer, std::size_t count) {
  const std::size_t begin = layer.raw.value_count();
  layer.raw.values.resize((begin + count) * layer.raw.dimension, fill_of(layer.raw.role));
  if (layer.raw.role != AttributeRole::Color) layer.missing.emplace_back(begin, begin + count);
}

void GltfLayers::append(Layer& layer, const GltfReader::Floats& floats,
                        const std::vector<Placement>& placements) {
  std::vector<float>& out = layer.raw.values;
  const std::size_t count = floats.count(), dimension = layer.raw.dimension;
  layer.rounded.add(floats.rounded);
  for (const Placement& placement : placements) {
    const std::size_t begin = out.size();
    out.resize(begin + count * dimension, fill_of(layer.raw.role));
    for (std::size_t i = 0; i < count; ++i) {
      std::copy_n(&floats.values[i * floats.components], floats.components,
                  &out[begin + i * dimension]);
    }
    if (layer.raw.role == AttributeRole::Color) {  // linear in glTF, but for the alpha
      for (std::size_t i = begin; i < out.size(); ++i) {
        if ((i - begin) % dimension < 3) out[i] = srgb_from_linear(out[i]);
      }
    }
    if (layer.raw.role == AttributeRole::TexCoord) {
      for (std::size_t i = begin + 1; i < out.size(); i += 2) out[i] = 1.0f - out[i];  // v up
    }
    if (layer.raw.role != AttributeRole::Normal) continue;
    Transform of_normals;
    bool keeps_direction = false;
    for (std::size_t v = 0; v < count; ++v) {
      if (v == 0 || placement.has_joints()) {
        const Transform transform = placement.of(v);
        of_normals = transform.of_normals();
        keeps_direction = transform.only_scales();
      }
      if (keeps_direction) continue;  // and its bits
      float* n = &out[begin + 3 * v];
      const Vec3d turned = normalized(of_normals.direction({n[0], n[1], n[2]}));
      for (std::size_t k = 0; k < 3; ++k) n[k] = float(turned[static_cast<int>(k)]);
    }
  }
}

Status GltfLayers::add(GltfReader& reader, const Json& attributes, const std::string& place,
                       std::size_t vertex_count, const std::vector<Placement>& placements,
                       const TextureUse& use) {
  const std::size_t total = vertex_count * placements.size();
  std::vector<bool> present(layers_.size(), false);
  const bool has_joints =
      std::any_of(placements.begin(), placements.end(), std::mem_fn(&Placement::has_joints));
  for (const auto& [semantic, accessor] : attributes.items()) {
    if (semantic == "POSITION" || (has_joints && is_of_skin(semantic))) continue;
    std::string suffix;
    std::size_t low = 1, high = 4;
    if (semantic == "NORMAL")
      low = high = 3;
    else if (is_set_of(semantic, "TEXCOORD_", suffix))
      low = high = 2;
    else if (is_set_of(semantic, "COLOR_", suffix))
      low = 3;
    else if (!semantic.starts_with('_') || reader.components_of(accessor) == 0) {
      ++ignored_[semantic];
      continue;
    }
    const std::string here = place + "." + semantic;
    Result<GltfReader::Floats> floats = reader.floats(accessor, low, high, here);
    if (!floats.ok()) return floats.failure();
    if (floats->count() != vertex_count) {
      return fail_at_place(Error::BadValue, source_, here,
                           std::to_string(floats->count()) + " values for " +
                               std::to_string(vertex_count) + " vertices");
    }
    const std::string becomes = swapped(semantic, attributes, use);
    if (becomes == "TEXCOORD_0") transform(*floats, use);
    Layer* layer = layer_of(becomes, floats->components, floats->integers);
    if (layer == nullptr) {
      ++ignored_[semantic];
      continue;
    }
    append(*layer, *floats, placements);
    present.resize(layers_.size(), false);
    present[static_cast<std::size_t>(layer - layers_.data())] = true;
  }
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    if (!present[i]) append_missing(layers_[i], total);
  }
  vertex_count_ += total;
  return Done{};
}

// Textures are painted by the first layer of texture coordinates.
void GltfLayers::put_first_set_first() {
  const auto first = std::ranges::find(layers_, AttributeRole::TexCoord,
                                       [](const Layer& layer) { return layer.raw.role; });
  const auto set_0 = std::ranges::find(layers_, "TEXCOORD_0", &Layer::semantic);
  if (set_0 != layers_.end()) std::rotate(first, set_0, set_0 + 1);
}

void GltfLayers::finish(RawMesh& raw) {
  put_first_set_first();
  for (Layer& layer : layers_) {
    if (!layer.missing.empty()) {
      std::vector<bool> has_value(vertex_count_, true);
      for (const auto& [begin, end] : layer.missing) {
        std::fill(has_value.begin() + static_cast<std::ptrdiff_t>(begin),
                  has_value.begin() + static_cast<std::ptrdiff_t>(end), false);
      }
      layer.raw.per = RawLayer::Per::Corner;
      layer.raw.of_corner.reserve(3 * raw.triangles.size());
      for (const auto& triangle : raw.triangles) {
        for (std::uint32_t v : triangle) layer.raw.of_corner.push_back(has_value[v] ? v : kNone);
      }
    }
    layer.rounded.tell(layer.raw.name, raw.report.notes);
    raw.layers.push_back(std::move(layer.raw));
  }
  for (const auto& [semantic, count] : ignored_) {
    raw.report.notes.push_back(semantic + " ignored in " + std::to_string(count) + " primitives");
  }
}

}  // namespace crease
