// The values of an attribute layer as the integers that blocks hold, both ways.
//
//   const LayerValues values(coding, layer.dimension);
//   values.read(values.code(layer.value(id)), floats);     // the same floats, bit for bit
#pragma once

#include "codec/layer_coding.h"
#include "codec/patch_mesh.h"
#include "crease/block_file.h"

#include <cstdint>
#include <optional>
#include <span>

namespace crease {

class LayerValues {
 public:
  // `coding` must outlive it.
  LayerValues(const LayerCoding& coding, std::uint32_t dimension);

  // Of a value that is snapped to the coding; of any other, the nearest.
  codec::CodedValue code(std::span<const float> value) const;
  // The same; less work where the value is hardly one of the coding's.
  codec::CodedValue nearest_code(std::span<const float> value) const;
  // Any code gives a value of the coding: what is out of range becomes what is nearest in it, or
  // for directions zero. Floats are what the bits say, finite or not.
  void read(const codec::CodedValue& code, std::span<float> value) const;

  // What a block needs to know of the layer.
  codec::BlockLayer in_block(bool is_normal) const;

 private:
  const LayerCoding& coding_;
  std::uint32_t dimension_;
  std::optional<OctahedralCoding> octahedral_;
  std::optional<SextantCoding> sextant_;
};

// The schema as blocks need it. `codings`: one a layer. The counts may be 0.
codec::BlockCoding block_coding(std::span<const LayerSchema> layers,
                                std::span<const LayerCoding> codings, std::size_t material_count,
                                std::size_t part_count);

}  // namespace crease
