#include "render/layout.h"

#include <doctest/doctest.h>

#include <vector>

namespace crease {

namespace {

bool overlap(const PixelRect& a, const PixelRect& b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

}  // namespace

TEST_CASE("panels have one size, lie inside the picture and do not overlap") {
  for (std::size_t count = 1; count <= 13; ++count) {
    for (int columns = 0; columns <= 5; ++columns) {
      for (const double aspect : {0.3, 1.0, 3.0}) {
        CAPTURE(count);
        CAPTURE(columns);
        const Layout layout = make_layout({.panel_count = count,
                                           .width_px = 1001,
                                           .height_px = 701,
                                           .columns = columns,
                                           .content_aspect = aspect,
                                           .titles = true,
                                           .legend = true});
        REQUIRE(layout.views.size() == count);
        REQUIRE(layout.titles.size() == count);
        std::vector<PixelRect> all = layout.views;
        all.insert(all.end(), layout.titles.begin(), layout.titles.end());
        all.insert(all.end(), layout.separators.begin(), layout.separators.end());
        all.push_back(layout.legend);
        for (const PixelRect& view : layout.views) {
          CHECK(view.width == layout.views[0].width);
          CHECK(view.height == layout.views[0].height);
        }
        for (std::size_t i = 0; i < all.size(); ++i) {
          CHECK(all[i].x >= 0);
          CHECK(all[i].y >= 0);
          CHECK(all[i].x + all[i].width <= 1001);
          CHECK(all[i].y + all[i].height <= 701);
          CHECK(all[i].width > 0);
          CHECK(all[i].height > 0);
          for (std::size_t j = 0; j < i; ++j) CHECK(!overlap(all[i], all[j]));
        }
      }
    }
  }
}

TEST_CASE("columns that are asked for are given, up to the number of panels") {
  CHECK(make_layout({.panel_count = 5, .columns = 2}).columns == 2);
  CHECK(make_layout({.panel_count = 5, .columns = 2}).rows == 3);
  CHECK(make_layout({.panel_count = 3, .columns = 7}).columns == 3);
}

TEST_CASE("levels of one model stay together") {
  for (const double aspect : {0.3, 1.0, 2.0, 4.0}) {
    CAPTURE(aspect);
    const int columns =
        make_layout({.panel_count = 9, .group = 3, .content_aspect = aspect}).columns;
    CHECK((columns == 9 || columns == 6 || columns == 3 || columns == 1));
    // A single model's levels may stand in any grid.
    const int alone = make_layout({.panel_count = 4, .group = 4, .content_aspect = aspect}).columns;
    CHECK((alone == 4 || alone == 2 || alone == 1));
  }
  CHECK(make_layout({.panel_count = 9, .group = 3, .content_aspect = 1.0}).columns == 3);
}

TEST_CASE("tall things stand in a row, wide things one above the other") {
  CHECK(make_layout({.panel_count = 3, .content_aspect = 0.5}).columns == 3);
  CHECK(make_layout({.panel_count = 2, .content_aspect = 1.0}).columns == 2);
  CHECK(make_layout({.panel_count = 3, .content_aspect = 8.0}).columns == 1);
}

TEST_CASE("a picture without titles and colours to explain is all view") {
  const Layout layout = make_layout({.panel_count = 1, .width_px = 640, .height_px = 480});
  CHECK(layout.views[0].width == 640);
  CHECK(layout.views[0].height == 480);
  CHECK(layout.separators.empty());
  CHECK(layout.legend.height == 0);
}

}  // namespace crease
