// The real models in ../shared/data, when they are there. Tests that use them pass without them.
//
//   for (const std::filesystem::path& path : shared_models("scan")) { ... }
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace crease {

// Every model file of one folder (scan, cad, city, attributes, nasty), sorted; empty without the
// data.
std::vector<std::filesystem::path> shared_models(const std::string& folder);

// One model by its path below the data folder ("city/berlin_52k.obj.zst"); empty without the data.
std::filesystem::path shared_model(const std::string& name);

}  // namespace crease
