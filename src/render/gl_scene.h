// A draw list on the GPU, in the three parts of DB03: uploaded once, or kept up with a mesh that
// changes, and drawn from any number of cameras.
//
//   GlScene scene(mesh.draw_list(), {});
//   ... mesh.update(view); scene.update(mesh.draw_list(), mesh.changes());
//   scene.draw(programs, pass, style);
#pragma once

#include "crease/draw_list.h"
#include "crease/shading.h"
#include "render/draw_ranges.h"
#include "render/gl_materials.h"
#include "render/gl_objects.h"
#include "render/gl_pass.h"
#include "render/gl_shaders.h"

#include <memory>

namespace crease {

class GlScene {
 public:
  // `scalars` has one value per position, or none: what Coloring::Error or Coloring::Level paints.
  // `materials`: those of the list, which are filled with its base colours if nobody has done so.
  // `usage`: GL_DYNAMIC_DRAW for who calls update().
  GlScene(const DrawList& list, std::span<const float> scalars, GlMaterialsPtr materials = nullptr,
          GLenum usage = GL_STATIC_DRAW);

  // `list` is the one of the constructor after `changes`. Returns the bytes uploaded.
  std::size_t update(const DrawList& list, const DrawChanges& changes);
  std::size_t set_scalars(std::span<const float> scalars);  // the same

  // Into the bound framebuffer: all of it, or some triangles.
  Status draw(ProgramCache& programs, const DrawPass& pass, const DrawStyle& style) const;
  Status draw(ProgramCache& programs, const DrawPass& pass, const DrawStyle& style,
              const DrawRanges& ranges) const;

  DrawRanges all() const;
  std::size_t triangle_count() const;
  bool is_seen_through(const DrawStyle& style) const;  // in places
  const Box& box() const { return box_; }              // of the triangles' corners when it was made
  std::size_t bytes() const;  // that it takes on the GPU, without materials

 private:
  struct Part {
    GlArray indices, normals, materials, colors, texcoords;
    GlVertexArray indexed;  // positions, SN normals and scalars as attributes
    std::size_t triangle_count = 0;
  };
  static Part upload_part(const DrawPart& part, GLenum usage);
  void connect(Part& part, TriangleKind kind) const;
  void connect_all();
  ProgramKey key_for(const Part& part, TriangleKind kind, const DrawStyle& style) const;
  void set_uniforms(const Program& program, TriangleKind kind, const DrawPass& pass,
                    const DrawStyle& style) const;
  Status draw_part(ProgramCache& programs, const Part& part, TriangleKind kind,
                   const DrawPass& pass, const DrawStyle& style, const Range& range) const;

  Vec3d origin_;
  Box box_;
  GlArray positions_, vertex_normals_, scalars_;
  GlMaterialsPtr materials_;
  GlVertexArray no_attributes_;
  Part sn_, fn_, nsn_;
};

}  // namespace crease
