#include "io/byte_sink.h"
#include "io/formats.h"
#include "io/left_out.h"
#include "io/split_vertices.h"

#include <algorithm>
#include <string>

namespace crease {

namespace {

void write_values(ByteSink& out, std::string_view word, const AttributeLayer& layer) {
  for (std::size_t i = 0; i < layer.value_count(); ++i) {
    out.text(word);
    for (float x : layer.value(AttributeId{static_cast<std::uint32_t>(i)})) {
      out.text(" ");
      out.number(x);
    }
    out.text("\n");
  }
}

// Names stand in one line. An empty one stays nameless by a word of its own.
std::string in_one_line(std::string_view name, std::string_view if_empty) {
  std::string out(name.empty() ? if_empty : name);
  for (char& c : out) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  // A backslash at the end would continue the line.
  while (!out.empty() && out.back() == '\\') out.back() = '_';
  return out;
}

}  // namespace

// OBJ has colours only at vertices, so a vertex is written once for each of its colours; they are
// one again when positions are welded on import.
std::vector<std::byte> write_obj(const Mesh& mesh, std::string_view mtl_name) {
  ByteSink out;
  out.reserve(mesh.vertex_count() * 40 + mesh.triangle_count() * 40);
  const AttributeLayer* normals = mesh.normals();
  const AttributeLayer* texcoords = first_layer(mesh, AttributeRole::TexCoord);
  const AttributeLayer* colors = first_layer(mesh, AttributeRole::Color);
  const std::vector<const AttributeLayer*> splitting =
      colors ? std::vector<const AttributeLayer*>{colors} : std::vector<const AttributeLayer*>{};
  const SplitVertices split = split_vertices(mesh, splitting);

  if (!mtl_name.empty()) {
    out.text("mtllib ");
    out.text(mtl_name);
    out.text("\n");
  }
  for (std::size_t s = 0; s < split.count(); ++s) {
    const Vec3d& p = mesh.positions[split.position[s]];
    out.text("v");
    for (int i = 0; i < 3; ++i) {
      out.text(" ");
      out.number(p[i]);
    }
    for (std::size_t c = 0; colors && c < 3; ++c) {
      out.text(" ");
      out.number(colors->value(split.values[0][s])[c]);
    }
    out.text("\n");
  }
  if (texcoords) write_values(out, "vt", *texcoords);
  if (normals) write_values(out, "vn", *normals);

  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto changes = [&](const auto& of_triangle) {
      return !of_triangle.empty() && (t == 0 || of_triangle[t] != of_triangle[t - 1]);
    };
    if (changes(mesh.part_of_triangle)) {
      out.text("o ");
      out.text(in_one_line(mesh.parts[index_of(mesh.part_of_triangle[t])], "unnamed"));
      out.text("\n");
    }
    if (changes(mesh.material_of_triangle)) {
      out.text("usemtl ");
      out.text(in_one_line(mesh.materials[index_of(mesh.material_of_triangle[t])].name, "default"));
      out.text("\n");
    }
    out.text("f");
    for (std::size_t corner = 3 * t; corner < 3 * t + 3; ++corner) {
      out.text(" ");
      out.number(split.of_corner[corner] + 1);
      if (!texcoords && !normals) continue;
      out.text("/");
      if (texcoords) out.number(index_of(texcoords->of_corner[corner]) + 1);
      if (!normals) continue;
      out.text("/");
      out.number(index_of(normals->of_corner[corner]) + 1);
    }
    out.text("\n");
  }
  return out.take();
}

std::vector<std::byte> write_mtl(const Mesh& mesh, std::span<const std::string> image_files) {
  ByteSink out;
  for (const Material& material : mesh.materials) {
    out.text("newmtl ");
    out.text(in_one_line(material.name, "default"));
    out.text("\nKd");
    for (std::size_t i = 0; i < 3; ++i) {
      out.text(" ");
      out.number(material.base_color[i]);
    }
    out.text("\nd ");
    out.number(material.base_color[3]);
    out.text("\n");
    if (!material.base_color_texture.empty()) {
      const ImageFile* image = find_image(mesh.images, material.base_color_texture);
      out.text("map_Kd ");
      out.text(image ? image_files[static_cast<std::size_t>(image - mesh.images.data())]
                     : in_one_line(material.base_color_texture, ""));
      out.text("\n");
    }
  }
  return out.take();
}

}  // namespace crease
