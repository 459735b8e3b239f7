// One cube and one cylinder, to be written in every format by the tests themselves: whatever the
// format, import must find the same hard edges.
#pragma once

#include "crease/import.h"
#include "crease/mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace crease {

struct PolygonModel {
  std::string name;
  std::vector<Vec3d> positions;  // floats, so that every format holds them exactly
  struct Face {
    std::vector<std::uint32_t> corners;
    std::vector<std::uint32_t> normals;  // one a corner
    std::uint32_t smoothing_group = 0;
  };
  std::vector<Face> faces;
  std::vector<Vec3d> normals;  // floats
  std::size_t hard_edge_count = 0;

  // Every face as a fan.
  std::vector<std::array<std::uint32_t, 3>> triangles() const;
};

PolygonModel polygon_cube();      // 12 hard edges
PolygonModel polygon_cylinder();  // 24 segments: 48 hard edges, two rims
std::vector<PolygonModel> polygon_models();

// The edges across which normals differ at an end, as pairs of positions, the smaller first.
using Point = std::array<double, 3>;
using HardEdges = std::set<std::pair<Point, Point>>;
HardEdges hard_edges(const Mesh& mesh);
HardEdges hard_edges(const PolygonModel& model);

// import_bytes() of a text; fails the test with the message if it is refused.
Imported import_text(std::string_view text, std::string_view name,
                     const ImportOptions& options = {});
// The message of a refusal; fails the test if there is none.
std::string refusal_of(std::string_view text, std::string_view name);

}  // namespace crease
