#include "render/gl_scene.h"

#include "render/palette.h"

namespace crease {

namespace {

constexpr float kFrustumLinePx = 2.5f;  // beside the lines of a wireframe

Vec3f to_float(const Vec3d& v) {
  return {float(v.x), float(v.y), float(v.z)};
}

void set(GLint location, const Vec3f& v) {
  if (location >= 0) glUniform3f(location, v.x, v.y, v.z);
}

NormalSource normal_source(TriangleKind kind) {
  switch (kind) {
    case TriangleKind::SN:
      return NormalSource::PerVertex;
    case TriangleKind::FN:
      return NormalSource::PerTriangle;
    case TriangleKind::NSN:
      return NormalSource::PerCorner;
  }
  return {};
}

Box box_of_corners(const DrawList& list) {
  Box box;
  for (const DrawPart* part : {&list.sn, &list.fn, &list.nsn}) {
    for (std::uint32_t i : part->indices) {
      const Vec3f& p = list.positions[i];
      box.add(list.origin + Vec3d{p.x, p.y, p.z});
    }
  }
  return box;
}

}  // namespace

GlScene::GlScene(const DrawList& list, std::span<const float> errors, std::vector<Segment> lines)
    : origin_(list.origin),
      box_(box_of_corners(list)),
      positions_(upload(list.positions, GL_RGB32F)),
      vertex_normals_(upload(list.vertex_normals, GL_RGB32F)),
      errors_(upload(errors, GL_R32F)),
      no_attributes_(GlVertexArray::make()),
      lines_(std::move(lines)) {
  for (const Segment& line : lines_) {
    box_.add(line.from);
    box_.add(line.to);
  }
  const auto colors = material_colors(list.materials);
  material_colors_ = upload(std::span(colors), GL_RGBA32F);
  sn_ = upload_part(list.sn);
  fn_ = upload_part(list.fn);
  nsn_ = upload_part(list.nsn);
}

GlScene::Part GlScene::upload_part(const DrawPart& list) {
  Part part;
  part.triangle_count = list.triangle_count();
  if (part.triangle_count == 0) return part;
  part.indices = upload(list.indices, GL_R32UI);
  part.normals = upload(list.normals, GL_RGB32F);
  part.materials = upload(list.materials, GL_R32UI);
  part.colors = upload(list.colors, GL_RGBA32F);

  part.indexed = GlVertexArray::make();
  glBindVertexArray(part.indexed.id());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, part.indices.buffer.id());
  const auto add = [](GLuint location, const GlArray& array, int components) {
    if (!array) return;
    glBindBuffer(GL_ARRAY_BUFFER, array.buffer.id());
    glEnableVertexAttribArray(location);
    glVertexAttribPointer(location, components, GL_FLOAT, GL_FALSE, 0, nullptr);
  };
  add(attribute::Position, positions_, 3);
  // The buffer of SN normals is shorter than that of positions; only SN triangles may read it.
  if (!part.normals) add(attribute::Normal, vertex_normals_, 3);
  add(attribute::Error, errors_, 1);
  return part;
}

Status GlScene::draw(ProgramCache& programs, const View& view, const Vec3d& up,
                     const Window& window, const DrawStyle& style) const {
  const DepthRange depth = depth_range(view, box_.low, box_.high);
  const Matrix4f clip = clip_from_list(view, origin_, depth, window, style.reversed_depth);
  for (const auto& [part, kind] :
       {std::pair(&sn_, TriangleKind::SN), std::pair(&fn_, TriangleKind::FN),
        std::pair(&nsn_, TriangleKind::NSN)}) {
    if (part->triangle_count == 0) continue;
    const Status drawn = draw_part(programs, *part, kind, view, up, clip, style);
    if (!drawn.ok()) return drawn;
  }
  if (lines_.empty()) return Done{};
  return draw_lines(lines_, {.view = view,
                             .origin = origin_,
                             .near = depth.near,
                             .clip_from_list = clip,
                             .width_px = kFrustumLinePx * style.line_px,
                             .reversed_depth = style.reversed_depth});
}

Status GlScene::draw_part(ProgramCache& programs, const Part& part, TriangleKind kind,
                          const View& view, const Vec3d& up, const Matrix4f& clip_from_list,
                          const DrawStyle& style) const {
  const bool own_colors = style.coloring == Coloring::Shaded;
  const bool has_materials = own_colors && part.materials && material_colors_;
  ProgramKey key;
  key.normals = normal_source(kind);
  key.wireframe = style.wireframe;
  if (own_colors && part.colors) {
    key.albedo = AlbedoSource::Corners;
    key.materials = has_materials;
  } else if (has_materials) {
    key.albedo = AlbedoSource::Materials;
  } else if (style.coloring == Coloring::Error && errors_) {
    key.albedo = AlbedoSource::Errors;
  }
  // 2 M FN triangles on llvmpipe, seconds of both cores at 100 x 100 and at 1080 x 1080 pixels:
  //   pulled, the normal fetched by the vertex shader and passed on flat      1.12   3.07
  //   indexed, the normal fetched for each fragment by gl_PrimitiveID         1.17   3.35
  //   pulled, the normal fetched for each fragment                            1.20   3.64
  key.pulled = kind != TriangleKind::SN || key.wireframe || key.albedo == AlbedoSource::Corners;

  const Result<const Program*> got = programs.get(key);
  if (!got.ok()) return got.failure();
  const Program& program = **got;
  glUseProgram(program.program.id());
  glUniformMatrix4fv(program.clip_from_list, 1, GL_FALSE, clip_from_list.data());
  set(program.eye_in_list, to_float(view.eye - origin_));
  set(program.head_light, to_float(view.back));
  // Over the viewer's left shoulder, so that the sides of a box differ.
  const Vec3d key_light = view.back * 0.62 + view.above * 0.62 - view.right * 0.48;
  set(program.key_light, to_float(normalized(key_light)));
  set(program.up, to_float(normalized(up)));
  ColorSrgb albedo = kDefaultSurface;
  if (style.coloring == Coloring::Kind) albedo = kind_color(kind);
  if (style.coloring == Coloring::Level) albedo = level_color(style.level_share);
  const Color linear = linear_from_srgb(albedo);
  set(program.albedo, {linear[0], linear[1], linear[2]});
  if (program.error_scale >= 0) glUniform1f(program.error_scale, 1 / style.error_full);
  if (program.line_px >= 0) glUniform1f(program.line_px, style.line_px);

  bind_texels(positions_, unit::Positions);
  bind_texels(part.indices, unit::Indices);
  bind_texels(kind == TriangleKind::SN ? vertex_normals_ : part.normals, unit::Normals);
  bind_texels(part.materials, unit::Materials);
  bind_texels(material_colors_, unit::MaterialColors);
  bind_texels(part.colors, unit::CornerColors);
  bind_texels(errors_, unit::Errors);

  const GLsizei corner_count = GLsizei(3 * part.triangle_count);
  if (key.pulled) {
    glBindVertexArray(no_attributes_.id());
    glDrawArrays(GL_TRIANGLES, 0, corner_count);
  } else {
    glBindVertexArray(part.indexed.id());
    glDrawElements(GL_TRIANGLES, corner_count, GL_UNSIGNED_INT, nullptr);
  }
  return Done{};
}

}  // namespace crease
