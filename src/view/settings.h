// What the user can set, and what a frame says of itself.
#pragma once

#include "crease/viewer.h"

#include <cstddef>
#include <cstdint>
#include <limits>

namespace crease {

inline constexpr const char* kColoringNames[] = {"shaded", "kind", "level", "block", "error"};
inline constexpr const char* kCutNames[] = {"by block", "by vertex in blocks", "by vertex",
                                            "linear"};
inline constexpr int kCutCount = 4;
inline constexpr const char* kSplitNames[] = {"one picture", "beside the original", "two settings"};

struct ViewSettings {
  ViewMode mode = ViewMode::Blocks;
  ViewColoring coloring = ViewColoring::Shaded;
  bool wireframe = false;
  bool creases = false;  // hard edges and borders as lines
  bool ambient_occlusion = false;
  double pixels = 1;   // error on the screen
  double degrees = 0;  // of shading; 0: any
  std::size_t max_triangles = std::numeric_limits<std::size_t>::max();
  std::size_t max_bytes = std::size_t(512) << 20;  // of resident blocks
  bool vertices_in_blocks = false;                 // by block: refined by vertex inside them
  // As fine as there is, within max_bytes; `pixels` is for colours alone.
  bool is_original = false;

  // Mode and vertices_in_blocks as one, as kCutNames has them.
  int cut() const { return mode == ViewMode::Blocks ? int(vertices_in_blocks) : 1 + int(mode); }
  void set_cut(int cut) {
    vertices_in_blocks = cut == 1;
    mode = cut < 2 ? ViewMode::Blocks : ViewMode(cut - 1);
  }

  double wanted_pixels() const { return is_original ? 1e-9 : pixels; }
  double geomorph_seconds = 0.25;  // by vertex and linear; 0: none

  bool operator==(const ViewSettings&) const = default;
};

// The picture's halves. The right one is the original, or has settings of its own.
struct SplitSettings {
  ViewSplit kind = ViewSplit::Off;
  double divider = 0.5;      // share of the width that the left half has
  bool edits_right = false;  // what panels and keys change; with ViewSplit::Settings
  ViewSettings right;

  bool operator==(const SplitSettings&) const = default;
};

// What both halves have together.
struct StreamSettings {
  double max_bytes_per_second = std::numeric_limits<double>::infinity();  // infinity: no limit
};

struct FrameFacts {
  std::size_t triangles = 0;
  double error_pixels = 0;         // of what is shown, at its worst
  std::size_t uploaded_bytes = 0;  // to the GPU, for this frame
  std::size_t gpu_bytes = 0;
  std::size_t resident_bytes = 0;
  std::size_t pending_bytes = 0;  // asked for, not decoded yet
  double bytes_per_second = 0;    // that have streamed, over the last second
  std::size_t blocks = 0;         // resident; 0 where there are none
  std::size_t draw_calls = 0;
  bool has_changed = false;  // since the last frame
  bool is_complete = false;  // all that the view wants is shown, and nothing is on its way to it
  bool is_moving = false;    // something is on its way
};

}  // namespace crease
