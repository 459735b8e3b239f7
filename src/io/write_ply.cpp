// Binary little-endian PLY: doubles for positions, split vertices for hard edges, a face property
// for each layer with one value a triangle, and materials and parts as indices that comments give
// names to.
#include "io/byte_sink.h"
#include "io/formats.h"
#include "io/ply_names.h"
#include "io/split_vertices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>
#include <string>
#include <string_view>

namespace crease {

namespace {

struct PlyLayer {
  const AttributeLayer* layer = nullptr;
  bool is_told = true;                  // by its properties' names
  bool as_bytes = false;                // colours that came from bytes go back to bytes
  bool as_integers = false;             // categories
  std::vector<std::string> properties;  // one a component
};

bool all_values(const AttributeLayer& layer, float scale, float low, float high) {
  return std::all_of(layer.values.begin(), layer.values.end(), [&](float x) {
    const float scaled = x * scale;
    // The float nearest to k / 255 and back: equal iff the value came from a byte.
    return scaled >= low && scaled <= high && std::round(scaled) / scale == x;
  });
}

// One word, so that the header can be read again.
std::string word_of(std::string name) {
  for (char& c : name) {
    if (c <= ' ' || c > '~') c = '_';
  }
  return name.empty() ? "value" : name;
}

std::string numbered(std::string name, std::size_t k) {
  name += '_';
  return name += std::to_string(k);
}

PlyLayer plan_layer(const AttributeLayer& layer) {
  PlyLayer plan{&layer, layer.role != AttributeRole::Other, false, false, {}};
  switch (layer.role) {
    case AttributeRole::Normal:
      plan.properties = {"nx", "ny", "nz"};
      break;
    case AttributeRole::TexCoord:
      plan.properties = {"s", "t"};
      break;
    case AttributeRole::Color:
      plan.properties = {"red", "green", "blue", "alpha"};
      plan.as_bytes = all_values(layer, 255, 0, 255);
      break;
    case AttributeRole::Other:
      for (std::uint32_t k = 0; k < layer.dimension; ++k) {
        plan.properties.push_back(layer.dimension > 1 ? numbered(word_of(layer.name), k)
                                                      : word_of(layer.name));
      }
      plan.as_integers = layer.interpolation == Interpolation::Categorical &&
                         all_values(layer, 1, -16777216, 16777216);
      break;
  }
  plan.properties.resize(layer.dimension, "value");
  return plan;
}

void write_properties(ByteSink& out, const PlyLayer& plan) {
  for (const std::string& property : plan.properties) {
    out.text(plan.as_bytes      ? "property uchar "
             : plan.as_integers ? "property int "
                                : "property float ");
    out.text(property);
    out.text("\n");
  }
}

void write_value(ByteSink& out, const PlyLayer& plan, AttributeId a) {
  for (float x : plan.layer->value(a)) {
    if (plan.as_bytes) {
      out.u8(static_cast<std::uint8_t>(std::lround(x * 255)));
    } else if (plan.as_integers) {
      out.u32(static_cast<std::uint32_t>(static_cast<std::int32_t>(x)));
    } else {
      out.f32(x);
    }
  }
}

bool has_role_before(const std::vector<PlyLayer>& plans, const AttributeLayer& layer) {
  return layer.role != AttributeRole::Other &&
         std::any_of(plans.begin(), plans.end(),
                     [&](const PlyLayer& plan) { return plan.layer->role == layer.role; });
}

// Names that a reader gives a meaning of their own.
bool is_meaningful(std::string_view name) {
  constexpr std::string_view kNames[] = {
      "x",    "y",     "z", "nx", "ny",           "nz",       "red",        "green",
      "blue", "alpha", "s", "t",  kMaterialIndex, kPartIndex, kTextureIndex};
  return std::find(std::begin(kNames), std::end(kNames), name) != std::end(kNames);
}

// So that no layer is taken for something else: a linear `x` of the faces, written at the vertices,
// would be a second `x` there, of which readers take either. `is_meant`: the layer has the role
// that its names say.
void make_unique(PlyLayer& plan, bool is_meant, std::set<std::string>& taken) {
  for (std::string& property : plan.properties) {
    if (is_meant && is_meaningful(property)) continue;
    const std::string name = property;
    for (std::size_t k = 2; is_meaningful(property) || !taken.insert(property).second; ++k) {
      property = numbered(name, k);
    }
  }
}

void write_layer_comments(ByteSink& out, const char* element, const std::vector<PlyLayer>& plans) {
  for (const PlyLayer& plan : plans) {
    if (plan.is_told) continue;
    const AttributeLayer& layer = *plan.layer;
    write_layer_comment(out, {.element = element,
                              .property = plan.properties[0],
                              .dimension = layer.dimension,
                              .role = layer.role,
                              .interpolation = layer.interpolation,
                              .name = layer.name});
  }
}

}  // namespace

std::vector<std::byte> write_ply(const Mesh& mesh, std::span<const std::string> image_files) {
  std::vector<PlyLayer> of_vertex, of_face;
  std::vector<const AttributeLayer*> splitting;
  std::set<std::string> taken;
  for (const AttributeLayer& layer : mesh.layers) {
    const bool is_face =
        layer.interpolation == Interpolation::Categorical && is_per_triangle(layer);
    PlyLayer plan = plan_layer(layer);
    const bool is_second = has_role_before(of_vertex, layer);
    if (is_second) {  // a second set of texture coordinates or colours
      for (std::size_t k = 0; k < plan.properties.size(); ++k) {
        plan.properties[k] = numbered(word_of(layer.name), k);
      }
      plan.as_bytes = false;
      plan.is_told = false;
    }
    make_unique(plan, layer.role != AttributeRole::Other && !is_second, taken);
    if (!is_face) splitting.push_back(&layer);
    (is_face ? of_face : of_vertex).push_back(std::move(plan));
  }
  const SplitVertices split = split_vertices(mesh, splitting);
  const bool has_materials = !mesh.material_of_triangle.empty();
  const bool has_parts = !mesh.part_of_triangle.empty();
  std::vector<Material> materials;
  if (has_materials) materials = mesh.materials;
  for (Material& material : materials) {
    const ImageFile* image = find_image(mesh.images, material.base_color_texture);
    if (!image || image_files.empty()) continue;
    material.base_color_texture = image_files[static_cast<std::size_t>(image - mesh.images.data())];
  }
  const PlyTextures textures(materials);

  ByteSink out;
  out.reserve(1024 + split.count() * 48 + mesh.triangle_count() * 17);
  out.text("ply\nformat binary_little_endian 1.0\ncomment written by crease\n");
  write_up_comment(out, mesh.up);
  if (has_materials) write_material_comments(out, materials, textures);
  if (has_parts) write_part_comments(out, mesh.parts);
  write_layer_comments(out, "vertex", of_vertex);
  write_layer_comments(out, "face", of_face);
  out.text("element vertex " + std::to_string(split.count()) + "\n");
  out.text("property double x\nproperty double y\nproperty double z\n");
  for (const PlyLayer& plan : of_vertex) write_properties(out, plan);
  out.text("element face " + std::to_string(mesh.triangle_count()) + "\n");
  out.text("property list uchar uint vertex_indices\n");
  for (const PlyLayer& plan : of_face) write_properties(out, plan);
  const auto int_property = [&](std::string_view name) {
    out.text("property int ");
    out.text(name);
    out.text("\n");
  };
  if (has_materials) int_property(kMaterialIndex);
  if (textures.need_numbers()) int_property(kTextureIndex);
  if (has_parts) int_property(kPartIndex);
  out.text("end_header\n");

  for (std::size_t s = 0; s < split.count(); ++s) {
    const Vec3d& p = mesh.positions[split.position[s]];
    for (int i = 0; i < 3; ++i) out.f64(p[i]);
    for (std::size_t l = 0; l < of_vertex.size(); ++l)
      write_value(out, of_vertex[l], split.values[l][s]);
  }
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    out.u8(3);
    for (std::size_t corner = 3 * t; corner < 3 * t + 3; ++corner) out.u32(split.of_corner[corner]);
    for (const PlyLayer& plan : of_face) write_value(out, plan, plan.layer->of_corner[3 * t]);
    if (has_materials) {
      const std::size_t material = index_of(mesh.material_of_triangle[t]);
      out.u32(static_cast<std::uint32_t>(material));
      if (textures.need_numbers()) {
        out.u32(static_cast<std::uint32_t>(textures.of_material[material]));
      }
    }
    if (has_parts) out.u32(static_cast<std::uint32_t>(index_of(mesh.part_of_triangle[t])));
  }
  return out.take();
}

}  // namespace crease
