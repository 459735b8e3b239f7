// By vertex, and linear: the whole model in memory.
#pragma once

#include "crease/adaptive_mesh.h"
#include "crease/progressive_mesh.h"
#include "view/open_model.h"
#include "view/shown_mesh.h"

#include <memory>

namespace crease {

struct WholeModel {
  // One of the two.
  std::unique_ptr<AdaptiveMesh> vertices;
  std::unique_ptr<ProgressiveMesh> linear;
  Box box;
  std::uint64_t bytes_read = 0;
};

// `mode`: not Blocks. For threads in the background.
Result<WholeModel> load_whole(const ModelSource& model, ViewMode mode, Note& note);

// The largest of its arrays must fit the device: OverLimit. A context must be current.
Result<std::unique_ptr<ShownMesh>> show_whole(WholeModel model, const GlLimits& limits);

}  // namespace crease
