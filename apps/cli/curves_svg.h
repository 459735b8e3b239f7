// Curves as inline SVG, on logarithmic axes: no script, no file, colours from the page's style.
//
//   Plot plot{.x = {"triangles"}, .y = {"distance", "model units"}, .curves = {...}};
//   page += curves_svg(plot);
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace crease::cli {

struct Curve {
  std::string name;
  int color = 0;           // 0 to 2: the page's style has .curve0 to .curve2
  bool is_dashed = false;  // and without marks
  std::vector<std::pair<double, double>>
      points;  // left out: x of 0, and y of 0 or next to nothing beside the plot's largest
};

struct Axis {
  std::string name, unit;  // unit: may be empty
  bool is_bytes = false;   // ticks as kB and MB
};

struct Plot {
  std::string title;
  Axis x, y;
  std::vector<Curve> curves;
};

// One <figure> with a legend; a plot without points says so instead. Well-formed XML.
std::string curves_svg(const Plot& plot);

// For text and attribute values of HTML and XML; what neither can hold becomes U+FFFD.
std::string escaped(const std::string& text);

}  // namespace crease::cli
