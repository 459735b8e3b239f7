// What lies over the picture: settings, numbers, graphs, what was picked, messages, help.
#pragma once

#include "view/histories.h"
#include "view/keys.h"
#include "view/session.h"
#include "view/settings.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace crease {

// What is on and what is off.
struct Switches {
  bool is_flying = false;
  bool is_frozen = false;
  bool is_recording = false;
  bool shows_help = false;
  bool shows_panels = true;
};

using Lines = std::vector<std::pair<std::string, std::string>>;  // name and value

// What a half of the picture says of itself, at its lower end beside the divider.
struct HalfLabel {
  std::string text;
  float divider = 0;  // share of the width where the half ends, or begins
  bool is_right = false, is_edited = false;
};

struct PanelContent {
  const ModelSource* source = nullptr;  // null: nothing is open
  const ModelFacts* model = nullptr;
  std::uint64_t bytes_read = 0;
  FrameFacts frame;
  const Histories* histories = nullptr;
  Lines picked;                      // empty: nothing
  std::optional<Message> message{};  // of the session
  std::string notice;                // what was just done; or empty
  std::vector<HalfLabel> halves{};   // empty: one picture
  Switches switches;
};

// Between Gui::begin() and Gui::draw(). Changes what the user moves; returns the buttons that were
// pressed.
std::vector<Action> draw_panels(const PanelContent& content, ViewSettings& settings,
                                SplitSettings& split, StreamSettings& stream);

}  // namespace crease
