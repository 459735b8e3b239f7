#include "io/ply_names.h"

#include "io/text.h"

#include <algorithm>
#include <array>
#include <utility>

namespace crease {

namespace {

constexpr std::string_view kMaterial = "material", kColor = "material_color",
                           kTexture = "material_texture", kTextureFile = "TextureFile",
                           kPart = "part", kLayer = "layer";

constexpr std::array<std::pair<AttributeRole, std::string_view>, 3> kRoles{
    {{AttributeRole::TexCoord, "texcoord"},
     {AttributeRole::Color, "color"},
     {AttributeRole::Other, "other"}}};
constexpr std::array<std::pair<Interpolation, std::string_view>, 3> kInterpolations{
    {{Interpolation::Direction, "direction"},
     {Interpolation::Linear, "linear"},
     {Interpolation::Categorical, "categorical"}}};

template <typename Words, typename Value>
std::string_view word_for(const Words& words, Value value) {
  for (const auto& [known, word] : words) {
    if (known == value) return word;
  }
  return {};
}
template <typename Words, typename Value>
bool read_word(const Words& words, std::string_view word, Value& value) {
  for (const auto& [known, name] : words) {
    if (name != word) continue;
    value = known;
    return true;
  }
  return false;
}

// `text` in one line.
void write_comment(ByteSink& out, std::string_view word, std::string_view text) {
  out.text("comment ");
  out.text(word);
  out.text(" ");
  std::string line(text);
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  out.text(line);
  out.text("\n");
}

void write_comment(ByteSink& out, std::string_view word, std::size_t index, std::string_view text) {
  write_comment(out, word, std::to_string(index) + " " + std::string(text));
}

std::string in_digits(const std::array<float, 4>& numbers) {
  ByteSink digits;
  for (const float x : numbers) {
    digits.number(x);
    digits.text(" ");
  }
  const std::vector<std::byte> bytes = digits.take();
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size() - 1};
}

// Calls `take(line)` for what stands behind the word in each comment that begins with it.
template <typename Take>
void for_each(std::span<const std::string> comments, std::string_view word, Take take) {
  for (const std::string& comment : comments) {
    Line line{comment.data(), comment.data() + comment.size(), 0};
    if (line.word() == word) take(line);
  }
}

std::vector<std::string> names_in(std::span<const std::string> comments, std::string_view word) {
  std::vector<std::string> names;
  for_each(comments, word, [&](Line& line) {
    std::int64_t index = 0;
    if (line.integer(index) && index == std::ssize(names)) names.emplace_back(line.rest());
  });
  return names;
}

// The one that the line begins with the number of, or null.
Material* numbered(Line& line, std::vector<Material>& materials) {
  std::int64_t index = 0;
  if (!line.integer(index) || index < 0 || index >= std::ssize(materials)) return nullptr;
  return &materials[static_cast<std::size_t>(index)];
}

}  // namespace

void write_layer_comment(ByteSink& out, const PlyNamedLayer& layer) {
  std::string text = layer.element + " " + layer.property + " " + std::to_string(layer.dimension);
  for (const std::string_view word :
       {word_for(kRoles, layer.role), word_for(kInterpolations, layer.interpolation)}) {
    text += " ";
    text += word;
  }
  write_comment(out, kLayer, text + " " + layer.name);
}

std::vector<PlyNamedLayer> layers_in(std::span<const std::string> comments) {
  std::vector<PlyNamedLayer> layers;
  for_each(comments, kLayer, [&](Line& line) {
    PlyNamedLayer layer;
    std::int64_t dimension = 0;
    layer.element = line.word();
    layer.property = line.word();
    if (!line.integer(dimension) || dimension < 1 || dimension > 4) return;
    layer.dimension = static_cast<std::uint32_t>(dimension);
    if (!read_word(kRoles, line.word(), layer.role)) return;
    if (!read_word(kInterpolations, line.word(), layer.interpolation)) return;
    layer.name = line.rest();
    layers.push_back(std::move(layer));
  });
  return layers;
}

PlyTextures::PlyTextures(std::span<const Material> materials) {
  for (const Material& material : materials) {
    const std::string_view name = material.base_color_texture;
    const auto found = std::find(names.begin(), names.end(), name);
    of_material.push_back(name.empty() ? -1 : static_cast<std::int32_t>(found - names.begin()));
    if (!name.empty() && found == names.end()) names.push_back(name);
  }
}

bool PlyTextures::need_numbers() const {
  return std::ranges::any_of(of_material,
                             [&](std::int32_t texture) { return texture != of_material[0]; });
}

void write_material_comments(ByteSink& out, std::span<const Material> materials,
                             const PlyTextures& textures) {
  for (std::size_t m = 0; m < materials.size(); ++m) {
    const Material& material = materials[m];
    write_comment(out, kMaterial, m, material.name);
    if (material.base_color != Material{}.base_color) {
      write_comment(out, kColor, m, in_digits(material.base_color));
    }
    if (!material.base_color_texture.empty()) {
      write_comment(out, kTexture, m, material.base_color_texture);
    }
  }
  for (const std::string_view name : textures.names) write_comment(out, kTextureFile, name);
}

void write_part_comments(ByteSink& out, std::span<const std::string> parts) {
  for (std::size_t p = 0; p < parts.size(); ++p) write_comment(out, kPart, p, parts[p]);
}

void write_up_comment(ByteSink& out, UpAxis up) {
  if (up != UpAxis::Unknown) out.text(up == UpAxis::Y ? "comment up y\n" : "comment up z\n");
}

UpAxis up_in(std::span<const std::string> comments) {
  UpAxis up = UpAxis::Unknown;
  for_each(comments, "up", [&](Line& line) {
    const std::string_view axis = line.rest();
    if (axis == "y" || axis == "z") up = axis == "y" ? UpAxis::Y : UpAxis::Z;
  });
  return up;
}

std::vector<Material> materials_in(std::span<const std::string> comments) {
  std::vector<Material> materials;
  for (std::string& name : names_in(comments, kMaterial)) {
    materials.push_back({std::move(name), {1, 1, 1, 1}, {}});
  }
  for_each(comments, kColor, [&](Line& line) {
    Material* const material = numbered(line, materials);
    std::array<double, 4> color{};
    for (double& c : color) {
      if (!line.number(c) || !(c >= 0 && c < 1e30)) return;
    }
    if (material == nullptr) return;
    std::ranges::transform(color, material->base_color.begin(),
                           [](double c) { return static_cast<float>(c); });
  });
  for_each(comments, kTexture, [&](Line& line) {
    Material* const material = numbered(line, materials);
    if (material != nullptr) material->base_color_texture = line.rest();
  });
  return materials;
}

std::vector<std::string> parts_in(std::span<const std::string> comments) {
  return names_in(comments, kPart);
}

std::vector<Material> textures_in(std::span<const std::string> comments) {
  std::vector<Material> materials;
  for_each(comments, kTextureFile, [&](Line& line) {
    const std::string name(line.rest());
    materials.push_back({name, {1, 1, 1, 1}, name});
  });
  return materials;
}

}  // namespace crease
