#include "runtime/kept_end.h"

#include <bit>

namespace crease {

namespace {

using One = codec::PackedRecords<1>::Record;
using Three = codec::PackedRecords<3>::Record;

Three bits_of(const Vec3i& p) {
  return {std::bit_cast<std::uint32_t>(p.x), std::bit_cast<std::uint32_t>(p.y),
          std::bit_cast<std::uint32_t>(p.z)};
}

Vec3i place_of(const Three& bits) {
  return {std::bit_cast<std::int32_t>(bits[0]), std::bit_cast<std::int32_t>(bits[1]),
          std::bit_cast<std::int32_t>(bits[2])};
}

codec::PackedRecords<2> packed_names(const std::vector<codec::VertexName>& names) {
  return {names.size(), [&](std::size_t i) {
            return codec::PackedRecords<2>::Record{names[i].block, names[i].vertex};
          }};
}

constexpr bool kSigned = true;

}  // namespace

KeptEnd::KeptEnd(const codec::FineEnd& end)
    : positions_(
          end.mesh.positions.size(), [&](std::size_t i) { return bits_of(end.mesh.positions[i]); },
          kSigned),
      names_(packed_names(end.names)),
      triangles_(end.mesh.triangles.size(), [&](std::size_t i) { return end.mesh.triangles[i]; }),
      category_(end.mesh.category.size(), [&](std::size_t i) { return One{end.mesh.category[i]}; }),
      labels_(end.labels.size(), [&](std::size_t i) { return One{end.labels[i]}; }),
      derived_(end.mesh.derived.size(),
               [&](std::size_t i) { return One{end.mesh.derived[i] ? 1u : 0u}; }) {
  for (const std::vector<codec::CodedValue>& values : end.mesh.values) {
    layers_.emplace_back(
        values.size(),
        [&](std::size_t i) { return std::bit_cast<codec::PackedRecords<4>::Record>(values[i]); },
        kSigned);
  }
  layers_.shrink_to_fit();
}

Vec3i KeptEnd::position(std::size_t vertex) const {
  return place_of(positions_[vertex]);
}

codec::VertexName KeptEnd::name(std::size_t vertex) const {
  const auto [block, number] = names_[vertex];
  return {block, number};
}

codec::CodedValue KeptEnd::value(std::size_t layer, std::size_t corner) const {
  return std::bit_cast<codec::CodedValue>(layers_[layer][corner]);
}

codec::FineEnd KeptEnd::unpacked_but_values() const {
  codec::FineEnd end;
  end.mesh.positions.reserve(vertex_count());
  end.names.reserve(vertex_count());
  for (std::size_t v = 0; v < vertex_count(); ++v) {
    end.mesh.positions.push_back(position(v));
    end.names.push_back(name(v));
  }
  end.mesh.triangles.reserve(triangle_count());
  end.mesh.category.reserve(triangle_count());
  end.mesh.derived.reserve(triangle_count());
  end.labels.reserve(triangle_count());
  for (std::size_t t = 0; t < triangle_count(); ++t) {
    end.mesh.triangles.push_back(triangles_[t]);
    end.mesh.category.push_back(category(t));
    end.mesh.derived.push_back(static_cast<char>(derived_[t][0]));
    end.labels.push_back(label(t));
  }
  return end;
}

codec::FineEnd KeptEnd::unpacked() const {
  codec::FineEnd end = unpacked_but_values();
  for (std::size_t l = 0; l < layers_.size(); ++l) {
    std::vector<codec::CodedValue>& values = end.mesh.values.emplace_back();
    values.reserve(layers_[l].size());
    for (std::size_t c = 0; c < layers_[l].size(); ++c) values.push_back(value(l, c));
  }
  return end;
}

std::size_t KeptEnd::bytes() const {
  std::size_t bytes = positions_.bytes() + names_.bytes() + triangles_.bytes() + category_.bytes() +
                      labels_.bytes() + derived_.bytes() + layers_.capacity() * sizeof(layers_[0]);
  for (const codec::RepeatedRecords<4>& layer : layers_) bytes += layer.bytes();
  return bytes;
}

KeptNames::KeptNames(const std::vector<codec::VertexName>& names) : names_(packed_names(names)) {}

codec::VertexName KeptNames::operator[](std::size_t i) const {
  const auto [block, vertex] = names_[i];
  return {block, vertex};
}

KeptSplits::KeptSplits(const std::vector<codec::Split>& splits)
    : counts_(splits.size(),
              [&](std::size_t i) {
                return Three{splits[i].vertex, splits[i].first_triangle, splits[i].triangle_count};
              }),
      positions_(
          splits.size(), [&](std::size_t i) { return bits_of(splits[i].parent_position); },
          kSigned) {}

std::vector<codec::Split> KeptSplits::unpacked() const {
  std::vector<codec::Split> splits;
  splits.reserve(size());
  for (std::size_t i = 0; i < size(); ++i) {
    const auto [vertex, first, count] = counts_[i];
    splits.push_back({vertex, first, count, place_of(positions_[i])});
  }
  return splits;
}

}  // namespace crease
