// Where the panels of a picture lie.
#pragma once

#include <cstddef>
#include <vector>

namespace crease {

struct PixelRect {
  int x = 0, y = 0, width = 0, height = 0;  // from the upper left
};

struct Layout {
  int columns = 1, rows = 1;
  std::vector<PixelRect> titles;      // above each view; of height 0 when no panel has a title
  std::vector<PixelRect> views;       // one per panel
  std::vector<PixelRect> separators;  // thin lines between panels
  PixelRect legend;  // at the bottom, over the whole width; of height 0 without one
  int title_px = 0;  // size of letters
};

struct LayoutRequest {
  std::size_t panel_count = 1;
  int width_px = 1920, height_px = 1080;
  int columns = 0;            // 0: those that show the content largest
  int group = 1;              // so many one after the other belong together: a row has some of
                              // them, all in it, or a part of one
  double content_aspect = 1;  // width over height of what each panel shows
  bool titles = false, legend = false;
};

// All rects lie inside the picture, do not overlap, and all views have one size (else the same
// camera would show the same thing at two scales).
Layout make_layout(const LayoutRequest& request);

}  // namespace crease
