#include "view/panels.h"

#include "view/words.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace crease {

namespace {

constexpr ImGuiWindowFlags kFixed =
    ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
    ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNavFocus;
constexpr ImGuiWindowFlags kPlain = kFixed | ImGuiWindowFlags_NoTitleBar;
constexpr ImGuiWindowFlags kSeenThrough = kPlain | ImGuiWindowFlags_NoInputs;

constexpr float kMargin = 12;

float line_px() {
  return ImGui::GetFontSize();
}

ImVec2 screen() {
  return ImGui::GetIO().DisplaySize;
}

void text(const std::string& line) {
  ImGui::TextUnformatted(line.c_str());
}

void faint(const std::string& line) {
  ImGui::TextDisabled("%s", line.c_str());
}

void name_and_value(const std::string& name, const std::string& value, float column_px) {
  faint(name);
  ImGui::SameLine(column_px);
  text(value);
}

void slider_above(const char* name) {
  faint(name);
  ImGui::SetNextItemWidth(-1);
}

void pixels_slider(double& pixels) {
  constexpr double kLow = 0.1, kHigh = 64;
  slider_above("error on the screen");
  ImGui::SliderScalar("##pixels", ImGuiDataType_Double, &pixels, &kLow, &kHigh, "%.2f pixels",
                      ImGuiSliderFlags_Logarithmic);
}

void degrees_slider(double& degrees) {
  constexpr double kLow = 0, kHigh = 45;
  slider_above("error of shading");
  ImGui::SliderScalar("##degrees", ImGuiDataType_Double, &degrees, &kLow, &kHigh,
                      degrees > 0 ? "%.1f degrees" : "any");
}

void geomorph_slider(double& seconds) {
  constexpr double kLow = 0, kHigh = 2;
  slider_above("geomorphs");
  ImGui::SliderScalar("##geomorphs", ImGuiDataType_Double, &seconds, &kLow, &kHigh,
                      seconds > 0 ? "%.2f seconds" : "none");
}

// The right end means no limit.
void budget_slider(const char* label, const char* id, std::size_t& value, ImU64 unit, ImU64 low,
                   ImU64 high, const char* format) {
  ImU64 units = std::min<ImU64>(value / unit, high);
  const std::string exact = grouped(value);  // less than the slider can say
  const char* shown = units >= high ? "no limit" : units < low ? exact.c_str() : format;
  slider_above(label);
  if (ImGui::SliderScalar(id, ImGuiDataType_U64, &units, &low, &high, shown,
                          ImGuiSliderFlags_Logarithmic)) {
    value = units >= high ? std::numeric_limits<std::size_t>::max() : std::size_t(units * unit);
  }
}

// In kB a second; the right end means no limit.
void bandwidth_slider(double& max_bytes_per_second) {
  constexpr double kLow = 10, kHigh = 100'000;
  double kb = std::min(max_bytes_per_second / 1e3, kHigh);
  slider_above("bandwidth");
  if (ImGui::SliderScalar("##bandwidth", ImGuiDataType_Double, &kb, &kLow, &kHigh,
                          kb >= kHigh ? "no limit" : "%.0f kB/s", ImGuiSliderFlags_Logarithmic)) {
    max_bytes_per_second = kb >= kHigh ? std::numeric_limits<double>::infinity() : kb * 1e3;
  }
}

template <typename Value, std::size_t N>
void choice(const char* label, const char* id, Value& value, const char* const (&names)[N]) {
  int chosen = int(value);
  slider_above(label);
  if (ImGui::Combo(id, &chosen, names, int(N))) value = Value(chosen);
}

void button(const char* label, Action action, bool is_on, std::vector<Action>& pressed) {
  if (is_on) ImGui::PushStyleColor(ImGuiCol_Button, ImVec4{0.52f, 0.72f, 0.96f, 1});
  if (ImGui::Button(label)) pressed.push_back(action);
  if (is_on) ImGui::PopStyleColor();
}

void buttons(const Switches& switches, std::vector<Action>& pressed) {
  button("Fit", Action::Fit, false, pressed);
  ImGui::SameLine();
  button("Fly", Action::Fly, switches.is_flying, pressed);
  ImGui::SameLine();
  button("Freeze", Action::Freeze, switches.is_frozen, pressed);
  ImGui::SameLine();
  button("Outside", Action::Outside, false, pressed);
  button("Picture", Action::Screenshot, false, pressed);
  ImGui::SameLine();
  button("Record", Action::Record, switches.is_recording, pressed);
  ImGui::SameLine();
  button("Help", Action::Help, switches.shows_help, pressed);
}

void split_controls(SplitSettings& split) {
  choice("split", "##split", split.kind, kSplitNames);
  if (split.kind != ViewSplit::Settings) return;
  int half = split.edits_right ? 1 : 0;
  ImGui::RadioButton("left half", &half, 0);
  ImGui::SameLine();
  ImGui::RadioButton("right half", &half, 1);
  split.edits_right = half == 1;
}

void settings_panel(const PanelContent& content, ViewSettings& settings, SplitSettings& split,
                    StreamSettings& stream, std::vector<Action>& pressed) {
  ImGui::SetNextWindowPos({kMargin, kMargin});
  const float most = std::max(10 * line_px(), screen().y - 2 * kMargin);  // scrolls in a low window
  ImGui::SetNextWindowSizeConstraints({18 * line_px(), 0}, {18 * line_px(), most});
  ImGui::Begin("settings", nullptr, kPlain);
  if (content.source != nullptr) {
    text(content.source->name);
    ImGui::PushTextWrapPos(0);
    faint(grouped(content.model->triangle_count) + " triangles, " +
          in_bytes(content.source->bytes) + (content.source->built ? " (built just now)" : ""));
    ImGui::PopTextWrapPos();
    ImGui::Separator();
    const float column = 9 * line_px();
    name_and_value("shown", grouped(content.frame.triangles), column);
    name_and_value("read", in_bytes(content.bytes_read), column);
    name_and_value("blocks, calls",
                   grouped(content.frame.blocks) + ", " + grouped(content.frame.draw_calls),
                   column);
    name_and_value("on the GPU", in_bytes(content.frame.gpu_bytes), column);
    ImGui::Separator();
  }
  split_controls(split);
  int cut = settings.cut();
  choice("cut", "##cut", cut, kCutNames);
  settings.set_cut(cut);
  choice("colours", "##coloring", settings.coloring, kColoringNames);
  ImGui::Checkbox("wireframe", &settings.wireframe);
  ImGui::SameLine();
  ImGui::Checkbox("creases", &settings.creases);
  ImGui::Checkbox("ambient occlusion", &settings.ambient_occlusion);
  pixels_slider(settings.pixels);
  degrees_slider(settings.degrees);
  budget_slider("triangles", "##triangles", settings.max_triangles, 1000, 10, 100'000,
                "%llu thousand");
  if (settings.mode == ViewMode::Blocks) {
    budget_slider("memory", "##memory", settings.max_bytes, ImU64(1) << 20, 8, 16'384, "%llu MiB");
  } else {
    geomorph_slider(settings.geomorph_seconds);
  }
  bandwidth_slider(stream.max_bytes_per_second);
  buttons(content.switches, pressed);
  ImGui::End();
}

// `limit`: a line across, and the graph reaches up to it; infinity: none.
void graph(const Histories& histories, Series series, const char* name, const char* format,
           double limit = std::numeric_limits<double>::infinity()) {
  const Histories::View view = histories.of(series);
  const float highest = std::isfinite(limit) ? std::max(view.largest, float(limit)) : view.largest;
  const float top = std::max(highest * 1.05f, 1e-6f);
  char value[64];
  std::snprintf(value, sizeof value, format, double(view.last));
  faint(name);
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(value).x);
  text(value);
  ImGui::PushID(name);
  ImGui::PlotLines("", view.values.data(), int(view.values.size()), int(view.oldest), nullptr, 0,
                   top, {ImGui::GetContentRegionAvail().x, 2.4f * line_px()});
  if (std::isfinite(limit)) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const float padding = ImGui::GetStyle().FramePadding.y;
    const float y = high.y - padding - float(limit) / top * (high.y - low.y - 2 * padding);
    ImGui::GetWindowDrawList()->AddLine({low.x, y}, {high.x, y}, IM_COL32(214, 72, 20, 255));
  }
  ImGui::PopID();
}

void graphs_panel(const Histories& histories, const StreamSettings& stream) {
  const float width = 15 * line_px();
  if (screen().x < 3 * width) return;  // there is no room beside the settings
  ImGui::SetNextWindowPos({screen().x - kMargin, kMargin}, 0, {1, 0});
  ImGui::SetNextWindowSizeConstraints({width, 0}, {width, 4000});
  ImGui::Begin("graphs", nullptr, kPlain);
  graph(histories, Series::FrameMs, "frame", "%.1f ms");
  graph(histories, Series::UploadKb, "upload", "%.0f kB");
  graph(histories, Series::ResidentMb, "resident", "%.1f MB");
  graph(histories, Series::PendingKb, "pending", "%.0f kB");
  graph(histories, Series::StreamedKb, "streaming", "%.0f kB/s", stream.max_bytes_per_second / 1e3);
  graph(histories, Series::ErrorPixels, "error on the screen", "%.2f px");
  ImGui::End();
}

void picked_panel(const Lines& lines) {
  if (lines.empty()) return;
  ImGui::SetNextWindowPos({screen().x - kMargin, screen().y - kMargin}, 0, {1, 1});
  ImGui::Begin("picked", nullptr, kPlain);
  for (const auto& [name, value] : lines) name_and_value(name, value, 6 * line_px());
  ImGui::End();
}

// At the foot of the window; in its middle where there is nothing else to see.
void message_panel(const PanelContent& content) {
  const bool is_alone = content.frame.triangles == 0;
  if (!content.message && content.notice.empty() && content.source != nullptr) return;
  const float foot =
      content.halves.empty() ? kMargin : kMargin + 3 * line_px();  // labels are below
  ImGui::SetNextWindowPos({screen().x / 2, is_alone ? screen().y / 2 : screen().y - foot}, 0,
                          {0.5f, is_alone ? 0.5f : 1});
  ImGui::Begin("message", nullptr, kSeenThrough);
  ImGui::PushTextWrapPos(std::max(20 * line_px(), screen().x - 6 * line_px()));
  if (content.message) {
    const Message& message = *content.message;
    if (message.is_failure) ImGui::PushStyleColor(ImGuiCol_Text, ImVec4{0.68f, 0.08f, 0.08f, 1});
    text(message.text);
    if (message.is_failure) ImGui::PopStyleColor();
    if (message.share >= 0) {
      ImGui::ProgressBar(float(std::min(1.0, message.share)), {24 * line_px(), 0});
    }
  } else if (!content.notice.empty()) {
    text(content.notice);
  } else {
    text("Drop a model here: .crease, OBJ, PLY, STL, OFF, glTF, GLB, CityJSON");
  }
  ImGui::PopTextWrapPos();
  ImGui::End();
}

void half_panels(std::span<const HalfLabel> halves) {
  for (const HalfLabel& half : halves) {
    const float x = half.divider * screen().x + (half.is_right ? kMargin : -kMargin);
    ImGui::SetNextWindowPos({x, screen().y - kMargin}, 0, {half.is_right ? 0.0f : 1.0f, 1});
    ImGui::Begin(half.is_right ? "right half" : "left half", nullptr, kSeenThrough);
    half.is_edited ? text(half.text) : faint(half.text);
    ImGui::End();
  }
}

void help_panel() {
  ImGui::SetNextWindowPos({screen().x / 2, screen().y / 2}, 0, {0.5f, 0.5f});
  ImGui::Begin("help", nullptr, kSeenThrough);
  for (const MouseRow& row : mouse_rows()) name_and_value(row.how, row.text, 14 * line_px());
  ImGui::Separator();
  for (const KeyRow& row : key_rows()) name_and_value(row.keys, row.text, 14 * line_px());
  ImGui::End();
}

void switches_panel(const Switches& switches) {
  std::string line;
  const auto add = [&](bool is_on, const char* words) {
    if (is_on) line += (line.empty() ? "" : "   ") + std::string(words);
  };
  add(switches.is_flying, "flying: Esc ends");
  add(switches.is_frozen, "frozen: Z goes on");
  add(switches.is_recording, "recording: R ends");
  if (line.empty()) return;
  ImGui::SetNextWindowPos({screen().x / 2, kMargin}, 0, {0.5f, 0});
  ImGui::Begin("switches", nullptr, kSeenThrough);
  text(line);
  ImGui::End();
}

}  // namespace

std::vector<Action> draw_panels(const PanelContent& content, ViewSettings& settings,
                                SplitSettings& split, StreamSettings& stream) {
  std::vector<Action> pressed;
  if (content.switches.shows_panels) {
    settings_panel(content, settings, split, stream, pressed);
    half_panels(content.halves);
    graphs_panel(*content.histories, stream);
    picked_panel(content.picked);
    switches_panel(content.switches);
  }
  message_panel(content);  // what went wrong is told in any case
  if (content.switches.shows_help) help_panel();
  return pressed;
}

}  // namespace crease
