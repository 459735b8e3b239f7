// Binary STL: floats and nothing else, so that a model far from the origin is written less a round
// one, which the header says.
#include "io/byte_sink.h"
#include "io/float_positions.h"
#include "io/formats.h"
#include "io/left_out.h"

#include "mesh/normals.h"

namespace crease {

namespace {

constexpr std::size_t kHeaderBytes = 80;

std::vector<std::byte> header(const Vec3d& origin) {
  ByteSink out;
  out.text(kStlHeader);
  if (origin != Vec3d{}) {
    out.text(kStlLess);
    for (int i = 0; i < 3; ++i) {
      out.text(" ");
      out.number(origin[i]);
    }
  }
  std::vector<std::byte> bytes = out.take();
  bytes.resize(kHeaderBytes, std::byte{' '});
  return bytes;
}

}  // namespace

std::vector<std::byte> write_stl(const Mesh& mesh) {
  const Vec3d origin = round_origin(mesh);
  ByteSink out;
  out.reserve(kHeaderBytes + 4 + 50 * mesh.triangle_count());
  out.bytes(header(origin));
  out.u32(static_cast<std::uint32_t>(mesh.triangle_count()));
  const AttributeLayer* attribute = stl_attribute(mesh);
  const std::vector<Vec3d> normals = face_normals(mesh, {});
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto point = [&](const Vec3d& p) {
      for (int i = 0; i < 3; ++i) out.f32(static_cast<float>(p[i]));
    };
    point(normals[t]);
    for (VertexId v : mesh.triangles[t]) point(mesh.positions[index_of(v)] - origin);
    const float value = attribute ? attribute->value(attribute->of_corner[3 * t])[0] : 0;
    out.u16(static_cast<std::uint16_t>(value));
  }
  return out.take();
}

}  // namespace crease
