// --up: the axis that points up in pictures that no camera is given for.
//
//   std::string up;                       // of the command's arguments
//   add_up_option(*command, up);
//   render.up = up_direction(up, file.blocks().facts().up);
#pragma once

#include "cli/command.h"
#include "crease/mesh.h"

#include <string>

namespace crease::cli {

void add_up_option(CLI::App& command, std::string& up);

// `of_model` unless the option says otherwise.
Vec3d up_direction(const std::string& option, UpAxis of_model);

// "y", "z", or null.
Json to_json(UpAxis up);

}  // namespace crease::cli
