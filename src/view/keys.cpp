#include "view/keys.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace crease {

namespace {

constexpr KeyRow kRows[] = {
    {Action::Help, GLFW_KEY_F1, 0, "F1", "this help"},
    {Action::Fit, GLFW_KEY_HOME, 0, "Home", "all of the model"},
    {Action::Fly, GLFW_KEY_F, 0, "F", "fly: W A S D, Q down, E up, Shift faster, mouse looks"},
    {Action::NextMode, GLFW_KEY_M, 0, "M", "by block, by vertex in blocks, by vertex, linear"},
    {Action::NextColoring, GLFW_KEY_C, 0, "C", "colours: shaded, kind, level, block, error"},
    {Action::Wireframe, GLFW_KEY_X, 0, "X", "wireframe"},
    {Action::Creases, GLFW_KEY_L, 0, "L", "lines at hard edges and borders"},
    {Action::Occlusion, GLFW_KEY_K, 0, "K", "darker where little light comes"},
    {Action::Freeze, GLFW_KEY_Z, 0, "Z", "freeze what is shown and look at it from elsewhere"},
    {Action::Outside, GLFW_KEY_O, 0, "O", "freeze, and look from outside"},
    {Action::Finer, GLFW_KEY_LEFT_BRACKET, GLFW_KEY_MINUS, "[ or -", "half the error"},
    {Action::Coarser, GLFW_KEY_RIGHT_BRACKET, GLFW_KEY_EQUAL, "] or =", "twice the error"},
    {Action::NextSplit, GLFW_KEY_V, 0, "V", "one picture, beside the original, two settings"},
    {Action::OtherHalf, GLFW_KEY_TAB, 0, "Tab", "keys and panels are for the other half"},
    {Action::Screenshot, GLFW_KEY_P, GLFW_KEY_F12, "P or F12", "picture into this folder"},
    {Action::Record, GLFW_KEY_R, 0, "R", "record a flight, and write it"},
    {Action::HidePanels, GLFW_KEY_H, 0, "H", "hide the panels"},
    {Action::Leave, GLFW_KEY_ESCAPE, 0, "Esc", "leave the help, flying, the message"},
    {Action::Quit, GLFW_KEY_F10, 0, "F10", "close"},
};

constexpr MouseRow kMouseRows[] = {
    {"left drag", "orbit"},
    {"right or middle drag", "pan"},
    {"wheel", "zoom to what is under the mouse"},
    {"click", "what is there"},
    {"double click", "orbit about what is there"},
    {"drag the line between halves", "make one wider"},
    {"drop a file", "open it"},
};

}  // namespace

std::span<const KeyRow> key_rows() {
  return kRows;
}

std::optional<Action> action_of(int code) {
  for (const KeyRow& row : kRows) {
    if (code == row.code || (row.other_code != 0 && code == row.other_code)) return row.action;
  }
  return std::nullopt;
}

std::span<const MouseRow> mouse_rows() {
  return kMouseRows;
}

FlyKeys fly_keys() {
  return {GLFW_KEY_D, GLFW_KEY_A, GLFW_KEY_E,         GLFW_KEY_Q,
          GLFW_KEY_W, GLFW_KEY_S, GLFW_KEY_LEFT_SHIFT};
}

}  // namespace crease
