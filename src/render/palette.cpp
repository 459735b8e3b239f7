#include "render/palette.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>
#include <string_view>

namespace crease {

namespace {

struct NamedColor {
  std::string_view word;  // found anywhere in the name, lower case; earlier rows win
  ColorSrgb color;
};

constexpr NamedColor kWords[] = {
    {"roof", {176, 101, 76}},    {"dach", {176, 101, 76}},     {"window", {104, 130, 152}},
    {"glass", {104, 130, 152}},  {"wall", {222, 211, 192}},    {"facade", {222, 211, 192}},
    {"wand", {222, 211, 192}},   {"ground", {164, 166, 158}},  {"road", {128, 130, 134}},
    {"street", {128, 130, 134}}, {"water", {112, 150, 180}},   {"tree", {112, 142, 88}},
    {"grass", {138, 160, 104}},  {"terrain", {160, 160, 128}}, {"wood", {168, 128, 88}},
    {"door", {130, 98, 74}},     {"stone", {186, 180, 170}},   {"brick", {170, 104, 84}},
    {"metal", {150, 158, 168}},  {"steel", {150, 158, 168}},   {"concrete", {184, 184, 180}},
};

// For names that say nothing: quiet, all about equally light.
constexpr ColorSrgb kQuiet[] = {
    {214, 208, 199}, {176, 192, 206}, {206, 186, 164}, {182, 200, 178},
    {206, 178, 176}, {190, 184, 206}, {212, 202, 160}, {170, 196, 196},
};

ColorSrgb blend(const ColorSrgb& a, const ColorSrgb& b, float t) {
  ColorSrgb c;
  for (std::size_t i = 0; i < 3; ++i) {
    c[i] = std::uint8_t(std::lround(float(a[i]) + t * (float(b[i]) - float(a[i]))));
  }
  return c;
}

ColorSrgb color_between(std::span<const ColorSrgb> stops, float share) {
  const float at = std::clamp(share, 0.0f, 1.0f) * float(stops.size() - 1);
  const std::size_t i = std::min(std::size_t(at), stops.size() - 2);
  return blend(stops[i], stops[i + 1], at - float(i));
}

ColorSrgb color_of_name(const std::string& name, std::size_t order) {
  std::string lower = name;
  for (char& c : lower) c = char(std::tolower(static_cast<unsigned char>(c)));
  for (const NamedColor& row : kWords) {
    if (lower.find(row.word) != std::string::npos) return row.color;
  }
  return kQuiet[order % std::size(kQuiet)];
}

}  // namespace

Color linear_from_srgb(const ColorSrgb& e) {
  return {linear_from_srgb(float(e[0]) / 255), linear_from_srgb(float(e[1]) / 255),
          linear_from_srgb(float(e[2]) / 255)};
}

ColorSrgb kind_color(TriangleKind kind) {
  switch (kind) {
    case TriangleKind::SN:
      return {66, 133, 214};
    case TriangleKind::FN:
      return {245, 190, 65};
    case TriangleKind::NSN:
      return {200, 40, 100};
  }
  return {};
}

const std::array<ColorSrgb, kLevelStopCount> kLevelStops{
    {{122, 209, 160}, {72, 172, 170}, {62, 122, 168}, {84, 84, 158}, {108, 50, 128}}};

ColorSrgb level_color(float share) {
  return color_between(kLevelStops, share);
}

const std::array<ColorSrgb, kErrorStopCount> kErrorStops{{{49, 80, 168},
                                                          {74, 140, 200},
                                                          {150, 205, 228},
                                                          {250, 243, 180},
                                                          {253, 184, 102},
                                                          {236, 98, 64},
                                                          {165, 0, 38}}};

ColorSrgb error_color(float share) {
  return color_between(kErrorStops, share);
}

bool have_names_only(std::span<const Material> materials) {
  return std::ranges::all_of(materials, [](const Material& m) {
    return m.base_color == std::array<float, 4>{1, 1, 1, 1} && m.base_color_texture.empty();
  });
}

std::vector<std::array<float, 4>> material_colors(std::span<const Material> materials) {
  const bool only_names = have_names_only(materials);
  std::vector<std::array<float, 4>> colors;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    if (!only_names) {
      colors.push_back(materials[i].base_color);
      continue;
    }
    const Color c = linear_from_srgb(color_of_name(materials[i].name, i));
    colors.push_back({c[0], c[1], c[2], 1});
  }
  return colors;
}

}  // namespace crease
