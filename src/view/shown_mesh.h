// A model as one of the viewer's modes shows it.
//
//   every frame:
//     FrameFacts facts = mesh.update(settings, camera);   // moves the cut, uploads what changed
//     mesh.draw(canvas, pass, style, settings);
#pragma once

#include "render/gl_blocks.h"
#include "render/gl_canvas.h"
#include "view/pick.h"
#include "view/settings.h"

#include <optional>
#include <vector>

namespace crease {

class ShownMesh {
 public:
  ShownMesh() = default;
  ShownMesh(const ShownMesh&) = delete;
  ShownMesh& operator=(const ShownMesh&) = delete;
  virtual ~ShownMesh() = default;

  // The cut for `camera`, as far as can be without waiting. `draw_calls` is left to draw().
  virtual FrameFacts update(const ViewSettings& settings, const Camera& camera) = 0;
  // `cut_camera`: what the last update() had; errors are those on its screen.
  virtual Result<DrawCount> draw(ProgramCache& programs, const DrawPass& pass, DrawStyle style,
                                 const ViewSettings& settings, const Camera& cut_camera) = 0;
  virtual std::optional<Hit> pick(const Ray& ray) const = 0;
  // Of a hit of the present cut. May take its time.
  virtual HitFacts facts_of(const Hit& hit) const = 0;

  // Points around all that is shown, close enough to fit a camera to; relative to origin().
  virtual std::vector<Vec3f> outline() const = 0;
  virtual Vec3d origin() const = 0;
  virtual Box box() const = 0;  // of all that can be shown
};

// Model units of the largest error of surface and lines, in pixels at a distance.
inline double in_pixels(const LevelError& error, const Camera& camera, double distance) {
  return double(std::max(error.surface, error.line)) /
         std::max(pixel_size(camera, distance), 1e-300);
}

}  // namespace crease
