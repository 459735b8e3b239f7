#include "view/gui.h"

#include "render/text.h"

#include <imgui.h>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>

namespace crease {

namespace {

constexpr float kFontPx = 15;

void set_style(float scale) {
  ImGui::StyleColorsLight();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 6;
  style.FrameRounding = 4;
  style.GrabRounding = 4;
  style.WindowBorderSize = 0;
  style.FrameBorderSize = 0;
  style.WindowPadding = {12, 10};
  style.ItemSpacing = {8, 6};
  style.Colors[ImGuiCol_WindowBg] = {1, 1, 1, 0.94f};
  style.Colors[ImGuiCol_Text] = {0.15f, 0.17f, 0.20f, 1};
  style.Colors[ImGuiCol_TextDisabled] = {0.42f, 0.46f, 0.52f, 1};
  style.Colors[ImGuiCol_FrameBg] = {0.90f, 0.92f, 0.95f, 1};
  style.Colors[ImGuiCol_PlotLines] = {0.20f, 0.40f, 0.66f, 1};
  style.Colors[ImGuiCol_PlotHistogram] = {0.26f, 0.52f, 0.84f, 1};
  style.Colors[ImGuiCol_Button] = {0.86f, 0.89f, 0.94f, 1};
  style.ScaleAllSizes(scale);
}

}  // namespace

Gui::Gui(const ViewerWindow& window) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // panels are where they are
  io.ConfigFlags |= ImGuiConfigFlags_NoMouseCursorChange;
  const float scale = float(window.scale());
  ImFontConfig config;
  config.FontDataOwnedByAtlas = false;
  const std::span<const unsigned char> font = font_bytes();
  io.Fonts->AddFontFromMemoryTTF(const_cast<unsigned char*>(font.data()), int(font.size()),
                                 kFontPx * scale, &config);
  set_style(scale);
  ImGui_ImplGlfw_InitForOpenGL(window.handle(), true);
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

Gui::~Gui() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void Gui::begin() {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
}

void Gui::draw() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

bool Gui::wants_mouse() const {
  return ImGui::GetIO().WantCaptureMouse;
}

bool Gui::wants_keys() const {
  return ImGui::GetIO().WantTextInput;
}

}  // namespace crease
