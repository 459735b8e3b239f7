// Small pictures of a scene that changes.
#pragma once

#include "crease/decode_model.h"
#include "crease/render.h"
#include "render/gl_context.h"
#include "render/gl_scene.h"

#include <cstdint>
#include <vector>

namespace crease {

inline constexpr int kPicturePx = 120;  // wide and high

// One a context: it keeps its programs, see ProgramCache.
class ScenePainter {
 public:
  explicit ScenePainter(const GlLimits& limits) : limits_(limits) {}
  // RGBA, bottom row first.
  std::vector<std::uint8_t> paint(const GlScene& scene, const Camera& camera, const Box& box,
                                  bool wireframe, Coloring coloring = Coloring::Kind);

 private:
  GlLimits limits_;
  ProgramCache programs_;
};

// That looks at the middle of the unit box.
Camera camera_at(double angle, double distance);

// A mesh as a file gives it back.
struct Decoded {
  DecodedModel model;
  Box box;
};
Decoded decoded(const Mesh& mesh);

}  // namespace crease
