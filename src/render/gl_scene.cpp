#include "render/gl_scene.h"

#include <tuple>
#include <utility>

namespace crease {

namespace {

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

void add_attribute(GLuint location, const GlArray& array, int components) {
  if (!array) return;
  glBindBuffer(GL_ARRAY_BUFFER, array.buffer.id());
  glEnableVertexAttribArray(location);
  glVertexAttribPointer(location, components, GL_FLOAT, GL_FALSE, 0, nullptr);
}

// While it lives, what is drawn covers as many of a pixel's samples as its alpha says: that needs
// no order and no blending. Programs that choose samples themselves leave alpha at 1.
class AlphaToCoverage {
 public:
  explicit AlphaToCoverage(bool is_on) : is_on_(is_on) {
    if (is_on_) each(glEnable);
  }
  ~AlphaToCoverage() {
    if (is_on_) each(glDisable);
  }
  AlphaToCoverage(const AlphaToCoverage&) = delete;
  AlphaToCoverage& operator=(const AlphaToCoverage&) = delete;

 private:
  template <typename Switch>
  static void each(Switch turn) {
    turn(GL_SAMPLE_ALPHA_TO_COVERAGE);
    turn(GL_SAMPLE_ALPHA_TO_ONE);  // the picture's alpha is how much of a pixel is covered
  }
  bool is_on_;
};

}  // namespace

GlScene::GlScene(const DrawList& list, std::span<const float> scalars, GlMaterialsPtr materials,
                 GLenum usage)
    : origin_(list.origin),
      box_(box_of_corners(list)),
      positions_(upload(list.positions, GL_RGB32F, usage)),
      vertex_normals_(upload(list.vertex_normals, GL_RGB32F, usage)),
      scalars_(upload(scalars, GL_R32F, usage)),
      materials_(materials ? std::move(materials) : std::make_shared<GlMaterials>()),
      no_attributes_(GlVertexArray::make()),
      sn_(upload_part(list.sn, usage)),
      fn_(upload_part(list.fn, usage)),
      nsn_(upload_part(list.nsn, usage)) {
  if (!materials_->is_filled()) materials_->fill(list.materials);
  connect_all();
}

GlScene::Part GlScene::upload_part(const DrawPart& list, GLenum usage) {
  Part part;
  part.triangle_count = list.triangle_count();
  part.indices = upload(list.indices, GL_R32UI, usage);
  part.normals = upload(list.normals, GL_RGB32F, usage);
  part.materials = upload(list.materials, GL_R32UI, usage);
  part.colors = upload(list.colors, GL_RGBA32F, usage);
  part.texcoords = upload(list.texcoords, GL_RG32F, usage);
  return part;
}

void GlScene::connect(Part& part, TriangleKind kind) const {
  if (!part.indices) return;
  part.indexed = GlVertexArray::make();
  glBindVertexArray(part.indexed.id());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, part.indices.buffer.id());
  add_attribute(attribute::Position, positions_, 3);
  // The buffer of SN normals is shorter than that of positions; only SN triangles may read it.
  if (kind == TriangleKind::SN) add_attribute(attribute::Normal, vertex_normals_, 3);
  add_attribute(attribute::Scalar, scalars_, 1);
}

void GlScene::connect_all() {
  connect(sn_, TriangleKind::SN);
  connect(fn_, TriangleKind::FN);
  connect(nsn_, TriangleKind::NSN);
}

std::size_t GlScene::update(const DrawList& list, const DrawChanges& changes) {
  std::size_t bytes = refresh(positions_, list.positions, GL_RGB32F, changes.positions);
  bytes += refresh(vertex_normals_, list.vertex_normals, GL_RGB32F, changes.vertex_normals);
  const auto update_part = [&](Part& part, const DrawPart& from, const std::vector<Range>& indices,
                               const std::vector<Range>& normals, std::size_t normals_each,
                               const std::vector<Range>& colors) {
    part.triangle_count = from.triangle_count();
    bytes += refresh(part.indices, from.indices, GL_R32UI, indices, 3);
    bytes += refresh(part.materials, from.materials, GL_R32UI, indices);
    bytes += refresh(part.normals, from.normals, GL_RGB32F, normals, normals_each);
    bytes += refresh(part.colors, from.colors, GL_RGBA32F, colors, 3);
    bytes += refresh(part.texcoords, from.texcoords, GL_RG32F, colors, 3);
  };
  update_part(sn_, list.sn, changes.sn_indices, {}, 1, changes.sn_colors);
  update_part(fn_, list.fn, changes.fn_indices, changes.fn_normals, 1, changes.fn_colors);
  update_part(nsn_, list.nsn, changes.nsn_indices, changes.nsn_normals, 3, changes.nsn_colors);
  connect_all();  // arrays that were empty have buffers now
  return bytes;
}

std::size_t GlScene::set_scalars(std::span<const float> scalars) {
  const Range all{0, std::uint32_t(scalars.size())};
  const std::size_t bytes = refresh(scalars_, scalars, GL_R32F, std::span(&all, 1));
  connect_all();
  return bytes;
}

DrawRanges GlScene::all() const {
  return {{0, std::uint32_t(sn_.triangle_count)},
          {0, std::uint32_t(fn_.triangle_count)},
          {0, std::uint32_t(nsn_.triangle_count)}};
}

bool GlScene::is_seen_through(const DrawStyle& style) const {
  return key_for(sn_, TriangleKind::SN, style).see_through ||
         key_for(fn_, TriangleKind::FN, style).see_through ||
         key_for(nsn_, TriangleKind::NSN, style).see_through;
}

std::size_t GlScene::triangle_count() const {
  return sn_.triangle_count + fn_.triangle_count + nsn_.triangle_count;
}

std::size_t GlScene::bytes() const {
  std::size_t bytes = positions_.bytes + vertex_normals_.bytes + scalars_.bytes;
  for (const Part* part : {&sn_, &fn_, &nsn_}) {
    bytes += part->indices.bytes + part->normals.bytes + part->materials.bytes +
             part->colors.bytes + part->texcoords.bytes;
  }
  return bytes;
}

Status GlScene::draw(ProgramCache& programs, const DrawPass& pass, const DrawStyle& style) const {
  return draw(programs, pass, style, all());
}

Status GlScene::draw(ProgramCache& programs, const DrawPass& pass, const DrawStyle& style,
                     const DrawRanges& ranges) const {
  for (const auto& [part, kind, range] : {std::tuple(&sn_, TriangleKind::SN, ranges.sn),
                                          std::tuple(&fn_, TriangleKind::FN, ranges.fn),
                                          std::tuple(&nsn_, TriangleKind::NSN, ranges.nsn)}) {
    if (range.count == 0) continue;
    const Status drawn = draw_part(programs, *part, kind, pass, style, range);
    if (!drawn.ok()) return drawn;
  }
  return Done{};
}

ProgramKey GlScene::key_for(const Part& part, TriangleKind kind, const DrawStyle& style) const {
  const bool own_colors = style.coloring == Coloring::Shaded && !style.surface;
  const bool has_materials = own_colors && part.materials && materials_->texels();
  ProgramKey key;
  key.normals = normal_source(kind);
  key.wireframe = style.wireframe;
  key.textures = has_materials && part.texcoords && materials_->has_textures();
  if (own_colors && part.colors) {
    key.albedo = AlbedoSource::Corners;
    key.materials = has_materials && !materials_->has_colors_of_names();
  } else if (has_materials) {
    key.albedo = AlbedoSource::Materials;
  } else if (!own_colors && !style.surface && scalars_) {
    if (style.coloring == Coloring::Error) key.albedo = AlbedoSource::Errors;
    if (style.coloring == Coloring::Level) key.albedo = AlbedoSource::Levels;
  }
  key.see_through = key.has_materials() && materials_->has_translucent();
  if (key.see_through) key.shown = style.shown;
  key.chooses_samples = key.see_through && style.turn && style.shown != Shown::Opaque;
  // FN triangles are indexed, and each fragment fetches its triangle's normal: vertices are worked
  // out once and not once a triangle (bench_flat_normals; Berlin on a GPU 6.3 to 2.1 ms a frame).
  key.pulled = kind == TriangleKind::NSN || key.wireframe || key.textures ||
               key.albedo == AlbedoSource::Corners || key.shown == Shown::SeenThrough;
  return key;
}

void GlScene::set_uniforms(const Program& program, TriangleKind kind, const DrawPass& pass,
                           const DrawStyle& style) const {
  const View& view = pass.view;
  const Matrix4f clip =
      clip_from_list(view, origin_, pass.depth, pass.window, style.reversed_depth);
  glUniformMatrix4fv(program.clip_from_list, 1, GL_FALSE, clip.data());
  set(program.eye_in_list, to_float(view.eye - origin_));
  glUniform1f(program.unit, float(unit_of(pass.depth)));
  set(program.head_light, to_float(view.back));
  // Over the viewer's left shoulder, so that the sides of a box differ.
  const Vec3d key_light = view.back * 0.62 + view.above * 0.62 - view.right * 0.48;
  set(program.key_light, to_float(normalized(key_light)));
  set(program.up, to_float(normalized(pass.up)));
  ColorSrgb albedo = kDefaultSurface;
  if (style.coloring == Coloring::Kind) albedo = kind_color(kind);
  if (style.coloring == Coloring::Level) albedo = level_color(style.level_share);
  const Color linear = linear_from_srgb(style.surface.value_or(albedo));
  set(program.albedo, {linear[0], linear[1], linear[2]});
  if (program.scalar_scale >= 0) {
    const bool is_error = style.coloring == Coloring::Error;
    glUniform1f(program.scalar_scale, is_error ? 1 / style.error_full : 1.0f);
  }
  if (program.line_px >= 0) glUniform1f(program.line_px, style.line_px);
  if (program.turn >= 0) glUniform1ui(program.turn, *style.turn);
}

namespace {

// Both sides are seen. Where they are at one place, as those of a thin plate in a coarse level, it
// is the one that faces the eye: the others are a little behind.
template <typename Draw>
void draw_front_before_back(const DrawStyle& style, Draw draw) {
  constexpr float kBehind = 8;  // of the least differences in depth
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  draw();
  if (style.shows_backs) {
    glCullFace(GL_FRONT);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(0, style.reversed_depth ? -kBehind : kBehind);
    draw();
    glDisable(GL_POLYGON_OFFSET_FILL);
  }
  glDisable(GL_CULL_FACE);
}

}  // namespace

Status GlScene::draw_part(ProgramCache& programs, const Part& part, TriangleKind kind,
                          const DrawPass& pass, const DrawStyle& style, const Range& range) const {
  const ProgramKey key = key_for(part, kind, style);
  const Result<const Program*> got = programs.get(key);
  if (!got.ok()) return got.failure();
  const Program& program = **got;
  glUseProgram(program.program.id());
  set_uniforms(program, kind, pass, style);
  if (program.first_triangle >= 0) glUniform1i(program.first_triangle, GLint(range.first));

  bind_texels(positions_, unit::Positions);
  bind_texels(part.indices, unit::Indices);
  bind_texels(kind == TriangleKind::SN ? vertex_normals_ : part.normals, unit::Normals);
  bind_texels(part.materials, unit::Materials);
  bind_texels(materials_->texels(), unit::MaterialColors);
  bind_texels(part.colors, unit::CornerColors);
  if (key.textures) {
    bind_texels(part.texcoords, unit::CornerTexcoords);
    materials_->bind_textures(unit::Textures);
  }
  bind_texels(scalars_, unit::Scalars);

  const AlphaToCoverage translucent(key.see_through);
  const GLsizei corner_count = GLsizei(3 * range.count);
  const std::size_t skipped = std::size_t(3) * range.first * sizeof(std::uint32_t);
  glBindVertexArray(key.pulled ? no_attributes_.id() : part.indexed.id());
  draw_front_before_back(style, [&] {
    if (key.pulled) {
      glDrawArrays(GL_TRIANGLES, GLint(3 * range.first), corner_count);
    } else {
      glDrawElements(GL_TRIANGLES, corner_count, GL_UNSIGNED_INT,
                     reinterpret_cast<const void*>(skipped));
    }
  });
  return Done{};
}

}  // namespace crease
