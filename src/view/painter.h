// One picture of a model.
#pragma once

#include "render/frustum.h"
#include "view/shown_mesh.h"

#include <span>

namespace crease {

struct Picture {
  Camera camera;      // from where it is drawn; its viewport is the picture's size
  Camera cut_camera;  // for which the mesh was cut
  double scale = 1;   // of lines
};

// Into the canvas, which has begun. Over the model the lines.
Result<DrawCount> paint(GlCanvas& canvas, ShownMesh& mesh, const Picture& picture,
                        const ViewSettings& settings, std::span<const Segment> lines);

}  // namespace crease
