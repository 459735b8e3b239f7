// The programs of the three-part drawing, one for each way a part can be stored and coloured.
#pragma once

#include "render/gl_objects.h"
#include "render/gl_pass.h"

#include <cstdint>
#include <map>
#include <string>

namespace crease {

// Where a fragment gets its normal from.
enum class NormalSource : std::uint8_t {
  PerVertex,    // SN: one per position, interpolated
  PerTriangle,  // FN: one per triangle, fetched by its number
  PerCorner,    // NSN: three per triangle, interpolated
};

enum class AlbedoSource : std::uint8_t {
  Uniform,    // one for the part
  Materials,  // by the triangle's material
  Corners,    // a colour per corner, times the material if there are any
  Errors,     // by a scalar per position, through the error scale
  Levels,     // the same through the scale of levels
};

struct ProgramKey {
  NormalSource normals = NormalSource::PerVertex;
  AlbedoSource albedo = AlbedoSource::Uniform;
  bool materials = false;  // with Corners
  bool textures = false;   // times the materials' textures; needs `pulled`
  bool wireframe = false;
  bool see_through = false;      // some of the materials are
  bool chooses_samples = false;  // of those
  Shown shown = Shown::All;      // of those, too
  // Vertices are fetched by the shader, three per triangle, so that each may have its own
  // attributes though positions are shared. Otherwise drawn indexed, positions being attributes.
  bool pulled = false;

  bool has_scalars() const {
    return albedo == AlbedoSource::Errors || albedo == AlbedoSource::Levels;
  }
  bool has_materials() const { return materials || albedo == AlbedoSource::Materials; }
  auto operator<=>(const ProgramKey&) const = default;
};

// One triangle that covers the picture, without attributes: for glDrawArrays(GL_TRIANGLES, 0, 3).
inline constexpr const char* kCoverVertexShader = R"(#version 330 core
void main() {
  gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 0.5, 1);
}
)";

// Texture units: buffer textures, then those of images.
namespace unit {
enum : int {
  Positions,
  Indices,
  Normals,
  Materials,
  MaterialColors,
  CornerColors,
  Scalars,
  CornerTexcoords,
  Textures,  // kTextureArrays of them
};
}  // namespace unit
// Attribute locations when not pulled.
namespace attribute {
enum : GLuint { Position, Normal, Scalar };
}  // namespace attribute

struct Program {
  GlProgram program;
  // Uniform locations, -1 where the program has no use for one.
  GLint clip_from_list = -1, eye_in_list = -1, unit = -1, albedo = -1, scalar_scale = -1;
  GLint first_triangle = -1;  // of the range that is drawn
  GLint key_light = -1, head_light = -1, up = -1, line_px = -1, turn = -1;
};

// Keep one as long as its context: NVIDIA's driver (580, seen) may draw the first picture of a
// program that took a deleted one's place with zeros for some attributes.
class ProgramCache {
 public:
  // Compiled on first use. Fails when the driver refuses.
  Result<const Program*> get(const ProgramKey& key);
  // One that is not of the three-part drawing. A name stands for the same sources every time.
  Result<const GlProgram*> get(const char* name, const char* vertex_source,
                               const char* fragment_source);

 private:
  std::map<ProgramKey, Program> programs_;
  std::map<std::string, GlProgram> others_;
};

}  // namespace crease
