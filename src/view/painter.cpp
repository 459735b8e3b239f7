#include "view/painter.h"

#include "render/gl_lines.h"

namespace crease {

Result<DrawCount> paint(GlCanvas& canvas, ShownMesh& mesh, const Picture& picture,
                        const ViewSettings& settings, std::span<const Segment> lines) {
  const Camera& camera = picture.camera;
  const DrawPass pass =
      pass_over(camera, double(camera.width_px) / camera.height_px, mesh.box(), lines);
  const DrawStyle style{.wireframe = settings.wireframe,
                        .line_px = float(picture.scale),
                        .reversed_depth = canvas.limits().can_reverse_depth};
  const Result<DrawCount> count =
      mesh.draw(canvas.programs(), pass, style, settings, picture.cut_camera);
  if (!count.ok()) return count;
  if (settings.ambient_occlusion) {
    if (const Status done = canvas.occlude(pass, style); !done.ok()) return done.failure();
  }
  const Status drawn = draw_lines(canvas.programs(), lines, pass, style);
  if (!drawn.ok()) return drawn.failure();
  return count;
}

}  // namespace crease
