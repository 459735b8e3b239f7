// The camera that each file was last seen from, one small file each below
// $XDG_STATE_HOME/crease/views, or ~/.local/state without that variable.
#pragma once

#include "crease/camera.h"
#include "crease/result.h"

#include <filesystem>
#include <optional>
#include <string>

namespace crease {

// Empty where neither variable nor home says where.
std::filesystem::path state_folder();

// `source`: path or URL. Nothing where there is none, or it is no camera.
std::optional<Camera> remembered_view(const std::string& source);
Status remember_view(const std::string& source, const Camera& camera);

}  // namespace crease
