#include "crease/mesh.h"

#include "mesh/finite_material.h"

#include <algorithm>
#include <cmath>

namespace crease {

const AttributeLayer* Mesh::normals() const {
  const auto found = std::find_if(layers.begin(), layers.end(), [](const AttributeLayer& layer) {
    return layer.role == AttributeRole::Normal;
  });
  return found == layers.end() ? nullptr : &*found;
}

AttributeLayer* Mesh::normals() {
  return const_cast<AttributeLayer*>(static_cast<const Mesh*>(this)->normals());
}

const ImageFile* find_image(std::span<const ImageFile> images, std::string_view name) {
  const auto found = std::find_if(images.begin(), images.end(),
                                  [&](const ImageFile& image) { return image.name == name; });
  return name.empty() || found == images.end() ? nullptr : &*found;
}

namespace {

Failure broken(std::string what) {
  return fail(Error::Invalid, std::move(what));
}

Status check_layer(const AttributeLayer& layer, std::size_t triangle_count) {
  const std::string who = "attribute layer '" + layer.name + "'";
  if (layer.dimension < 1 || layer.dimension > 4) return broken(who + ": dimension not 1 to 4");
  if (layer.values.size() % layer.dimension != 0) return broken(who + ": odd number of values");
  if (layer.of_corner.size() != 3 * triangle_count) return broken(who + ": not one index a corner");
  for (std::size_t i = 0; i < layer.values.size(); ++i) {
    if (!std::isfinite(layer.values[i])) {
      return broken(who + ": value " + std::to_string(i / layer.dimension) + " is not finite");
    }
  }
  for (std::size_t corner = 0; corner < layer.of_corner.size(); ++corner) {
    if (index_of(layer.of_corner[corner]) >= layer.value_count()) {
      return broken(who + ": index out of range at corner " + std::to_string(corner));
    }
  }
  return Done{};
}

template <typename Id>
Status check_categories(const std::vector<Id>& of_triangle, std::size_t triangle_count,
                        std::size_t name_count, const char* what) {
  if (of_triangle.empty()) return Done{};
  if (of_triangle.size() != triangle_count)
    return broken(std::string(what) + ": not one a triangle");
  for (Id id : of_triangle) {
    if (index_of(id) >= name_count) return broken(std::string(what) + " out of range");
  }
  return Done{};
}

Status check_images(const std::vector<ImageFile>& images) {
  for (const ImageFile& image : images) {
    if (image.bytes == nullptr) return broken("image '" + image.name + "' has no bytes");
    if (find_image(images, image.name) != &image) {
      return broken("an image without a name of its own: '" + image.name + "'");
    }
  }
  return Done{};
}

}  // namespace

Status check_mesh(const Mesh& mesh) {
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3d& p = mesh.positions[v];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      return broken("position " + std::to_string(v) + " is not finite");
    }
  }
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    if (std::max({index_of(a), index_of(b), index_of(c)}) >= mesh.vertex_count()) {
      return broken("triangle " + std::to_string(t) + ": vertex index out of range");
    }
    if (a == b || b == c || c == a) {
      return broken("triangle " + std::to_string(t) + ": two equal corners");
    }
  }
  for (const AttributeLayer& layer : mesh.layers) {
    if (Status status = check_layer(layer, mesh.triangle_count()); !status.ok()) return status;
  }
  const auto normal_layers =
      std::count_if(mesh.layers.begin(), mesh.layers.end(),
                    [](const AttributeLayer& l) { return l.role == AttributeRole::Normal; });
  if (normal_layers > 1) return broken("more than one normal layer");
  if (const AttributeLayer* normals = mesh.normals(); normals && normals->dimension != 3) {
    return broken("normals are not of dimension 3");
  }
  if (Status status = check_categories(mesh.material_of_triangle, mesh.triangle_count(),
                                       mesh.materials.size(), "material");
      !status.ok()) {
    return status;
  }
  for (const Material& material : mesh.materials) {
    if (!is_finite(material)) {
      return broken("material '" + material.name + "': a number is not finite");
    }
  }
  if (Status status = check_images(mesh.images); !status.ok()) return status;
  return check_categories(mesh.part_of_triangle, mesh.triangle_count(), mesh.parts.size(), "part");
}

}  // namespace crease
