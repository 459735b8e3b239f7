#include "io/byte_sink.h"
#include "io/formats.h"
#include "io/left_out.h"
#include "io/split_vertices.h"
#include "mesh/box_of.h"
#include "mesh/own_grid.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

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

// How many decimals positions have, but for the rounding of a grid's origin and steps, if few.
std::optional<int> decimals_of(const Mesh& mesh) {
  constexpr int kMost = 12;
  const double longest = box_of(mesh.positions).longest;
  if (!(longest > 0)) return std::nullopt;
  const std::optional<double> step = round_step(mesh.positions, longest, std::ldexp(longest, -30));
  for (int decimals = 0; step && decimals <= kMost; ++decimals) {
    const double steps = *step * std::pow(10.0, decimals);
    if (steps > 0.5 && std::abs(steps - std::round(steps)) < 1e-6) return decimals;
  }
  return std::nullopt;
}

// 503.458, not 503.45799999999997.
void write_decimals(ByteSink& out, double x, int decimals) {
  std::array<char, 400> digits;
  const auto got = std::to_chars(digits.data(), digits.data() + digits.size(), x,
                                 std::chars_format::fixed, decimals);
  std::string_view text(digits.data(), static_cast<std::size_t>(got.ptr - digits.data()));
  if (text.find('.') != text.npos) {
    text = text.substr(0, text.find_last_not_of('0') + 1);
    if (text.ends_with('.')) text.remove_suffix(1);
  }
  out.text(text == "-0" ? "0" : text);
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

// By which a reader tells materials apart: of equal ones the later get numbers.
std::vector<std::string> names_of(const std::vector<Material>& materials) {
  std::vector<std::string> names;
  std::unordered_set<std::string> own, given;
  for (const Material& material : materials) {
    names.push_back(in_one_line(material.name, "default"));
    own.insert(names.back());
  }
  for (std::string& name : names) {
    const std::string wanted = name;
    for (int i = 2; given.contains(name) || (name != wanted && own.contains(name)); ++i) {
      name = wanted + "_" + std::to_string(i);
    }
    given.insert(name);
  }
  return names;
}

// The triangles part by part, and in each material by material: a reader makes an object of each
// run.
std::vector<std::size_t> in_runs(const Mesh& mesh) {
  std::vector<std::size_t> order(mesh.triangle_count());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::ranges::stable_sort(order, {}, [&](std::size_t t) {
    return std::pair(
        mesh.part_of_triangle.empty() ? 0 : index_of(mesh.part_of_triangle[t]),
        mesh.material_of_triangle.empty() ? 0 : index_of(mesh.material_of_triangle[t]));
  });
  return order;
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

  // OBJ has no word for it; read_obj() knows the comment.
  if (mesh.up != UpAxis::Unknown) out.text(mesh.up == UpAxis::Y ? "# up y\n" : "# up z\n");
  if (!mtl_name.empty()) {
    out.text("mtllib ");
    out.text(mtl_name);
    out.text("\n");
  }
  const std::optional<int> decimals = decimals_of(mesh);
  for (std::size_t s = 0; s < split.count(); ++s) {
    const Vec3d& p = mesh.positions[split.position[s]];
    out.text("v");
    for (int i = 0; i < 3; ++i) {
      out.text(" ");
      if (decimals) {
        write_decimals(out, p[i], *decimals);
      } else {
        out.number(p[i]);
      }
    }
    for (std::size_t c = 0; colors && c < 3; ++c) {
      out.text(" ");
      out.number(colors->value(split.values[0][s])[c]);
    }
    out.text("\n");
  }
  if (texcoords) write_values(out, "vt", *texcoords);
  if (normals) write_values(out, "vn", *normals);

  const std::vector<std::string> material_names = names_of(mesh.materials);
  std::optional<std::size_t> before;
  for (const std::size_t t : in_runs(mesh)) {
    const auto changes = [&](const auto& of_triangle) {
      return !of_triangle.empty() && (!before || of_triangle[t] != of_triangle[*before]);
    };
    const bool part_begins = changes(mesh.part_of_triangle);
    if (part_begins) {
      out.text("o ");
      out.text(in_one_line(mesh.parts[index_of(mesh.part_of_triangle[t])], "unnamed"));
      out.text("\n");
    }
    if (changes(mesh.material_of_triangle) || (part_begins && !mesh.material_of_triangle.empty())) {
      out.text("usemtl ");
      out.text(material_names[index_of(mesh.material_of_triangle[t])]);
      out.text("\n");
    }
    before = t;
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
  const std::vector<std::string> names = names_of(mesh.materials);
  for (std::size_t m = 0; m < mesh.materials.size(); ++m) {
    const Material& material = mesh.materials[m];
    out.text("newmtl ");
    out.text(names[m]);
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
