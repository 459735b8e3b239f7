// What keys do: one table for the keyboard and for the help.
#pragma once

#include <optional>
#include <span>

namespace crease {

enum class Action {
  Help,
  Fit,
  Fly,
  NextMode,
  NextColoring,
  Wireframe,
  Creases,
  Occlusion,
  Freeze,
  Outside,
  Finer,
  Coarser,
  NextSplit,
  OtherHalf,
  Screenshot,
  Record,
  HidePanels,
  Leave,
  Quit,
};

struct KeyRow {
  Action action{};
  int code = 0, other_code = 0;  // GLFW's; the second one may be 0
  const char* keys = "";         // as the help names them
  const char* text = "";         // what they do
};
std::span<const KeyRow> key_rows();

std::optional<Action> action_of(int code);

// What the mouse does, for the help.
struct MouseRow {
  const char* how = "";
  const char* text = "";
};
std::span<const MouseRow> mouse_rows();

// While flying: right, above, forward, each -1, 0 or 1.
struct FlyKeys {
  int right, left, above, below, ahead, back, fast;
};
FlyKeys fly_keys();

}  // namespace crease
