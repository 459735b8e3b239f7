// Several files as one mesh.
#include "crease/import.h"

#include "io/images.h"
#include "io/layer_fill.h"
#include "mesh/clean.h"
#include "mesh/guess_up.h"
#include "mesh/weld.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace crease {

namespace {

// Colours of one name are one layer, with alpha or without.
bool is_same_layer(const AttributeLayer& a, const AttributeLayer& b) {
  return a.name == b.name && a.role == b.role && a.interpolation == b.interpolation &&
         (a.dimension == b.dimension || a.role == AttributeRole::Color);
}

AttributeId add_fill(AttributeLayer& layer) {
  const AttributeId fill{static_cast<std::uint32_t>(layer.value_count())};
  layer.values.resize(layer.values.size() + layer.dimension, fill_of(layer.role));
  return fill;
}

// Adds `from`'s layers to `to`, which has `before` triangles, `from` having `added`.
void append_layers(Mesh& to, std::vector<AttributeLayer> from, std::size_t before,
                   std::size_t added) {
  for (AttributeLayer& layer : from) {
    const auto same = std::find_if(to.layers.begin(), to.layers.end(), [&](const auto& candidate) {
      return is_same_layer(candidate, layer);
    });
    const auto at = static_cast<std::size_t>(same - to.layers.begin());
    if (at == to.layers.size()) {
      AttributeLayer fresh{layer.name, layer.role, layer.interpolation, layer.dimension, {}, {}};
      fresh.of_corner.assign(3 * before, add_fill(fresh));
      to.layers.push_back(std::move(fresh));
    }
    AttributeLayer& target = to.layers[at];
    if (target.dimension < layer.dimension) widen(target, layer.dimension);
    if (layer.dimension < target.dimension) widen(layer, target.dimension);
    const auto first = static_cast<std::uint32_t>(target.value_count());
    target.values.insert(target.values.end(), layer.values.begin(), layer.values.end());
    for (AttributeId a : layer.of_corner) {
      target.of_corner.push_back(AttributeId{first + static_cast<std::uint32_t>(index_of(a))});
    }
  }
  for (AttributeLayer& layer : to.layers) {
    if (layer.of_corner.size() == 3 * (before + added)) continue;
    layer.of_corner.resize(3 * (before + added), add_fill(layer));
  }
}

void append_materials(Mesh& to, const Mesh& from, std::size_t before, std::size_t added) {
  if (to.materials.empty() && from.materials.empty()) return;
  const auto id_of = [&](const Material& material) {
    const auto found = std::find(to.materials.begin(), to.materials.end(), material);
    const auto id = static_cast<std::uint32_t>(found - to.materials.begin());
    if (found == to.materials.end()) to.materials.push_back(material);
    return MaterialId{id};
  };
  if (to.material_of_triangle.size() < before) to.material_of_triangle.resize(before, id_of({}));
  std::vector<MaterialId> new_of_old;
  for (const Material& material : from.materials) new_of_old.push_back(id_of(material));
  for (MaterialId m : from.material_of_triangle) {
    to.material_of_triangle.push_back(new_of_old[index_of(m)]);
  }
  if (to.material_of_triangle.size() < before + added) {
    to.material_of_triangle.resize(before + added, id_of({}));
  }
}

// Those of a file that has several keep their names, behind its own.
void append_parts(Mesh& to, const Mesh& from, const std::string& file) {
  const auto first = static_cast<std::uint32_t>(to.parts.size());
  if (from.parts.size() < 2) {
    to.part_of_triangle.resize(to.part_of_triangle.size() + from.triangle_count(), PartId{first});
    to.parts.push_back(file);
    return;
  }
  for (const PartId part : from.part_of_triangle) {
    to.part_of_triangle.push_back(PartId{first + static_cast<std::uint32_t>(index_of(part))});
  }
  for (const std::string& part : from.parts) to.parts.push_back(file + "/" + part);
}

void append(Mesh& to, Mesh from, const std::string& file) {
  const std::size_t before = to.triangle_count(), added = from.triangle_count();
  append_images(from.images, from.materials, to.images);
  append_materials(to, from, before, added);
  append_parts(to, from, file);
  append_layers(to, std::move(from.layers), before, added);
  const auto first = static_cast<std::uint32_t>(to.vertex_count());
  to.positions.insert(to.positions.end(), from.positions.begin(), from.positions.end());
  for (const Triangle& triangle : from.triangles) {
    Triangle moved;
    for (int c = 0; c < 3; ++c) {
      moved[c] = VertexId{first + static_cast<std::uint32_t>(index_of(triangle[c]))};
    }
    to.triangles.push_back(moved);
  }
}

const char* name_of(UpAxis up) {
  return up == UpAxis::Y ? "y" : "z";
}

// Sums up; formats and normals are listed once each.
void append(ImportReport& to, const ImportReport& from, const std::string& file) {
  const auto list = [](std::string& words, const std::string& more) {
    if (words.find(more) != words.npos) return;
    words += (words.empty() ? "" : ", ") + more;
  };
  list(to.format, from.format);
  list(to.normals, from.normals);
  to.polygons += from.polygons;
  to.degenerate_triangles += from.degenerate_triangles;
  to.reversed_normals += from.reversed_normals;
  to.isolated_vertices += from.isolated_vertices;
  to.welded_vertices += from.welded_vertices;
  to.zero_normals += from.zero_normals;
  to.bad_attribute_values += from.bad_attribute_values;
  to.joined_normals += from.joined_normals;
  for (const std::string& note : from.notes) to.notes.push_back(file + ": " + note);
}

}  // namespace

Result<Imported> import_meshes(std::span<const std::filesystem::path> paths,
                               const ImportOptions& options) {
  if (paths.empty()) return fail(Error::CommandLine, "no file to import");
  if (paths.size() == 1) return import_mesh(paths[0], options);
  Imported all;
  std::optional<UpAxis> said;  // the first up axis that a file says
  for (const std::filesystem::path& path : paths) {
    Result<Imported> one = import_mesh(path, options);
    if (!one.ok()) return one.failure();
    const bool is_said = !one->report.up_is_guessed;
    if (path == paths[0]) all.mesh.up = one->mesh.up;
    all.report.up_is_guessed = all.report.up_is_guessed || !is_said || one->mesh.up != all.mesh.up;
    if (is_said && said && *said != one->mesh.up) {
      all.report.notes.push_back(path.string() + ": says that " + name_of(one->mesh.up) +
                                 " is up, files before it that " + name_of(*said) +
                                 " is; none is turned");
    }
    if (is_said && !said) said = one->mesh.up;
    append(all.report, one->report, path.string());
    append(all.mesh, std::move(one->mesh), path.filename().string());
  }
  Mesh& mesh = all.mesh;
  if (3 * mesh.triangle_count() >= kNone) {
    return fail(Error::OverLimit, "the files have too many triangles together");
  }
  const Weld weld = weld_positions(mesh.positions);
  all.report.welded_vertices += mesh.vertex_count() - weld.first_old.size();
  keep_rows(mesh.positions, weld.first_old);
  for (Triangle& triangle : mesh.triangles) {
    for (VertexId& v : triangle) v = VertexId{weld.new_of_old[index_of(v)]};
  }
  for (AttributeLayer& layer : mesh.layers) weld_layer(layer);
  settle_images(mesh.materials, mesh.images);
  std::stable_partition(mesh.layers.begin(), mesh.layers.end(), [](const AttributeLayer& layer) {
    return layer.role == AttributeRole::Normal;
  });
  if (all.report.up_is_guessed) mesh.up = guess_up(mesh, mesh.up);
  all.report.up = mesh.up;
  // Again over all: files may repeat each other, and share edges.
  all.report.duplicate_triangles = count_duplicate_triangles(mesh);
  all.report.zero_area_triangles = count_zero_area_triangles(mesh);
  all.report.misoriented_edges = count_misoriented_edges(mesh);
  return all;
}

}  // namespace crease
