#include "draco_mesh.h"

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace crease::bench {

namespace {

// Quantization by 1 over 2^bits - 1 steps leaves integers alone; no more bits than the mesh has.
struct Extent {
  std::array<float, 3> low{};
  int bits = 1;
};

Extent extent_of(const std::vector<Vec3i>& places) {
  Vec3i low = places.front(), high = low;
  for (const Vec3i& p : places) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  Extent extent;
  std::int32_t longest = 1;
  for (int k = 0; k < 3; ++k) {
    extent.low[std::size_t(k)] = float(low[k]);
    longest = std::max(longest, high[k] - low[k]);
  }
  while ((std::int32_t(1) << extent.bits) - 1 < longest) ++extent.bits;
  return extent;
}

// Ascending numbers for equal keys.
template <typename Key>
class Numbers {
 public:
  std::uint32_t of(const Key& key) {
    return numbers_.try_emplace(key, std::uint32_t(numbers_.size())).first->second;
  }
  std::size_t size() const { return numbers_.size(); }

 private:
  std::map<Key, std::uint32_t> numbers_;
};

int add_attribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, std::size_t values) {
  draco::GeometryAttribute attribute;
  attribute.Init(type, nullptr, 3, draco::DT_FLOAT32, false, 3 * sizeof(float), 0);
  return mesh.AddAttribute(attribute, false, std::uint32_t(values));
}

}  // namespace

struct DracoMesh::Data {
  draco::Mesh mesh;
  Extent extent;
  bool has_normals = false;
};

DracoMesh::DracoMesh(const Mesh& snapped, const Grid& grid, bool with_normals, bool join_positions)
    : data_(std::make_unique<Data>()) {
  std::vector<Vec3i> places;
  std::vector<std::uint32_t> place_of_vertex;
  Numbers<std::array<std::int32_t, 3>> distinct;
  for (const Vec3d& position : snapped.positions) {
    const Vec3i p = grid.nearest(position);
    const std::uint32_t place =
        join_positions ? distinct.of({p.x, p.y, p.z}) : std::uint32_t(places.size());
    if (place == places.size()) places.push_back(p);
    place_of_vertex.push_back(place);
  }
  data_->extent = extent_of(places);
  data_->has_normals = with_normals;
  const AttributeLayer* normals = with_normals ? snapped.normals() : nullptr;

  // A point is a place with one normal. Equal normals are one, as after Draco's own importers.
  Numbers<std::array<float, 3>> directions;
  Numbers<std::pair<std::uint32_t, std::uint32_t>> points;
  std::vector<std::array<float, 3>> values;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> of_point;
  draco::Mesh& mesh = data_->mesh;
  for (std::size_t t = 0; t < snapped.triangle_count(); ++t) {
    draco::Mesh::Face face;
    for (std::size_t c = 0; c < 3; ++c) {
      std::uint32_t direction = 0;
      if (normals != nullptr) {
        const std::span<const float> n = normals->value(normals->of_corner[3 * t + c]);
        const std::array<float, 3> value{n[0] + 0.0f, n[1] + 0.0f, n[2] + 0.0f};  // no -0
        direction = directions.of(value);
        if (direction == values.size()) values.push_back(value);
      }
      const std::uint32_t place = place_of_vertex[index_of(snapped.triangles[t][c])];
      const std::uint32_t point = points.of({place, direction});
      if (point == of_point.size()) of_point.push_back({place, direction});
      face[c] = draco::PointIndex(point);
    }
    mesh.AddFace(face);
  }
  mesh.set_num_points(std::uint32_t(of_point.size()));

  const int position_id = add_attribute(mesh, draco::GeometryAttribute::POSITION, places.size());
  draco::PointAttribute& position = *mesh.attribute(position_id);
  position.SetExplicitMapping(of_point.size());
  for (std::uint32_t i = 0; i < places.size(); ++i) {
    const float p[3] = {float(places[i].x), float(places[i].y), float(places[i].z)};
    position.SetAttributeValue(draco::AttributeValueIndex(i), p);
  }
  for (std::uint32_t i = 0; i < of_point.size(); ++i) {
    position.SetPointMapEntry(draco::PointIndex(i), draco::AttributeValueIndex(of_point[i].first));
  }
  if (normals == nullptr) return;
  const int normal_id = add_attribute(mesh, draco::GeometryAttribute::NORMAL, values.size());
  draco::PointAttribute& normal = *mesh.attribute(normal_id);
  normal.SetExplicitMapping(of_point.size());
  for (std::uint32_t i = 0; i < values.size(); ++i) {
    normal.SetAttributeValue(draco::AttributeValueIndex(i), values[i].data());
  }
  for (std::uint32_t i = 0; i < of_point.size(); ++i) {
    normal.SetPointMapEntry(draco::PointIndex(i), draco::AttributeValueIndex(of_point[i].second));
  }
}

DracoMesh::~DracoMesh() = default;

std::vector<char> DracoMesh::encode(int normal_bits) const {
  draco::Encoder encoder;
  encoder.SetSpeedOptions(0, 0);
  encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
  encoder.SetAttributeExplicitQuantization(draco::GeometryAttribute::POSITION, data_->extent.bits,
                                           3, data_->extent.low.data(),
                                           float((std::int32_t(1) << data_->extent.bits) - 1));
  if (data_->has_normals) {
    encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, normal_bits);
  }
  draco::EncoderBuffer buffer;
  if (!encoder.EncodeMeshToBuffer(data_->mesh, &buffer).ok()) return {};
  return {buffer.data(), buffer.data() + buffer.size()};
}

namespace {

std::unique_ptr<draco::Mesh> decoded(std::span<const char> bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  draco::Decoder decoder;
  auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
  return mesh.ok() ? std::move(mesh).value() : nullptr;
}

}  // namespace

std::size_t decode_draco(std::span<const char> bytes) {
  const std::unique_ptr<draco::Mesh> mesh = decoded(bytes);
  return mesh == nullptr ? 0 : mesh->num_faces();
}

Mesh draco_result(std::span<const char> bytes, const Grid& grid) {
  Mesh result;
  const std::unique_ptr<draco::Mesh> mesh = decoded(bytes);
  if (mesh == nullptr) return result;
  const draco::PointAttribute* position =
      mesh->GetNamedAttribute(draco::GeometryAttribute::POSITION);
  const draco::PointAttribute* normal = mesh->GetNamedAttribute(draco::GeometryAttribute::NORMAL);
  if (position == nullptr || normal == nullptr) return result;
  std::array<float, 3> value{};
  for (std::uint32_t i = 0; i < position->size(); ++i) {
    position->GetValue(draco::AttributeValueIndex(i), value.data());
    result.positions.push_back(
        grid.position({std::int32_t(std::lround(value[0])), std::int32_t(std::lround(value[1])),
                       std::int32_t(std::lround(value[2]))}));
  }
  AttributeLayer layer{.name = "normal",
                       .role = AttributeRole::Normal,
                       .interpolation = Interpolation::Direction,
                       .dimension = 3,
                       .values = {},
                       .of_corner = {}};
  for (std::uint32_t i = 0; i < normal->size(); ++i) {
    normal->GetValue(draco::AttributeValueIndex(i), value.data());
    layer.values.insert(layer.values.end(), value.begin(), value.end());
  }
  for (std::uint32_t f = 0; f < mesh->num_faces(); ++f) {
    Triangle triangle;
    for (std::size_t c = 0; c < 3; ++c) {
      const draco::PointIndex point = mesh->face(draco::FaceIndex(f))[c];
      triangle[c] = VertexId(position->mapped_index(point).value());
      layer.of_corner.push_back(AttributeId(normal->mapped_index(point).value()));
    }
    result.triangles.push_back(triangle);
  }
  result.layers.push_back(std::move(layer));
  return result;
}

}  // namespace crease::bench
