// What the colours of a picture mean, at its foot.
#pragma once

#include "crease/render.h"
#include "render/layout.h"

namespace crease {

struct LegendContent {
  Coloring coloring = Coloring::Shaded;
  bool has_sn = false, has_fn = false, has_nsn = false;  // Coloring::Kind: those that occur
  double error_full = 0;                                 // Coloring::Error: at the red end
  double error_max = 0;                                  // may be larger than that
  bool says_max = true;                                  // where it is larger
  std::string error_unit = "model units";
};

// Nothing for Coloring::Shaded.
void draw_legend(Image& image, const PixelRect& rect, const LegendContent& content);

}  // namespace crease
