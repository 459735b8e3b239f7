#include "io/glb_streams.h"

#include "base/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <set>
#include <utility>

namespace crease {

namespace {

// A name of letters, digits and underscores after one underscore (3.7.2.1: application-specific).
std::string custom_semantic(const std::string& name, const std::set<std::string>& taken) {
  std::string result = "_";
  for (const char c : name) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    result += plain ? c : '_';
  }
  if (result == "_") result = "_LAYER";
  const std::string base = result;
  for (int i = 1; taken.contains(result); ++i) result = base + "_" + std::to_string(i);
  return result;
}

bool are_whole(const AttributeLayer& layer, float low, float high) {
  return std::all_of(layer.values.begin(), layer.values.end(),
                     [&](float x) { return x >= low && x <= high && std::floor(x) == x; });
}

std::uint32_t component_type_of(const AttributeLayer& layer) {
  if (layer.interpolation != Interpolation::Categorical) return kGlbFloats;
  if (are_whole(layer, 0, 65535)) return kGlbUnsignedShorts;
  return are_whole(layer, -32768, 32767) ? kGlbShorts : kGlbFloats;
}

}  // namespace

bool has_large_categories(const AttributeLayer& layer) {
  return layer.interpolation == Interpolation::Categorical &&
         component_type_of(layer) == kGlbFloats;
}

std::vector<GlbSemantic> semantics_of(std::span<const AttributeLayer* const> layers) {
  std::vector<GlbSemantic> semantics;
  std::set<std::string> taken;
  int uv_count = 0, color_count = 0;
  for (const AttributeLayer* layer : layers) {
    GlbSemantic semantic{"", layer->dimension, layer->role};
    if (layer->role == AttributeRole::Normal) {
      semantic.name = "NORMAL";
    } else if (layer->role == AttributeRole::TexCoord && layer->dimension == 2) {
      semantic.name = "TEXCOORD_" + std::to_string(uv_count++);
    } else if (layer->role == AttributeRole::Color && layer->dimension >= 3) {
      semantic.name = "COLOR_" + std::to_string(color_count++);
    } else {
      semantic.name = custom_semantic(layer->name, taken);
      semantic.role = AttributeRole::Other;
      semantic.component_type = component_type_of(*layer);
    }
    taken.insert(semantic.name);
    semantics.push_back(std::move(semantic));
  }
  return semantics;
}

void GlbStream::add_as_is(std::span<const float> value) {
  const std::size_t at = bytes.size();
  bytes.resize(at + semantic.stride());
  if (semantic.component_type == kGlbFloats) {
    std::memcpy(&bytes[at], value.data(), value.size_bytes());
    return;
  }
  for (std::size_t k = 0; k < value.size(); ++k) {
    const auto id = static_cast<std::uint16_t>(static_cast<std::int32_t>(value[k]));
    std::memcpy(&bytes[at + k * sizeof id], &id, sizeof id);
  }
}

// Unit normals, v down, linear colours within 0..1.
void GlbStream::add(std::span<const float> value) {
  switch (semantic.role) {
    case AttributeRole::Normal: {
      Vec3d n = normalized(Vec3d{value[0], value[1], value[2]});
      if (!(length(n) > 0.5)) n = {0, 0, 1};
      return add_as_is(
          std::array{static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)});
    }
    case AttributeRole::TexCoord:
      return add_as_is(std::array{value[0], 1.0f - value[1]});
    case AttributeRole::Color: {
      std::array<float, 4> color{};
      for (std::size_t k = 0; k < value.size(); ++k) {
        const float within = std::clamp(value[k], 0.0f, 1.0f);
        color[k] = k < 3 ? linear_from_srgb(within) : within;
      }
      return add_as_is(std::span(color).first(value.size()));
    }
    case AttributeRole::Other:
      return add_as_is(value);
  }
}

}  // namespace crease
