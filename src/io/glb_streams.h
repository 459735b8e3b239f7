// What a layer becomes in a GLB: an attribute's name and type, and its values.
//
//   std::vector<GlbSemantic> semantics = semantics_of(layers);
//   GlbStream stream{semantics[0], {}};
//   stream.add(layers[0]->value(i));
#pragma once

#include "crease/mesh.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace crease {

// Component types.
inline constexpr std::uint32_t kGlbFloats = 5126, kGlbShorts = 5122, kGlbUnsignedShorts = 5123;

struct GlbSemantic {
  std::string name;  // "TEXCOORD_0"
  std::uint32_t dimension = 1;
  AttributeRole role = AttributeRole::Other;
  // Categories are integers: what reads them knows that they do not blend.
  std::uint32_t component_type = kGlbFloats;

  // Bytes of a value; a multiple of four (3.6.2.4).
  std::size_t stride() const {
    return component_type == kGlbFloats ? dimension * sizeof(float) : (dimension + 1) / 2 * 4;
  }
  bool operator==(const GlbSemantic&) const = default;
};

// In the layers' order.
std::vector<GlbSemantic> semantics_of(std::span<const AttributeLayer* const> layers);

// Categories that are no integers of 16 bits, the longest that attributes have: they become floats.
bool has_large_categories(const AttributeLayer& layer);

// Values of one semantic, of all primitives one after the other: one bufferView.
struct GlbStream {
  GlbSemantic semantic;
  std::vector<std::byte> bytes;

  void add(std::span<const float> value);  // a layer's: as glTF wants it (3.7.2.1)
  void add_as_is(std::span<const float> value);
};

}  // namespace crease
