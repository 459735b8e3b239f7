// The models of models.txt, ready to be simplified: positions around the origin and snapped, one
// normal layer and nothing else, so that crease and the peers work on the same.
#pragma once

#include "crease/mesh.h"
#include "crease/result.h"
#include "peers/exchange.h"

#include <filesystem>
#include <string>
#include <vector>

namespace crease::bench {

struct ModelEntry {
  std::string name, kind, normals, where;
};
Result<std::vector<ModelEntry>> read_models(const std::filesystem::path& list);
// Of models.txt and models_more.txt, those that are named, or all.
std::vector<ModelEntry> all_models(const std::vector<std::string>& names);

// Around the origin, not snapped yet.
Result<Mesh> load_mesh(const ModelEntry& entry, const std::filesystem::path& data);

struct Model {
  Mesh mesh;  // snapped
  Grid grid;
};
Result<Model> load_model(const ModelEntry& entry, const std::filesystem::path& data);

exchange::Mesh to_exchange(const Mesh& mesh);
// A mesh that comes without normals gets them: smooth on scans, 30 degree creases on the others.
Mesh from_exchange(const exchange::Mesh& mesh, const std::string& kind);

// Where ../shared/data is.
std::filesystem::path data_folder();

}  // namespace crease::bench
