#include "io/ply_layers.h"

#include <array>
#include <string_view>

namespace crease {

std::optional<std::size_t> find_scalar(const PlyElement& element, std::string_view name) {
  for (std::size_t p = 0; p < element.properties.size(); ++p) {
    if (!name.empty() && !element.properties[p].is_list && element.properties[p].name == name) {
      return p;
    }
  }
  return std::nullopt;
}

namespace {

struct NamedGroup {
  std::array<std::string_view, 4> names;
  std::size_t least;  // this many, from the first, make the group
};

constexpr NamedGroup kNormalGroup{{"nx", "ny", "nz", ""}, 3};
constexpr NamedGroup kColorGroups[] = {
    {{"red", "green", "blue", "alpha"}, 3},
    {{"diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"}, 3},
    {{"r", "g", "b", "a"}, 3},
};
constexpr NamedGroup kTexCoordGroups[] = {
    {{"s", "t", "", ""}, 2},
    {{"u", "v", "", ""}, 2},
    {{"texture_u", "texture_v", "", ""}, 2},
    {{"texture_s", "texture_t", "", ""}, 2},
    {{"texcoord_u", "texcoord_v", "", ""}, 2},
    {{"tex_u", "tex_v", "", ""}, 2},
};

bool is_axis(std::string_view name) {
  return name == "x" || name == "y" || name == "z";
}

double color_scale(PlyType type) {
  if (!is_integer(type)) return 1;
  return type == PlyType::Int16 || type == PlyType::Uint16 ? 1.0 / 65535 : 1.0 / 255;
}

// Gives the properties of `group` to a layer made by `make(dimension)`, if the element has them.
template <typename Make>
bool take_group(const PlyElement& element, const NamedGroup& group, PlyLayers& to, Make make) {
  std::vector<std::size_t> found;
  for (std::string_view name : group.names) {
    const std::optional<std::size_t> p = find_scalar(element, name);
    if (!p) break;
    found.push_back(*p);
  }
  if (found.size() < group.least) return false;
  RawLayer layer = make(static_cast<std::uint32_t>(found.size()));
  const bool is_color = layer.role == AttributeRole::Color;
  for (std::size_t c = 0; c < found.size(); ++c) {
    const double scale = is_color ? color_scale(element.properties[found[c]].type) : 1;
    to.targets[found[c]] = {PlyTarget::Kind::Layer, to.layers.size(), c, scale};
  }
  to.add(std::move(layer));
  return true;
}

PlyTarget::Kind list_target(const PlyProperty& property, bool is_face,
                            std::vector<std::string>& notes) {
  if (is_face && (property.name == "vertex_indices" || property.name == "vertex_index")) {
    return PlyTarget::Kind::Indices;
  }
  if (is_face && property.name == "texcoord") return PlyTarget::Kind::CornerTexCoords;
  notes.push_back("list '" + property.name + "' ignored");
  return PlyTarget::Kind::Ignored;
}

}  // namespace

PlyLayers plan_layers(const PlyElement& element, RawLayer::Per per,
                      std::vector<std::string>& notes) {
  PlyLayers plan;
  plan.targets.resize(element.properties.size());
  const bool is_face = per == RawLayer::Per::Face;
  take_group(element, kNormalGroup, plan, [&](std::uint32_t) { return normal_layer(per); });
  for (const NamedGroup& group : kColorGroups) {
    if (take_group(element, group, plan, [&](std::uint32_t n) { return color_layer(per, n); }))
      break;
  }
  if (!is_face) {
    for (const NamedGroup& group : kTexCoordGroups) {
      if (take_group(element, group, plan,
                     [&](std::uint32_t) { return texcoord_layer("uv", per); })) {
        break;
      }
    }
  }
  for (std::size_t p = 0; p < element.properties.size(); ++p) {
    const PlyProperty& property = element.properties[p];
    PlyTarget& target = plan.targets[p];
    if (target.kind == PlyTarget::Kind::Layer) continue;
    if (property.is_list) {
      target.kind = list_target(property, is_face, notes);
    } else if (!is_face && is_axis(property.name) && find_scalar(element, property.name) == p) {
      target = {PlyTarget::Kind::Position, 0, static_cast<std::size_t>(property.name[0] - 'x'), 1};
    } else {
      const bool is_category = is_face && is_integer(property.type);
      target = {PlyTarget::Kind::Layer, plan.layers.size(), 0, 1};
      plan.add({property.name,
                AttributeRole::Other,
                is_category ? Interpolation::Categorical : Interpolation::Linear,
                per,
                1,
                {},
                {}});
    }
  }
  return plan;
}

}  // namespace crease
