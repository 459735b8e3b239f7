#include "cli/up_option.h"

namespace crease::cli {

void add_up_option(CLI::App& command, std::string& up) {
  up = "auto";
  command
      .add_option("--up", up,
                  "axis that points up when no camera says: y, z, or as the model's file has it")
      ->check(CLI::IsMember({"auto", "y", "z"}))
      ->capture_default_str();
}

Vec3d up_direction(const std::string& option, UpAxis of_model) {
  if (option == "y") return direction_of(UpAxis::Y);
  if (option == "z") return direction_of(UpAxis::Z);
  return direction_of(of_model);
}

Json to_json(UpAxis up) {
  if (up == UpAxis::Unknown) return nullptr;
  return up == UpAxis::Y ? "y" : "z";
}

}  // namespace crease::cli
