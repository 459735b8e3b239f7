#include "render/gl_shaders.h"

#include "render/palette.h"
#include "render/textures.h"

#include <cstdio>

namespace crease {

namespace {

constexpr const char* kVertexShader = R"(
uniform mat4 clip_from_list;
uniform vec3 eye_in_list;
uniform float unit;  // as clip coordinates have it
out vec3 v_from_eye;

#if PULLED
uniform samplerBuffer positions;
uniform usamplerBuffer indices;
#else
layout(location = 0) in vec3 a_position;
#endif

#if NORMALS == TRIANGLE
#if PULLED
flat out vec3 v_normal;
uniform samplerBuffer normals;
#endif
#else
centroid out vec3 v_normal;
#if PULLED
uniform samplerBuffer normals;
#else
layout(location = 1) in vec3 a_normal;
#endif
#endif

#if ALBEDO == CORNERS
centroid out vec3 v_color;
uniform samplerBuffer corner_colors;
#endif

#if SCALARS
centroid out float v_scalar;
#if PULLED
uniform samplerBuffer scalars;
#else
layout(location = 2) in float a_scalar;
#endif
#endif

#if MATERIALS && PULLED
flat out vec4 v_material;
uniform usamplerBuffer materials;
uniform samplerBuffer material_colors;  // two texels a material, see gl_materials.h
#endif
#if TEXTURES
flat out ivec2 v_texture;  // array and layer
flat out float v_cutoff;   // holes are where its alpha is below
flat out float v_blended;  // 1: its alpha is how much covers; 0: does not count
centroid out vec2 v_texcoord;
uniform samplerBuffer corner_texcoords;
#endif

#if WIREFRAME
out vec3 v_corner;
#endif

void main() {
#if PULLED
  int vertex = int(texelFetch(indices, gl_VertexID).r);
  vec3 position = texelFetch(positions, vertex).xyz;
#else
  vec3 position = a_position;
#endif

#if NORMALS == VERTEX && PULLED
  v_normal = texelFetch(normals, vertex).xyz;
#elif NORMALS == VERTEX
  v_normal = a_normal;
#elif NORMALS == TRIANGLE && PULLED
  v_normal = texelFetch(normals, gl_VertexID / 3).xyz;
#elif NORMALS == CORNER
  v_normal = texelFetch(normals, gl_VertexID).xyz;
#endif

#if ALBEDO == CORNERS
  v_color = texelFetch(corner_colors, gl_VertexID).rgb;
#elif SCALARS && PULLED
  v_scalar = texelFetch(scalars, vertex).r;
#elif SCALARS
  v_scalar = a_scalar;
#endif

#if MATERIALS && PULLED
  int material = 2 * int(texelFetch(materials, gl_VertexID / 3).r);
  v_material = texelFetch(material_colors, material);
#endif
#if TEXTURES
  vec4 texture_of_material = texelFetch(material_colors, material + 1);
  v_texture = ivec2(texture_of_material.xy);
  v_cutoff = texture_of_material.z;
  v_blended = texture_of_material.w;
  vec2 texcoord = texelFetch(corner_texcoords, gl_VertexID).xy;
  v_texcoord = vec2(texcoord.x, 1 - texcoord.y);  // an image's first row is its top
#endif

#if WIREFRAME
  int corner = gl_VertexID % 3;
  v_corner = vec3(corner == 0, corner == 1, corner == 2);
#endif

  v_from_eye = unit * (position - eye_in_list);
  gl_Position = clip_from_list * vec4(position, 1);
#if ONLY_SEEN_THROUGH
  // Triangles of other materials are nowhere: to discard their fragments takes as long as to draw.
  if (texelFetch(material_colors, material + 1).w == 0) gl_Position = vec4(2, 2, 2, 1);
#endif
}
)";

// Lights and eye are infinitely far away for the shading, so that a flat face has exactly one
// colour. Everything is linear; the framebuffer encodes sRGB.
constexpr const char* kFragmentShader = R"(
in vec3 v_from_eye;
out vec4 color;

uniform vec3 key_light, head_light, up;  // unit vectors towards

// Without pulling the triangle's own values are fetched here, by the number that it has in its part.
#define FETCHES_NORMAL (NORMALS == TRIANGLE && !PULLED)
#if FETCHES_NORMAL
uniform samplerBuffer normals;
#elif NORMALS == TRIANGLE
flat in vec3 v_normal;
#else
centroid in vec3 v_normal;
#endif
#if !PULLED
uniform int first_triangle;
#endif

#if ALBEDO == UNIFORM
uniform vec3 albedo;
#elif ALBEDO == CORNERS
centroid in vec3 v_color;
#elif SCALARS
centroid in float v_scalar;
uniform float scalar_scale;
#endif
#if MATERIALS && PULLED
flat in vec4 v_material;
#elif MATERIALS
uniform usamplerBuffer materials;
uniform samplerBuffer material_colors;
#endif

#if TEXTURES
flat in ivec2 v_texture;
flat in float v_cutoff;
flat in float v_blended;
centroid in vec2 v_texcoord;
uniform sampler2DArray textures_0, textures_1, textures_2, textures_3;

vec4 texture_color() {
  vec3 at = vec3(v_texcoord, v_texture.y);
  vec2 dx = dFdx(v_texcoord), dy = dFdy(v_texcoord);  // neighbours may go another way
  if (v_texture.x == 0) return textureGrad(textures_0, at, dx, dy);
  if (v_texture.x == 1) return textureGrad(textures_1, at, dx, dy);
  if (v_texture.x == 2) return textureGrad(textures_2, at, dx, dy);
  if (v_texture.x == 3) return textureGrad(textures_3, at, dx, dy);
  return vec4(1);
}
#endif

#if WIREFRAME
in vec3 v_corner;
uniform float line_px;

// How much of the pixel the triangle's edges cover.
float line_cover() {
  vec3 change = sqrt(dFdx(v_corner) * dFdx(v_corner) + dFdy(v_corner) * dFdy(v_corner));
  vec3 height_px = 1 / max(change, vec3(1e-6));
  vec3 distance_px = max(v_corner, vec3(0)) * height_px;
  // Lines closer together than they are wide fade to a tone, so that a dense mesh is not black.
  vec3 fade = 0.25 + 0.75 * smoothstep(vec3(1.5), vec3(9), height_px / line_px);
  vec3 cover = fade * clamp(0.5 * line_px + 0.5 - distance_px, 0, 1);
  return max(cover.x, max(cover.y, cover.z));
}
#endif

#if MASKS
uniform uint turn;

// As many of a pixel's samples as alpha says, on the average of two by two pixels, and others on
// each surface: so what lies behind shows through by as much, whichever is drawn first.
int samples_of(float alpha) {
  uvec2 at = uvec2(gl_FragCoord.xy);
  uint dither = ((at.x ^ at.y) & 1u) * 2u + (at.y & 1u);
  int count = int(4 * alpha + (float(dither) + 0.5) / 4);
  uint first = (at.x * 0x9e3779b1u) ^ (at.y * 0x85ebca77u) ^ (turn * 0xc2b2ae3du);
  first ^= floatBitsToUint(gl_FragCoord.z);
  first = (first ^ (first >> 15)) * 0x2c1b3c6du;
  first = (first ^ (first >> 12)) * 0x297a2d39u;
  int mask = ((1 << count) - 1) << (first >> 30);
  return ((mask | (mask >> 4)) & 15) * 0x11111111;  // targets of eight samples have each twice
}
#endif

// And how much of what is behind it covers.
vec4 surface_color() {
#if SCALARS
  return vec4(color_on_scale(clamp(v_scalar * scalar_scale, 0, 1)), 1);
#elif ALBEDO == UNIFORM
  return vec4(albedo, 1);
#else
  vec4 c = vec4(1);
#if MATERIALS && PULLED
  c = v_material;
#elif MATERIALS
  int material = int(texelFetch(materials, first_triangle + gl_PrimitiveID).r);
  c = texelFetch(material_colors, 2 * material);
#endif
#if MATERIALS && !MASKS
  c.a = max(c.a, 0.25);  // one sample of a pixel
#endif
#if TEXTURES
  vec4 of_texture = texture_color();
  if (of_texture.a < v_cutoff) discard;
  c *= vec4(of_texture.rgb, mix(1, of_texture.a, v_blended));
#endif
#if ALBEDO == CORNERS
  c.rgb *= mix(v_color / 12.92, pow((v_color + 0.055) / 1.055, vec3(2.4)),
               greaterThan(v_color, vec3(0.04045)));  // sRGB
#endif
  return c;
#endif
}

void main() {
#if FETCHES_NORMAL
  vec3 n = normalize(texelFetch(normals, first_triangle + gl_PrimitiveID).xyz);
#else
  vec3 n = normalize(v_normal);
#endif
  // The normal of the side that is seen. Told by the triangle's plane and not by the normal itself,
  // which may lean away near a silhouette and must then not be turned; and not by gl_FrontFacing,
  // as files have triangles that run against their own normals.
  vec3 plane = cross(dFdx(v_from_eye), dFdy(v_from_eye));
  float seen_side = -dot(plane, v_from_eye);
  // One across the plane, as where those of a thin wall's sides cancelled out, has no side, and
  // rounding is not to choose one.
  if (dot(n, plane) * sign(seen_side) < -0.01 * length(plane)) n = -n;

  vec4 base = surface_color();
#if ONLY_OPAQUE
  if (base.a < 1) discard;
#elif ONLY_SEEN_THROUGH
  if (base.a >= 1) discard;
#endif
  vec3 ambient = mix(vec3(0.110, 0.100, 0.092), vec3(0.290, 0.312, 0.345), 0.5 + 0.5 * dot(n, up));
  // Wrapped round the surface, so that no terminator cuts a dome in two.
  float key = pow(0.5 + 0.5 * dot(n, key_light), 2.3);
  float head = max(dot(n, head_light), 0);
  vec3 lights = ambient + key * vec3(0.86, 0.84, 0.80) + head * 0.08;
#if SCALARS
  lights = mix(vec3(1), lights, 0.6);  // form enough, and the scale can still be read
#endif
  vec3 half_way = normalize(key_light + head_light);
  float shine = pow(max(dot(n, half_way), 0), 48);
  vec3 light = base.rgb * lights + vec3(0.03 * shine);
  // White walls in full light bend towards white and do not clip.
  vec3 above = max(light - 0.75, vec3(0));
  light = min(light, vec3(0.75)) + 0.25 * (1 - exp(-4 * above));
#if WIREFRAME
  float line = line_cover();
  light = mix(light, vec3(0.012, 0.016, 0.024), 0.85 * line);
  base.a = max(base.a, line);
#endif
#if MASKS
  gl_SampleMask[0] = samples_of(base.a);
  base.a = 1;
#endif
  color = vec4(light, base.a);  // as many samples as that (GlScene::draw_part), whose alpha is then 1
}
)";

std::string scale_function(std::span<const ColorSrgb> scale) {
  std::string text = "vec3 color_on_scale(float share) {\n  const vec3 stops[" +
                     std::to_string(scale.size()) + "] = vec3[](";
  for (std::size_t i = 0; i < scale.size(); ++i) {
    const Color c = linear_from_srgb(scale[i]);
    char stop[96];
    std::snprintf(stop, sizeof stop, "%s\n    vec3(%.6f, %.6f, %.6f)", i == 0 ? "" : ",",
                  double(c[0]), double(c[1]), double(c[2]));
    text += stop;
  }
  const std::string last = std::to_string(scale.size() - 1);
  return text + ");\n  float at = share * " + last + ".0;\n  int i = min(int(at), " + last +
         " - 1);\n  return mix(stops[i], stops[i + 1], at - float(i));\n}\n";
}

std::string preamble(const ProgramKey& key) {
  const auto define = [](const char* name, int value) {
    return std::string("#define ") + name + " " + std::to_string(value) + "\n";
  };
  // Masks of samples are of OpenGL 4, and nearly everywhere; without them alpha itself is the mask.
  const std::string masks = !key.chooses_samples ? define("MASKS", 0)
                                                 : "#extension GL_ARB_sample_shading : enable\n"
                                                   "#ifdef GL_ARB_sample_shading\n" +
                                                       define("MASKS", 1) + "#else\n" +
                                                       define("MASKS", 0) + "#endif\n";
  return "#version 330 core\n" + masks + define("VERTEX", int(NormalSource::PerVertex)) +
         define("TRIANGLE", int(NormalSource::PerTriangle)) +
         define("CORNER", int(NormalSource::PerCorner)) +
         define("UNIFORM", int(AlbedoSource::Uniform)) +
         define("CORNERS", int(AlbedoSource::Corners)) + define("SCALARS", key.has_scalars()) +
         define("NORMALS", int(key.normals)) + define("ALBEDO", int(key.albedo)) +
         define("MATERIALS", key.has_materials()) + define("TEXTURES", key.textures) +
         define("WIREFRAME", key.wireframe) + define("PULLED", key.pulled) +
         define("ONLY_OPAQUE", key.shown == Shown::Opaque) +
         define("ONLY_SEEN_THROUGH", key.shown == Shown::SeenThrough);
}

Result<Program> build_program(const ProgramKey& key) {
  const std::string head = preamble(key);
  const std::span<const ColorSrgb> scale =
      key.albedo == AlbedoSource::Levels ? std::span<const ColorSrgb>(kLevelStops) : kErrorStops;
  Result<GlProgram> linked =
      link_program(head + kVertexShader, head + scale_function(scale) + kFragmentShader);
  if (!linked.ok()) return linked.failure();
  Program p;
  p.program = std::move(*linked);
  const GLuint id = p.program.id();
  glUseProgram(id);
  const auto set_unit = [&](const char* name, int number) {
    const GLint at = glGetUniformLocation(id, name);
    if (at >= 0) glUniform1i(at, number);
  };
  set_unit("positions", unit::Positions);
  set_unit("indices", unit::Indices);
  set_unit("normals", unit::Normals);
  set_unit("materials", unit::Materials);
  set_unit("material_colors", unit::MaterialColors);
  set_unit("corner_colors", unit::CornerColors);
  set_unit("scalars", unit::Scalars);
  set_unit("corner_texcoords", unit::CornerTexcoords);
  static_assert(kTextureArrays == 4);
  set_unit("textures_0", unit::Textures);
  set_unit("textures_1", unit::Textures + 1);
  set_unit("textures_2", unit::Textures + 2);
  set_unit("textures_3", unit::Textures + 3);
  p.clip_from_list = glGetUniformLocation(id, "clip_from_list");
  p.eye_in_list = glGetUniformLocation(id, "eye_in_list");
  p.unit = glGetUniformLocation(id, "unit");
  p.albedo = glGetUniformLocation(id, "albedo");
  p.scalar_scale = glGetUniformLocation(id, "scalar_scale");
  p.first_triangle = glGetUniformLocation(id, "first_triangle");
  p.key_light = glGetUniformLocation(id, "key_light");
  p.head_light = glGetUniformLocation(id, "head_light");
  p.up = glGetUniformLocation(id, "up");
  p.line_px = glGetUniformLocation(id, "line_px");
  p.turn = glGetUniformLocation(id, "turn");
  return p;
}

}  // namespace

Result<const Program*> ProgramCache::get(const ProgramKey& key) {
  const auto known = programs_.find(key);
  if (known != programs_.end()) return &known->second;
  Result<Program> built = build_program(key);
  if (!built.ok()) return built.failure();
  return &programs_.emplace(key, std::move(*built)).first->second;
}

Result<const GlProgram*> ProgramCache::get(const char* name, const char* vertex_source,
                                           const char* fragment_source) {
  const auto known = others_.find(name);
  if (known != others_.end()) return &known->second;
  Result<GlProgram> linked = link_program(vertex_source, fragment_source);
  if (!linked.ok()) return linked.failure();
  return &others_.emplace(name, std::move(*linked)).first->second;
}

}  // namespace crease
