#include "io/read_mtl.h"

#include "io/read_beside.h"
#include "io/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <unordered_map>

namespace crease {

namespace {

// Two of the numbers that follow -s or -o; those that are left out stay.
void read_pair(Line& line, std::array<float, 2>& pair) {
  double x = 0;
  for (std::size_t k = 0; line.number(x); ++k) {
    if (k < pair.size() && std::isfinite(x)) pair[k] = static_cast<float>(x);
  }
}

// map_Kd may carry options before the name; the name is what follows them.
std::string texture_name(Line& line, TexturePlacement& placement) {
  while (true) {
    Line probe = line;
    const std::string_view option = probe.word();
    if (option.size() < 2 || option[0] != '-') break;
    const bool takes_word = option == "-blendu" || option == "-blendv" || option == "-clamp" ||
                            option == "-cc" || option == "-imfchan" || option == "-type" ||
                            option == "-colorspace";
    if (takes_word) {
      probe.word();
    } else if (option == "-s") {
      read_pair(probe, placement.scale);
    } else if (option == "-o") {
      read_pair(probe, placement.offset);
    } else {
      for (double unused; probe.number(unused);) {
      }
    }
    line = probe;
  }
  return std::string(line.rest());
}

std::string_view without_comment(std::string_view name) {
  name = name.substr(0, name.find(" #"));
  return name.substr(0, name.find_last_not_of(" \t") + 1);
}

// What a line says that no material here has; empty: nothing.
std::string lost_by(std::string_view word) {
  if (word == "bump" || word == "map_bump" || word == "map_Bump") return "'map_bump'";
  // Ambient light is nobody's but old programs', which name the texture of map_Kd again.
  const bool is_other_texture = (word.starts_with("map_") && word != "map_Ka") || word == "norm" ||
                                word == "disp" || word == "decal" || word == "refl";
  return is_other_texture ? in_quotes(word) : "";
}

float share(double x) {
  return std::isfinite(x) ? static_cast<float>(std::fmin(std::fmax(x, 0), 1)) : 1;
}

// One number stands for three.
bool read_color(Line& line, std::array<float, 4>& color) {
  double r, g, b;
  if (!line.number(r)) return false;
  g = b = r;
  if (line.number(g)) line.number(b);
  color = {share(r), share(g), share(b), color[3]};
  return true;
}

bool is_black(const std::array<float, 4>& color) {
  return color[0] == 0 && color[1] == 0 && color[2] == 0;
}

}  // namespace

void read_mtl(std::string_view text, const std::string& folder, std::span<Material> materials,
              std::span<TexturePlacement> placement_of_material, std::vector<bool>& is_known,
              Losses& losses) {
  std::unordered_map<std::string_view, Material*> by_name;
  for (Material& m : materials) by_name.emplace(m.name, &m);
  for (Material& m : materials) by_name.emplace(without_comment(m.name), &m);
  Material* current = nullptr;
  bool has_dissolve = false;   // of the current one
  bool tells_opacity = false;  // by d, or by a Tr that is not 1
  std::vector<Material*> of_tr;
  std::map<Material*, std::array<float, 4>> emission_of;
  std::set<std::string> lost;                                   // of the current one
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // a mark of UTF-8
  LineReader lines(text, true);
  for (Line line; lines.next(line);) {
    const std::string_view word = line.word();
    if (word == "newmtl") {
      const std::string_view name = line.rest();
      auto found = by_name.find(name);
      if (found == by_name.end()) found = by_name.find(without_comment(name));
      current = found == by_name.end() ? nullptr : found->second;
      has_dissolve = false;
      lost.clear();
      if (current) is_known[static_cast<std::size_t>(current - materials.data())] = true;
    } else if (current && word == "Kd") {
      read_color(line, current->base_color);
    } else if (current && word == "Ke") {
      std::array<float, 4> emission{};
      if (read_color(line, emission) && !is_black(emission)) emission_of[current] = emission;
    } else if (word == "d") {
      double x;
      if (!line.number(x)) continue;
      has_dissolve = tells_opacity = true;
      if (current) current->base_color[3] = share(x);
    } else if (word == "Tr" && !has_dissolve) {
      double x;
      if (!line.number(x)) continue;
      tells_opacity = tells_opacity || x != 1;
      if (!current) continue;
      current->base_color[3] = share(1 - x);
      of_tr.push_back(current);
    } else if (current && word == "map_Kd") {
      TexturePlacement& placement =
          placement_of_material[static_cast<std::size_t>(current - materials.data())] = {};
      const std::string name = with_slashes(texture_name(line, placement));
      current->base_color_texture =
          folder.empty() || name.empty()
              ? name
              : (std::filesystem::path(folder) / name).lexically_normal().generic_string();
    } else if (current) {
      const std::string what = lost_by(word);
      if (!what.empty()) losses.add(what, lost.insert(what).second);
    }
  }
  for (const auto& [material, emission] : emission_of) {
    // Black but for the light that it gives off, which is what one sees of it.
    const bool shows = is_black(material->base_color);
    losses.add("emission", !shows);
    if (!shows) continue;
    losses.add_shown_emission();
    std::copy_n(emission.begin(), 3, material->base_color.begin());
  }
  if (tells_opacity) return;
  for (Material* m : of_tr) m->base_color[3] = 1;
}

}  // namespace crease
