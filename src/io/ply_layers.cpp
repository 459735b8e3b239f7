#include "io/ply_layers.h"

#include "io/ply_names.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>
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

bool is_index_list(const PlyProperty& property) {
  return property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index");
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

// Integers without signs have 0 in their middle. How long a normal is does not matter.
double normal_zero(PlyType type) {
  if (type == PlyType::Uint8) return 127.5;
  return type == PlyType::Uint16 ? 32767.5 : 0;
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
  for (std::size_t c = 0; c < found.size(); ++c) {
    const PlyType type = element.properties[found[c]].type;
    PlyTarget& target = to.targets[found[c]];
    target = {PlyTarget::Kind::Layer, to.layers.size(), c};
    if (layer.role == AttributeRole::Color) target.scale = color_scale(type);
    if (layer.role == AttributeRole::Normal) target.zero = normal_zero(type);
  }
  to.add(std::move(layer));
  return true;
}

constexpr std::string_view kCategoryWords[] = {
    "id",     "label",    "labels",   "class",   "classification", "category",
    "object", "instance", "material", "part",    "segment",        "segmentation",
    "region", "cluster",  "group",    "semantic"};

// In words that are apart by what is no letter, or by the case: class, material_id, scalar_Label,
// objectId.
bool names_category(std::string_view name) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto is_upper = [](char c) { return c >= 'A' && c <= 'Z'; };
  for (std::size_t i = 0; i < name.size();) {
    std::string word;
    for (; i < name.size() && is_letter(name[i]); ++i) {
      const bool is_new = i > 0 && is_upper(name[i]) && !is_upper(name[i - 1]);
      if (is_new && !word.empty()) break;
      word += static_cast<char>(is_upper(name[i]) ? name[i] - 'A' + 'a' : name[i]);
    }
    if (std::ranges::find(kCategoryWords, word) != std::end(kCategoryWords)) return true;
    if (i < name.size() && !is_letter(name[i])) ++i;
  }
  return false;
}

// A category has at least so many vertices on average; else the numbers tell vertices apart.
constexpr std::size_t kVerticesOfCategory = 4;

PlyTarget::Kind list_target(const PlyProperty& property, bool is_face,
                            std::vector<std::string>& notes) {
  if (is_face && is_index_list(property)) return PlyTarget::Kind::Indices;
  if (is_face && property.name == "texcoord") return PlyTarget::Kind::CornerTexCoords;
  notes.push_back("list '" + property.name + "' ignored");
  return PlyTarget::Kind::Ignored;
}

bool makes_sense(const PlyNamedLayer& named) {
  switch (named.role) {
    case AttributeRole::TexCoord:
      return named.dimension == 2 && named.interpolation == Interpolation::Linear;
    case AttributeRole::Color:
      return named.dimension >= 3 && named.interpolation == Interpolation::Linear;
    case AttributeRole::Normal:
      return false;
    case AttributeRole::Other:
      break;
  }
  return named.interpolation != Interpolation::Direction || named.dimension == 3;
}

// What a comment names, if the element has all of it.
void take_named(const PlyElement& element, const PlyNamedLayer& named, RawLayer::Per per,
                PlyLayers& to) {
  const std::optional<std::size_t> first = find_scalar(element, named.property);
  if (!first || named.dimension > element.properties.size() - *first) return;
  for (std::size_t p = *first; p < *first + named.dimension; ++p) {
    const PlyProperty& property = element.properties[p];
    if (property.is_list || to.targets[p].kind == PlyTarget::Kind::Layer) return;
    if (per == RawLayer::Per::Vertex && is_axis(property.name)) return;
  }
  for (std::size_t c = 0; c < named.dimension; ++c) {
    to.targets[*first + c] = {PlyTarget::Kind::Layer, to.layers.size(), c};
  }
  to.add({named.name, named.role, named.interpolation, per, named.dimension, {}, {}}, true);
}

}  // namespace

PlyLayers plan_layers(const PlyElement& element, RawLayer::Per per,
                      std::span<const std::string> comments, std::vector<std::string>& notes) {
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
  for (const PlyNamedLayer& named : layers_in(comments)) {
    if (named.element == element.name && makes_sense(named)) take_named(element, named, per, plan);
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
      const bool is_category = is_face ? is_integer(property.type) : names_category(property.name);
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
  for (std::size_t p = 0; p < plan.targets.size(); ++p) {
    plan.targets[p].is_float = element.properties[p].type == PlyType::Float32;
  }
  return plan;
}

void scale_float_colors(RawLayer& layer, std::vector<std::string>& notes) {
  if (layer.role != AttributeRole::Color) return;
  const bool bytes = std::any_of(layer.values.begin(), layer.values.end(),
                                 [](float c) { return c > 1.5f && c <= 255.0f; });
  if (!bytes) return;
  for (float& c : layer.values) c /= 255.0f;
  notes.push_back("colours divided by 255");
}

void settle_categories(RawLayer& layer, std::vector<std::string>& notes) {
  if (layer.interpolation != Interpolation::Categorical) return;
  std::vector<float> values = layer.values;
  std::erase_if(values, [](float x) { return !std::isfinite(x); });  // they become 0
  if (std::ranges::any_of(values, [](float x) { return x != std::floor(x); })) {
    layer.interpolation = Interpolation::Linear;
    return;
  }
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  const std::size_t count = values.size();
  if (kVerticesOfCategory * count > layer.values.size()) {
    layer.interpolation = Interpolation::Linear;
  } else {
    notes.push_back("'" + layer.name + "' of the vertices has " + std::to_string(count) +
                    " values, which are taken as categories: never blended");
  }
}

}  // namespace crease
