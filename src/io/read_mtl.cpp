#include "io/read_mtl.h"

#include "io/text.h"

#include <cmath>
#include <filesystem>
#include <string>
#include <unordered_map>

namespace crease {

namespace {

// map_Kd may carry options before the name; the name is what follows them.
std::string texture_name(Line& line) {
  while (true) {
    Line probe = line;
    const std::string_view option = probe.word();
    if (option.size() < 2 || option[0] != '-') break;
    const bool takes_word = option == "-blendu" || option == "-blendv" || option == "-clamp" ||
                            option == "-cc" || option == "-imfchan" || option == "-type";
    if (takes_word) {
      probe.word();
    } else {
      for (double unused; probe.number(unused);) {
      }
    }
    line = probe;
  }
  return std::string(line.rest());
}

float share(double x) {
  return std::isfinite(x) ? static_cast<float>(std::fmin(std::fmax(x, 0), 1)) : 1;
}

}  // namespace

void read_mtl(std::string_view text, const std::string& folder, std::span<Material> materials) {
  std::unordered_map<std::string_view, Material*> by_name;
  for (Material& m : materials) by_name.emplace(m.name, &m);
  Material* current = nullptr;
  LineReader lines(text, true);
  for (Line line; lines.next(line);) {
    const std::string_view word = line.word();
    if (word == "newmtl") {
      const auto found = by_name.find(line.rest());
      current = found == by_name.end() ? nullptr : found->second;
    } else if (current && word == "Kd") {
      double r, g, b;
      if (!line.number(r)) continue;
      g = b = r;  // one number stands for three
      if (line.number(g)) line.number(b);
      current->base_color = {share(r), share(g), share(b), current->base_color[3]};
    } else if (current && (word == "d" || word == "Tr")) {
      if (double x; line.number(x)) current->base_color[3] = share(word == "d" ? x : 1 - x);
    } else if (current && word == "map_Kd") {
      const std::string name = texture_name(line);
      current->base_color_texture =
          folder.empty() || name.empty()
              ? name
              : (std::filesystem::path(folder) / name).lexically_normal().generic_string();
    }
  }
}

}  // namespace crease
