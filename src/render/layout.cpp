#include "render/layout.h"

#include <algorithm>
#include <cmath>

namespace crease {

namespace {

// Letters are a fixed share of the panel plus a little, so that they can be read in small pictures.
int letter_size(int cell_height) {
  return std::clamp(int(std::lround(9 + 0.018 * cell_height)), 10, 72);
}

Layout lay_out(const LayoutRequest& request, int columns) {
  Layout layout;
  const int count = int(request.panel_count);
  layout.columns = columns;
  layout.rows = (count + columns - 1) / columns;
  const int legend_px = letter_size(request.height_px);
  const int legend_height = request.legend ? std::min(legend_px * 2, request.height_px / 4) : 0;
  const int free_height = request.height_px - legend_height;
  layout.legend = {0, free_height, request.width_px, legend_height};

  const int gap = count > 1 ? std::max(1, request.height_px / 540) : 0;
  const int cell_width = (request.width_px - gap * (columns - 1)) / columns;
  const int cell_height = (free_height - gap * (layout.rows - 1)) / layout.rows;
  layout.title_px = letter_size(cell_height);
  const int title_height = request.titles ? std::min(layout.title_px * 2, cell_height / 3) : 0;

  for (int i = 0; i < count; ++i) {
    const int row = i / columns, column = i % columns;
    // The last row is centred when it is not full.
    const int in_row = std::min(columns, count - row * columns);
    const int indent = (request.width_px - in_row * cell_width - (in_row - 1) * gap) / 2;
    const int x = indent + column * (cell_width + gap), y = row * (cell_height + gap);
    if (column > 0) layout.separators.push_back({x - gap, y, gap, cell_height});
    if (row > 0 && column == 0) {
      layout.separators.push_back({0, y - gap, request.width_px, gap});
    }
    layout.titles.push_back({x, y, cell_width, title_height});
    layout.views.push_back({x, y + title_height, cell_width, cell_height - title_height});
  }
  return layout;
}

double shown_size(const Layout& layout, double content_aspect) {
  const PixelRect& view = layout.views.front();
  return std::min(view.width / content_aspect, double(view.height));
}

}  // namespace

Layout make_layout(const LayoutRequest& request) {
  const int count = int(request.panel_count);
  if (request.columns > 0) return lay_out(request, std::min(request.columns, count));
  Layout best = lay_out(request, count);
  for (int columns = count - 1; columns >= 1; --columns) {
    if (columns % request.group != 0 && request.group % columns != 0) continue;
    Layout other = lay_out(request, columns);
    // A row reads better than a grid: leave it only for a fifth more.
    const double bonus = best.rows == 1 ? 1.2 : 1.001;
    if (shown_size(other, request.content_aspect) >
        bonus * shown_size(best, request.content_aspect)) {
      best = std::move(other);
    }
  }
  return best;
}

}  // namespace crease
