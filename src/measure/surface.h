// A mesh made ready for closest-point queries.
//
//   const Frame frame = common_frame(a, b);
//   const Surface surface(b, frame);
//   Nearest nearest = surface.nearest(p, n, 1e-5, scratch);
//
// Everything here is in frame units: both meshes but for their strays lie within -1..1, and no
// digit of a city's 10^6 m coordinates goes into an offset.
#pragma once

#include "crease/mesh.h"
#include "measure/triangle_pieces.h"

#include <embree3/rtcore.h>

#include <memory>
#include <type_traits>
#include <vector>

namespace crease {

// frame = (model - origin) * scale. The scale is a power of two, so scaling is exact.
struct Frame {
  Vec3d origin;
  double scale = 1;
  double diagonal = 0;  // of a's bounding box, model units
  double size = 0;      // the same without strays
  double larger = 0;    // the larger diagonal of the two, model units
  double gap = 0;       // between the two boxes, model units; 0 where they meet

  Vec3d to_frame(const Vec3d& p) const { return (p - origin) * scale; }
};
Frame common_frame(const Mesh& a, const Mesh& b);

struct Nearest {
  double distance = 0;             // frame units
  double deviation_rad = 0;        // the least among all triangles within the tie of the distance
  std::uint32_t triangle = kNone;  // the first of those that are as near as any
};

class Surface {
 public:
  // Keeps a reference to the mesh. Build time O(triangles log triangles), on the threads of the
  // TBB arena it is called in.
  Surface(const Mesh& mesh, const Frame& frame);

  const Mesh& mesh() const { return mesh_; }
  std::size_t triangle_count() const { return mesh_.triangle_count(); }
  Vec3d position(std::size_t vertex) const { return positions_[vertex]; }
  Vec3d corner(std::size_t triangle, std::size_t corner) const {
    return positions_[index_of(mesh_.triangles[triangle][corner])];
  }
  // Unit length; the triangle's own where the corner normals cancel out, else zero.
  Vec3d normal(std::size_t triangle, const std::array<double, 3>& weights) const;

  // What a thread keeps from one query to the next. It makes them faster and changes no result.
  struct Scratch {
    struct Candidate {
      double distance;
      std::uint32_t triangle;
      std::array<double, 3> weights;
    };
    std::vector<Candidate> candidates;    // after a query: all triangles within its tie
    std::uint32_t last_triangle = kNone;  // samples come in an order that stays near

    void keep_one_each();  // of those that several pieces of a triangle gave
  };
  // Deviation is measured against `normal` where one is given.
  Nearest nearest(const Vec3d& p, const Vec3d* normal, double tie, Scratch& scratch) const;

 private:
  struct Query;
  void visit(Query& query, std::uint32_t triangle) const;
  RTCBounds bounds_of(std::size_t primitive) const;
  static bool visit_primitive(RTCPointQueryFunctionArguments* arguments);

  struct Release {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  };
  const Mesh& mesh_;
  const AttributeLayer& normals_;
  std::vector<Vec3d> positions_;       // frame units
  std::vector<TrianglePiece> pieces_;  // what Embree has; empty: the triangles
  std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release> device_;
  std::unique_ptr<std::remove_pointer_t<RTCScene>, Release> scene_;
};

// 0 to pi; exact for small angles too, down to 1e-12, below which it is rounding and none. Zero
// vectors deviate by nothing.
double angle_between(const Vec3d& a, const Vec3d& b);

}  // namespace crease
