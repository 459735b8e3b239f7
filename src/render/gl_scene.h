// A draw list on the GPU, in the three parts of DB03: uploaded once, drawn from any number of
// cameras.
#pragma once

#include "crease/draw_list.h"
#include "crease/shading.h"
#include "render/gl_lines.h"
#include "render/gl_objects.h"
#include "render/gl_shaders.h"
#include "render/transform.h"

namespace crease {

// What is the same for everything in one picture.
struct DrawStyle {
  Coloring coloring = Coloring::Shaded;
  bool wireframe = false;
  float line_px = 1;            // width of wireframe lines, in pixels of the framebuffer
  float level_share = 0;        // Coloring::Level
  float error_full = 1;         // Coloring::Error: the error at the scale's red end
  bool reversed_depth = false;  // as the target has it
};

class GlScene {
 public:
  // `errors` has one value per position, or none. `lines` are drawn over the triangles.
  GlScene(const DrawList& list, std::span<const float> errors, std::vector<Segment> lines);

  // Into the bound framebuffer. `window` is the part of the picture that its viewport shows.
  Status draw(ProgramCache& programs, const View& view, const Vec3d& up, const Window& window,
              const DrawStyle& style) const;

 private:
  struct Part {
    GlArray indices, normals, materials, colors;
    GlVertexArray indexed;  // positions, SN normals and errors as attributes
    std::size_t triangle_count = 0;
  };
  Part upload_part(const DrawPart& part);
  Status draw_part(ProgramCache& programs, const Part& part, TriangleKind kind, const View& view,
                   const Vec3d& up, const Matrix4f& clip_from_list, const DrawStyle& style) const;

  Vec3d origin_;
  Box box_;  // of the triangles' corners and the lines, in model units
  GlArray positions_, vertex_normals_, errors_, material_colors_;
  GlVertexArray no_attributes_;
  Part sn_, fn_, nsn_;
  std::vector<Segment> lines_;
};

}  // namespace crease
