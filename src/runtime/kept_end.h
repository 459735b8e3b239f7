// The fine end of a block as it is kept for decoding finer ones, picking and by vertex: a quarter
// of what codec::FineEnd takes.
//
//   const KeptEnd end(decoded.end);
//   end.triangle(t)                       // one at a time
//   codec::FineEnd whole = end.unpacked();  // or all
//
// Memory of a vertex: 3 places of as many bits as the block is large, 2 to 3 bytes of name; of a
// triangle three vertices (5 bytes in a block of 8,000), a label and a category of some bits, and a
// layer's values, each once.
#pragma once

#include "codec/block_coder.h"
#include "codec/block_end.h"
#include "codec/packed_records.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crease {

class KeptEnd {
 public:
  KeptEnd() = default;
  explicit KeptEnd(const codec::FineEnd& end);

  std::size_t vertex_count() const { return positions_.size(); }
  std::size_t triangle_count() const { return triangles_.size(); }
  std::size_t layer_count() const { return layers_.size(); }

  Vec3i position(std::size_t vertex) const;
  codec::VertexName name(std::size_t vertex) const;
  codec::Corners triangle(std::size_t triangle) const { return triangles_[triangle]; }
  std::uint32_t label(std::size_t triangle) const { return labels_[triangle][0]; }
  std::uint32_t category(std::size_t triangle) const { return category_[triangle][0]; }
  bool is_derived(std::size_t triangle) const { return derived_[triangle][0] != 0; }
  codec::CodedValue value(std::size_t layer, std::size_t corner) const;

  codec::FineEnd unpacked() const;             // with its values
  codec::FineEnd unpacked_but_values() const;  // the mesh has no layers
  std::size_t bytes() const;                   // beside the object

 private:
  codec::PackedRecords<3> positions_;
  codec::PackedRecords<2> names_;
  codec::PackedRecords<3> triangles_;
  codec::RepeatedRecords<1> category_, labels_;
  codec::PackedRecords<1> derived_;
  std::vector<codec::RepeatedRecords<4>> layers_;  // per corner
};

// Names of vertices.
class KeptNames {
 public:
  KeptNames() = default;
  explicit KeptNames(const std::vector<codec::VertexName>& names);

  codec::VertexName operator[](std::size_t i) const;
  std::size_t size() const { return names_.size(); }
  std::size_t bytes() const { return names_.bytes(); }

 private:
  codec::PackedRecords<2> names_;
};

// The splits that lead to a fine end.
class KeptSplits {
 public:
  KeptSplits() = default;
  explicit KeptSplits(const std::vector<codec::Split>& splits);

  std::uint32_t vertex(std::size_t split) const { return counts_[split][0]; }
  std::vector<codec::Split> unpacked() const;
  std::size_t size() const { return counts_.size(); }
  std::size_t bytes() const { return counts_.bytes() + positions_.bytes(); }

 private:
  codec::PackedRecords<3> counts_, positions_;
};

}  // namespace crease
