#include "io/byte_sink.h"
#include "io/formats.h"

#include "mesh/normals.h"

namespace crease {

std::vector<std::byte> write_stl(const Mesh& mesh) {
  ByteSink out;
  out.reserve(84 + 50 * mesh.triangle_count());
  std::string header = "binary STL, written by crease";
  header.resize(80, ' ');
  out.text(header);
  out.u32(static_cast<std::uint32_t>(mesh.triangle_count()));
  const std::vector<Vec3d> normals = face_normals(mesh, {});
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto point = [&](const Vec3d& p) {
      for (int i = 0; i < 3; ++i) out.f32(static_cast<float>(p[i]));
    };
    point(normals[t]);
    for (VertexId v : mesh.triangles[t]) point(mesh.positions[index_of(v)]);
    out.u16(0);
  }
  return out.take();
}

}  // namespace crease
