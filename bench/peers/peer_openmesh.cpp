// OpenMesh's decimater with ModQuadric. OpenMesh takes manifolds only: a triangle that it refuses
// gets vertices of its own.
#include "peers/peer_main.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Utils/vector_cast.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include <array>

namespace {

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using TriMesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;

exchange::Mesh simplify(const exchange::Mesh& in, std::size_t target, const Timed& timed) {
  TriMesh mesh;
  const auto point = [&](std::size_t v) {
    return TriMesh::Point(in.positions[3 * v], in.positions[3 * v + 1], in.positions[3 * v + 2]);
  };
  std::vector<TriMesh::VertexHandle> handles;
  for (std::size_t v = 0; v < in.vertex_count(); ++v) handles.push_back(mesh.add_vertex(point(v)));
  omerr().disable();
  for (std::size_t t = 0; t < in.triangle_count(); ++t) {
    const std::uint32_t* c = &in.corners[3 * t];
    if (mesh.add_face(handles[c[0]], handles[c[1]], handles[c[2]]).is_valid()) continue;
    const TriMesh::VertexHandle a = mesh.add_vertex(point(c[0])), b = mesh.add_vertex(point(c[1])),
                                d = mesh.add_vertex(point(c[2]));
    mesh.add_face(a, b, d);
  }
  mesh.request_vertex_status();
  mesh.request_edge_status();
  mesh.request_face_status();
  mesh.request_halfedge_status();
  mesh.request_face_normals();
  mesh.update_face_normals();

  OpenMesh::Decimater::DecimaterT<TriMesh> decimater(mesh);
  OpenMesh::Decimater::ModQuadricT<TriMesh>::Handle quadric;
  decimater.add(quadric);
  decimater.module(quadric).unset_max_err();
  decimater.initialize();
  timed([&] { decimater.decimate_to_faces(0, target); });
  mesh.garbage_collection();

  exchange::Mesh out;
  for (TriMesh::VertexHandle v : mesh.vertices()) {
    const TriMesh::Point& p = mesh.point(v);
    out.positions.insert(out.positions.end(), {p[0], p[1], p[2]});
  }
  for (TriMesh::FaceHandle f : mesh.faces()) {
    for (TriMesh::VertexHandle v : mesh.fv_range(f)) {
      out.corners.push_back(static_cast<std::uint32_t>(v.idx()));
    }
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  return peer_main(argc, argv, simplify);
}
