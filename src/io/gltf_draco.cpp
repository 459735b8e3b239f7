#include "io/gltf_compression.h"

#include <draco/compression/decode.h>

#include <memory>
#include <new>

namespace crease {

namespace {

Result<std::unique_ptr<draco::Mesh>> decoded_mesh(const Source& source, const std::string& place,
                                                  std::span<const std::byte> encoded) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(encoded.data()), encoded.size());
  try {
    draco::Decoder decoder;
    auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
    if (mesh.ok()) return std::move(mesh).value();
    return fail_at_place(Error::BadFormat, source, place,
                         "Draco: " + mesh.status().error_msg_string());
  } catch (const std::bad_alloc&) {
    return fail_at_place(Error::OverLimit, source, place, "Draco: more than memory holds");
  }
}

GltfReader::Floats values_of(const draco::PointAttribute& attribute, std::uint32_t vertices) {
  GltfReader::Floats floats;
  floats.components = static_cast<std::size_t>(attribute.num_components());
  floats.values.resize(floats.components * vertices);
  for (std::uint32_t v = 0; v < vertices; ++v) {
    const draco::AttributeValueIndex i = attribute.mapped_index(draco::PointIndex(v));
    attribute.ConvertValue<float>(i, static_cast<std::int8_t>(floats.components),
                                  &floats.values[floats.components * v]);
  }
  return floats;
}

}  // namespace

Result<DracoPrimitive> decode_draco(const Source& source, const std::string& place,
                                    std::span<const std::byte> encoded,
                                    std::span<const std::uint32_t> ids, std::size_t most) {
  const Result<std::unique_ptr<draco::Mesh>> mesh = decoded_mesh(source, place, encoded);
  if (!mesh.ok()) return mesh.failure();
  // Whether integers are shares of one, the accessor says.
  for (int i = 0; i < (*mesh)->num_attributes(); ++i) (*mesh)->attribute(i)->set_normalized(false);
  const draco::Mesh& m = **mesh;
  if (m.num_points() > most || m.num_faces() > most) {
    return fail_at_place(Error::OverLimit, source, place, "Draco: beyond reason for such a file");
  }
  DracoPrimitive result;
  result.vertex_count = m.num_points();
  result.indices.reserve(3 * m.num_faces());
  for (std::uint32_t f = 0; f < m.num_faces(); ++f) {
    for (const draco::PointIndex& v : m.face(draco::FaceIndex(f))) {
      if (v.value() >= m.num_points()) {
        return fail_at_place(Error::BadValue, source, place, "Draco: index out of range");
      }
      result.indices.push_back(v.value());
    }
  }
  for (const std::uint32_t id : ids) {
    const draco::PointAttribute* const attribute = m.GetAttributeByUniqueId(id);
    if (attribute == nullptr || attribute->num_components() < 1 ||
        attribute->num_components() > 4) {
      return fail_at_place(Error::BadValue, source, place,
                           "Draco: no attribute " + std::to_string(id) + " of 1 to 4 components");
    }
    result.attributes.push_back(values_of(*attribute, m.num_points()));
  }
  return result;
}

}  // namespace crease
