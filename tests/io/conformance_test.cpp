// The same cube and the same cylinder in every format have the same hard edges.
#include "io/polygon_model.h"

#include "io/byte_sink.h"
#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <cstdio>
#include <map>
#include <string>

namespace crease {
namespace {

std::string shown(const Vec3d& v) {
  char text[96];
  std::snprintf(text, sizeof text, " %.17g %.17g %.17g", v.x, v.y, v.z);
  return text;
}

std::string obj_vertices(const PolygonModel& model) {
  std::string out;
  for (const Vec3d& p : model.positions) out += "v" + shown(p) + "\n";
  return out;
}

std::string obj_with_groups(const PolygonModel& model) {
  std::string out = obj_vertices(model);
  for (const PolygonModel::Face& face : model.faces) {
    out += "s " + std::to_string(face.smoothing_group) + "\nf";
    for (std::uint32_t v : face.corners) out += " " + std::to_string(v + 1);
    out += "\n";
  }
  return out;
}

std::string obj_with_normals(const PolygonModel& model, bool negative) {
  std::string out = obj_vertices(model);
  for (const Vec3d& n : model.normals) out += "vn" + shown(n) + "\n";
  const auto index = [&](std::uint32_t i, std::size_t count) {
    return std::to_string(negative ? static_cast<long>(i) - static_cast<long>(count)
                                   : static_cast<long>(i) + 1);
  };
  for (const PolygonModel::Face& face : model.faces) {
    out += "f";
    for (std::size_t i = 0; i < face.corners.size(); ++i) {
      out += " " + index(face.corners[i], model.positions.size()) + "//" +
             index(face.normals[i], model.normals.size());
    }
    out += "\n";
  }
  return out;
}

// Split vertices with normals, as scanners and modellers write them.
std::string text_ply(const PolygonModel& model) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> split;
  std::string vertices, faces;
  for (const PolygonModel::Face& face : model.faces) {
    faces += std::to_string(face.corners.size());
    for (std::size_t i = 0; i < face.corners.size(); ++i) {
      const auto [found, is_new] =
          split.emplace(std::pair(face.corners[i], face.normals[i]), split.size());
      if (is_new) {
        vertices +=
            shown(model.positions[face.corners[i]]) + shown(model.normals[face.normals[i]]) + "\n";
      }
      faces += " " + std::to_string(found->second);
    }
    faces += "\n";
  }
  return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(split.size()) +
         "\nproperty double x\nproperty double y\nproperty double z\n"
         "property float nx\nproperty float ny\nproperty float nz\nelement face " +
         std::to_string(model.faces.size()) +
         "\nproperty list uchar int vertex_index\nend_header\n" + vertices + faces;
}

std::string text_ply_without_normals(const PolygonModel& model) {
  std::string out =
      "ply\nformat ascii 1.0\nelement vertex " + std::to_string(model.positions.size()) +
      "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
      std::to_string(model.faces.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3d& p : model.positions) out += shown(p) + "\n";
  for (const PolygonModel::Face& face : model.faces) {
    out += std::to_string(face.corners.size());
    for (std::uint32_t v : face.corners) out += " " + std::to_string(v);
    out += "\n";
  }
  return out;
}

std::string text_off(const PolygonModel& model) {
  std::string out = "OFF # a comment\n" + std::to_string(model.positions.size()) + " " +
                    std::to_string(model.faces.size()) + " 0\n\n";
  for (const Vec3d& p : model.positions) out += shown(p) + "\n";
  for (const PolygonModel::Face& face : model.faces) {
    out += std::to_string(face.corners.size());
    for (std::uint32_t v : face.corners) out += " " + std::to_string(v);
    out += "\n";
  }
  return out;
}

std::string text_stl(const PolygonModel& model) {
  std::string out = "solid model\n";
  for (const auto& triangle : model.triangles()) {
    out += "facet normal 0 0 0\n outer loop\n";
    for (std::uint32_t v : triangle) out += "  vertex" + shown(model.positions[v]) + "\n";
    out += " endloop\nendfacet\n";
  }
  return out + "endsolid model\n";
}

std::string binary_stl(const PolygonModel& model) {
  ByteSink out;
  out.text("solid, but binary" + std::string(63, ' '));
  out.u32(static_cast<std::uint32_t>(model.triangles().size()));
  for (const auto& triangle : model.triangles()) {
    for (int i = 0; i < 3; ++i) out.f32(0);
    for (std::uint32_t v : triangle) {
      for (int i = 0; i < 3; ++i) out.f32(static_cast<float>(model.positions[v][i]));
    }
    out.u16(0);
  }
  const std::vector<std::byte> bytes = out.take();
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void check_model(const PolygonModel& model, const std::string& text, const std::string& name) {
  CAPTURE(model.name);
  CAPTURE(name);
  const Imported imported = import_text(text, name);
  CHECK(imported.mesh.vertex_count() == model.positions.size());
  CHECK(imported.mesh.triangle_count() == model.triangles().size());
  CHECK(hard_edges(imported.mesh).size() == model.hard_edge_count);
  CHECK(hard_edges(imported.mesh) == hard_edges(model));
}

TEST_CASE("the models have the hard edges that they say") {
  for (const PolygonModel& model : polygon_models()) {
    CHECK(hard_edges(model).size() == model.hard_edge_count);
  }
}

TEST_CASE("OBJ with smoothing groups, with normals, and with negative indices") {
  for (const PolygonModel& model : polygon_models()) {
    check_model(model, obj_with_groups(model), "groups.obj");
    check_model(model, obj_with_normals(model, false), "normals.obj");
    check_model(model, obj_with_normals(model, true), "negative.obj");
  }
}

TEST_CASE("PLY with split normals, and with none") {
  for (const PolygonModel& model : polygon_models()) {
    check_model(model, text_ply(model), "split.ply");
    check_model(model, text_ply_without_normals(model), "plain.ply");
  }
}

TEST_CASE("STL in text and in binary") {
  for (const PolygonModel& model : polygon_models()) {
    check_model(model, text_stl(model), "text.stl");
    check_model(model, binary_stl(model), "binary.stl");
  }
}

TEST_CASE("OFF") {
  for (const PolygonModel& model : polygon_models())
    check_model(model, text_off(model), "model.off");
}

}  // namespace
}  // namespace crease
