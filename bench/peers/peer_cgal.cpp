// CGAL's edge collapse with the cost and the placement of Lindstrom and Turk, its defaults. CGAL
// takes manifolds only: others are cut at their non-manifold edges and vertices first.
#include "peers/peer_main.h"

#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <array>

namespace {

using Point = CGAL::Simple_cartesian<double>::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;

struct StopAtFaces {
  const SurfaceMesh* mesh;
  std::size_t target;

  template <typename Cost, typename Profile>
  bool operator()(const Cost&, const Profile&, std::size_t, std::size_t) const {
    return mesh->number_of_faces() <= target;
  }
};

exchange::Mesh simplify(const exchange::Mesh& in, std::size_t target, const Timed& timed) {
  std::vector<Point> points;
  for (std::size_t v = 0; v < in.vertex_count(); ++v) {
    points.emplace_back(in.positions[3 * v], in.positions[3 * v + 1], in.positions[3 * v + 2]);
  }
  std::vector<std::vector<std::size_t>> triangles;
  for (std::size_t t = 0; t < in.triangle_count(); ++t) {
    triangles.push_back({in.corners[3 * t], in.corners[3 * t + 1], in.corners[3 * t + 2]});
  }
  namespace pmp = CGAL::Polygon_mesh_processing;
  pmp::merge_duplicate_polygons_in_polygon_soup(points, triangles);
  pmp::orient_polygon_soup(points, triangles);
  SurfaceMesh mesh;
  pmp::polygon_soup_to_polygon_mesh(points, triangles, mesh);

  timed([&] {
    CGAL::Surface_mesh_simplification::edge_collapse(mesh, StopAtFaces{&mesh, target});
  });

  exchange::Mesh out;
  mesh.collect_garbage();
  for (SurfaceMesh::Vertex_index v : mesh.vertices()) {
    const Point& p = mesh.point(v);
    out.positions.insert(out.positions.end(), {p.x(), p.y(), p.z()});
  }
  for (SurfaceMesh::Face_index f : mesh.faces()) {
    for (SurfaceMesh::Vertex_index v : vertices_around_face(mesh.halfedge(f), mesh)) {
      out.corners.push_back(static_cast<std::uint32_t>(std::size_t(v)));
    }
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  return peer_main(argc, argv, simplify);
}
