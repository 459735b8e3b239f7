#include "render/gl_creases.h"

#include "render/palette.h"

#include <algorithm>
#include <cmath>

namespace crease {

namespace {

constexpr float kCreasePx = 1.3f;  // beside the lines of a wireframe
// How far lines are drawn before their place, in pixels there: enough that the halves of a line
// that lie over the sides of a steep edge are in front of them.
constexpr double kBeforePx = 2.5;

// Two triangles a line, all vertices fetched.
constexpr const char* kCreaseVertexShader = R"(#version 330 core
uniform samplerBuffer ends;
uniform mat4 clip_from_list;
uniform vec3 eye_in_list;
uniform vec2 half_viewport;
uniform float near, half_px, towards_eye;  // near: as clip coordinates have it
out float v_across;        // pixels from the middle
flat out float v_strength;

vec4 end_in_clip(int i) {
  vec3 p = texelFetch(ends, i).xyz;
  return clip_from_list * vec4(eye_in_list + (p - eye_in_list) * towards_eye, 1);
}

void main() {
  int line = gl_VertexID / 6, corner = gl_VertexID % 6;
  vec4 a = end_in_clip(2 * line), b = end_in_clip(2 * line + 1);
  v_across = 0;
  v_strength = 0;
  gl_Position = vec4(0, 0, 0, 1);  // all the same: nothing is drawn
  if (a.w < near && b.w < near) return;
  if (a.w < near) a = mix(a, b, (near - a.w) / (b.w - a.w));
  if (b.w < near) b = mix(b, a, (near - b.w) / (a.w - b.w));
  vec2 along = (b.xy / b.w - a.xy / a.w) * half_viewport;
  float pixels = length(along);
  if (pixels < 1e-3) return;
  v_strength = mix(0.2, 0.9, smoothstep(1.0, 14.0, pixels));
  bool is_end = corner == 1 || corner == 2 || corner == 4;
  float side = corner == 0 || corner == 1 || corner == 3 ? -1 : 1;
  v_across = side * (half_px + 0.7);
  vec4 at = is_end ? b : a;
  at.xy += vec2(-along.y, along.x) / pixels * v_across / half_viewport * at.w;
  gl_Position = at;
}
)";

constexpr const char* kCreaseFragmentShader = R"(#version 330 core
uniform vec3 line_color;
uniform float half_px;
in float v_across;
flat in float v_strength;
out vec4 color;
void main() {
  color = vec4(line_color, v_strength * clamp(half_px + 0.5 - abs(v_across), 0, 1));
}
)";

// OpenGL set up for lines while it lives.
class LinePainter {
 public:
  static Result<LinePainter> begin(ProgramCache& programs, const GlVertexArray& no_attributes,
                                   const DrawPass& pass, const DrawStyle& style) {
    const Result<const GlProgram*> got =
        programs.get("creases", kCreaseVertexShader, kCreaseFragmentShader);
    if (!got.ok()) return got.failure();
    return LinePainter((*got)->id(), no_attributes, pass, style);
  }
  LinePainter(LinePainter&& other) noexcept
      : program_(std::exchange(other.program_, 0)), pass_(other.pass_), style_(other.style_) {}
  LinePainter& operator=(LinePainter&&) = delete;
  ~LinePainter() {
    if (program_ == 0) return;
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
  }

  void draw(const GlArray& ends, const Range& lines, const Vec3d& origin, const ColorSrgb& color) {
    if (lines.count == 0) return;
    const Matrix4f clip =
        clip_from_list(pass_.view, origin, pass_.depth, pass_.window, style_.reversed_depth);
    glUniformMatrix4fv(at("clip_from_list"), 1, GL_FALSE, clip.data());
    const Vec3d eye = pass_.view.eye - origin;
    glUniform3f(at("eye_in_list"), float(eye.x), float(eye.y), float(eye.z));
    const Color linear = linear_from_srgb(color);
    glUniform3f(at("line_color"), linear[0], linear[1], linear[2]);
    bind_texels(ends, 0);
    glDrawArrays(GL_TRIANGLES, GLint(6 * lines.first), GLsizei(6 * lines.count));
  }

 private:
  LinePainter(GLuint program, const GlVertexArray& no_attributes, const DrawPass& pass,
              const DrawStyle& style)
      : program_(program), pass_(pass), style_(style) {
    GLint viewport[4];
    glGetIntegerv(GL_VIEWPORT, viewport);
    glUseProgram(program_);
    glBindVertexArray(no_attributes.id());
    glUniform1i(at("ends"), 0);
    glUniform2f(at("half_viewport"), float(viewport[2]) / 2, float(viewport[3]) / 2);
    glUniform1f(at("near"), float(unit_of(pass.depth) * pass.depth.near));
    glUniform1f(at("half_px"), kCreasePx * style.line_px / 2);
    const double of_height = pass.window.top - pass.window.bottom;
    const double pixel = 2 * pass.view.tan_half_height * of_height / std::max(1, viewport[3]);
    glUniform1f(at("towards_eye"), float(1 - kBeforePx * double(style.line_px) * pixel));
    // The target's alpha is how much is covered, its colours are times that.
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    glDepthFunc(style.reversed_depth ? GL_GREATER : GL_LESS);
  }

  GLint at(const char* name) const { return glGetUniformLocation(program_, name); }

  GLuint program_;
  const DrawPass& pass_;
  const DrawStyle& style_;
};

GlArray upload_lines(std::span<const Line3f> lines) {
  static_assert(sizeof(Line3f) == 2 * sizeof(Vec3f));
  return upload_bytes(std::as_bytes(lines), sizeof(Vec3f), GL_RGB32F);
}

Range all_lines(const GlArray& ends) {
  return {0, std::uint32_t(ends.count / 2)};
}

bool is_same_range(const Range& a, const Range& b) {
  return a.first == b.first && a.count == b.count;
}

bool is_same_run(const ShownRange& a, const ShownRange& b) {
  return a.block == b.block && is_same_range(a.sn, b.sn) && is_same_range(a.fn, b.fn) &&
         is_same_range(a.nsn, b.nsn);
}

std::uint32_t number_of(BlockId id) {
  return static_cast<std::uint32_t>(index_of(id));
}

}  // namespace

std::size_t GlCreases::set(const CreaseLines& lines, const Vec3d& origin) {
  origin_ = origin;
  hard_ = upload_lines(lines.hard);
  borders_ = upload_lines(lines.borders);
  return bytes();
}

Status GlCreases::draw(ProgramCache& programs, const DrawPass& pass, const DrawStyle& style) const {
  Result<LinePainter> painter = LinePainter::begin(programs, no_attributes_, pass, style);
  if (!painter.ok()) return painter.failure();
  painter->draw(hard_, all_lines(hard_), origin_, kCreaseColor);
  painter->draw(borders_, all_lines(borders_), origin_, kBorderColor);
  return Done{};
}

const GlBlockCreases::BlockLines& GlBlockCreases::lines_of_block(const ResidentBlock& block,
                                                                 std::size_t& uploaded) {
  const auto [at, is_new] = blocks_.try_emplace(number_of(block.id()));
  BlockLines& lines = at->second;
  if (!is_new) return lines;
  const DrawList list = block.draw_list();
  for (const Vec3f& p : list.positions) lines.box.add(list.origin + Vec3d{p.x, p.y, p.z});
  lines.creases = creases_of(block);
  lines.hard = upload_lines(lines.creases.hard);
  lines.creases.hard = {};
  uploaded += lines.hard.bytes;
  return lines;
}

const GroupLines& GlBlockCreases::lines_of_cut(const ShownCut& cut) {
  CutLines& here = cuts_[number_of(cut.block->id())];
  if (here.revision != cut.revision) {
    here.revision = cut.revision;
    here.lines = lines_of(cut.list, all_of(cut.list));
  }
  return here.lines;
}

std::size_t GlBlockCreases::update(std::span<const ShownRange> shown,
                                   std::span<const ShownCut> cuts) {
  const bool has_same_cuts = std::equal(
      cuts.begin(), cuts.end(), of_revisions_.begin(), of_revisions_.end(),
      [](const ShownCut& cut, std::uint64_t revision) { return cut.revision == revision; });
  if (has_same_cuts &&
      std::equal(shown.begin(), shown.end(), of_.begin(), of_.end(), is_same_run)) {
    return 0;
  }
  of_.assign(shown.begin(), shown.end());
  of_revisions_.clear();
  for (const ShownCut& cut : cuts) of_revisions_.push_back(cut.revision);
  std::erase_if(cuts_, [this](const auto& cut) {
    return std::find(of_revisions_.begin(), of_revisions_.end(), cut.second.revision) ==
           of_revisions_.end();
  });
  shown_.clear();
  std::size_t uploaded = 0;
  std::vector<std::span<const RimEdge>> rims;
  for (const ShownRange& run : shown) {
    const BlockLines& lines = lines_of_block(*run.block, uploaded);
    shown_.push_back({&lines, hard_of_run(run, lines.creases, rims)});
  }
  std::vector<Line3f> hard;
  for (const ShownCut& cut : cuts) {
    const GroupLines& lines = lines_of_cut(cut);
    hard.insert(hard.end(), lines.hard.begin(), lines.hard.end());
    rims.push_back(lines.rim);
  }
  origin_ = !shown.empty()  ? shown.front().block->draw_list().origin
            : !cuts.empty() ? cuts.front().list.origin
                            : Vec3d{};
  CreaseLines between = join_rims(rims);
  between.hard.insert(between.hard.end(), hard.begin(), hard.end());
  return uploaded + between_.set(between, origin_);
}

void GlBlockCreases::drop(std::span<const BlockId> blocks) {
  for (const BlockId id : blocks) {
    if (blocks_.erase(number_of(id)) == 0) continue;
    of_.clear();  // whatever is shown now, it is another thing
    shown_.clear();
  }
}

Status GlBlockCreases::draw(ProgramCache& programs, const DrawPass& pass,
                            const DrawStyle& style) const {
  {
    Result<LinePainter> painter = LinePainter::begin(programs, no_attributes_, pass, style);
    if (!painter.ok()) return painter.failure();
    for (const ShownLines& lines : shown_) {
      if (is_beside(pass.view, lines.block->box)) continue;
      painter->draw(lines.block->hard, lines.hard, origin_, kCreaseColor);
    }
  }
  return between_.draw(programs, pass, style);
}

std::size_t GlBlockCreases::bytes() const {
  std::size_t bytes = between_.bytes();
  for (const auto& [id, lines] : blocks_) bytes += lines.hard.bytes;
  return bytes;
}

}  // namespace crease
