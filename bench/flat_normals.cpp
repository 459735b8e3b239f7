// How a flat triangle gets its one normal on the GPU: four ways to draw the same FN triangles.
//
//   bench_flat_normals [--triangles 2000000] [--rounds 9] [--draws 1]
//
// All draw a rough terrain into the renderer's own target, with the same light; the last column
// counts pixels whose colour is not that of the first row. The first is what the renderer does.
#include "crease/vec.h"
#include "draw_time.h"
#include "render/gl_context.h"
#include "render/gl_objects.h"
#include "render/gl_target.h"

#include <CLI/CLI.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <vector>

namespace crease::bench {
namespace {

// FN triangles over shared positions.
struct Terrain {
  std::vector<Vec3f> positions;
  std::vector<std::uint32_t> indices;  // 3 a triangle
  std::vector<Vec3f> normals;          // one a triangle
};

Terrain make_terrain(int triangles) {
  const auto side = std::uint32_t(std::sqrt(triangles / 2.0));
  Terrain made;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> height(0, 0.6f / float(side));
  for (std::uint32_t y = 0; y <= side; ++y) {
    for (std::uint32_t x = 0; x <= side; ++x) {
      made.positions.push_back({float(x) / float(side), float(y) / float(side), height(random)});
    }
  }
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const auto at = [&](std::uint32_t i) {
      const Vec3f& p = made.positions[i];
      return Vec3d{double(p.x), double(p.y), double(p.z)};
    };
    const Vec3d normal = normalized(cross(at(b) - at(a), at(c) - at(a)));
    made.indices.insert(made.indices.end(), {a, b, c});
    made.normals.push_back({float(normal.x), float(normal.y), float(normal.z)});
  };
  for (std::uint32_t y = 0; y < side; ++y) {
    for (std::uint32_t x = 0; x < side; ++x) {
      const std::uint32_t i = y * (side + 1) + x;
      add(i, i + 1, i + side + 2);
      add(i, i + side + 2, i + side + 1);
    }
  }
  return made;
}

// The terrain with a vertex of its own for each triangle: the last, from which flat varyings come.
struct ProvokingVertices {
  std::vector<Vec3f> positions, normals;
  std::vector<std::uint32_t> indices;
};

ProvokingVertices with_provoking_vertices(const Terrain& terrain) {
  ProvokingVertices made;
  constexpr std::uint32_t kNone = ~0u;
  std::vector<std::uint32_t> any_at(terrain.positions.size(), kNone);
  for (std::uint32_t t = 0; t < terrain.normals.size(); ++t) {
    const std::uint32_t last = terrain.indices[3 * t + 2];
    any_at[last] = t;
    made.positions.push_back(terrain.positions[last]);
    made.normals.push_back(terrain.normals[t]);
  }
  for (std::uint32_t t = 0; t < terrain.normals.size(); ++t) {
    for (std::uint32_t c = 0; c < 2; ++c) {
      const std::uint32_t at = terrain.indices[3 * t + c];
      if (any_at[at] == kNone) {  // last of no triangle
        any_at[at] = std::uint32_t(made.positions.size());
        made.positions.push_back(terrain.positions[at]);
        made.normals.push_back({0, 0, 1});
      }
      made.indices.push_back(any_at[at]);
    }
    made.indices.push_back(t);
  }
  return made;
}

constexpr const char* kVertexShader = R"(
#if PULLED
uniform samplerBuffer positions;
uniform usamplerBuffer indices;
#else
layout(location = 0) in vec3 a_position;
#endif
#if NORMAL_IN == VERTEX_SHADER
uniform samplerBuffer normals;
flat out vec3 v_normal;
#elif NORMAL_IN == ATTRIBUTE
layout(location = 1) in vec3 a_normal;
flat out vec3 v_normal;
#endif
void main() {
#if PULLED
  vec3 position = texelFetch(positions, int(texelFetch(indices, gl_VertexID).r)).xyz;
#else
  vec3 position = a_position;
#endif
#if NORMAL_IN == VERTEX_SHADER
  v_normal = texelFetch(normals, gl_VertexID / 3).xyz;
#elif NORMAL_IN == ATTRIBUTE
  v_normal = a_normal;
#endif
  gl_Position = vec4(2 * position.xy - 1, 0.5 - position.z, 1);
}
)";

constexpr const char* kFragmentShader = R"(
#if NORMAL_IN == FRAGMENT_SHADER
uniform samplerBuffer normals;
#else
flat in vec3 v_normal;
#endif
out vec4 color;
void main() {
#if NORMAL_IN == FRAGMENT_SHADER
  vec3 normal = texelFetch(normals, gl_PrimitiveID).xyz;
#else
  vec3 normal = v_normal;
#endif
  color = vec4(vec3(0.2 + 0.8 * max(dot(normal, vec3(0.48, 0.36, 0.8)), 0)), 1);
}
)";

enum class NormalIn { VertexShader, FragmentShader, Attribute };

struct Way {
  const char* name;
  bool pulled;
  NormalIn normal_in;
};
constexpr std::array<Way, 4> kWays = {{
    {"indexed, the normal fetched for each fragment by gl_PrimitiveID", false,
     NormalIn::FragmentShader},
    {"pulled, the normal fetched by the vertex shader and passed on flat", true,
     NormalIn::VertexShader},
    {"pulled, the normal fetched for each fragment", true, NormalIn::FragmentShader},
    {"indexed, a flat attribute of a vertex of each triangle's own", false, NormalIn::Attribute},
}};

Result<GlProgram> make_program(const Way& way) {
  const std::string head =
      "#version 330 core\n#define VERTEX_SHADER 0\n#define FRAGMENT_SHADER 1\n"
      "#define ATTRIBUTE 2\n#define PULLED " +
      std::to_string(int(way.pulled)) + "\n#define NORMAL_IN " +
      std::to_string(int(way.normal_in)) + "\n";
  Result<GlProgram> program = link_program(head + kVertexShader, head + kFragmentShader);
  if (!program.ok()) return program;
  glUseProgram(program->id());
  const std::array<const char*, 3> names = {"positions", "indices", "normals"};
  for (int unit = 0; unit < 3; ++unit) {
    const GLint at = glGetUniformLocation(program->id(), names[std::size_t(unit)]);
    if (at >= 0) glUniform1i(at, unit);
  }
  return program;
}

struct Uploaded {
  GlArray positions, indices, normals;
  GlVertexArray vertices = GlVertexArray::make();
  std::size_t bytes() const { return positions.bytes + indices.bytes + normals.bytes; }
};

Uploaded upload_all(std::span<const Vec3f> positions, std::span<const std::uint32_t> indices,
                    std::span<const Vec3f> normals, bool normals_of_vertices) {
  Uploaded made;
  made.positions = upload(positions, GL_RGB32F);
  made.indices = upload(indices, GL_R32UI);
  made.normals = upload(normals, GL_RGB32F);
  glBindVertexArray(made.vertices.id());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, made.indices.buffer.id());
  for (GLuint at = 0; at < (normals_of_vertices ? 2u : 1u); ++at) {
    glBindBuffer(GL_ARRAY_BUFFER, (at == 0 ? made.positions : made.normals).buffer.id());
    glEnableVertexAttribArray(at);
    glVertexAttribPointer(at, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
  }
  return made;
}

Status print_table(const Terrain& terrain, int size, int rounds, int draws) {
  Result<GlContext> gl = open_gl();
  if (!gl.ok()) return gl.failure();
  Result<GlTarget> target = GlTarget::make(gl->limits(), size, size);
  if (!target.ok()) return target.failure();
  const Uploaded shared = upload_all(terrain.positions, terrain.indices, terrain.normals, false);
  const ProvokingVertices own = with_provoking_vertices(terrain);
  const Uploaded provoking = upload_all(own.positions, own.indices, own.normals, true);
  const GlVertexArray no_attributes = GlVertexArray::make();
  const auto corners = GLsizei(terrain.indices.size());

  std::array<GlProgram, kWays.size()> programs;
  for (std::size_t i = 0; i < kWays.size(); ++i) {
    Result<GlProgram> program = make_program(kWays[i]);
    if (!program.ok()) return program.failure();
    programs[i] = *std::move(program);
  }
  const auto draw = [&](std::size_t i) {
    const Uploaded& arrays = kWays[i].normal_in == NormalIn::Attribute ? provoking : shared;
    target->begin(size, size);
    glUseProgram(programs[i].id());
    bind_texels(arrays.positions, 0);
    bind_texels(arrays.indices, 1);
    bind_texels(arrays.normals, 2);
    glBindVertexArray(kWays[i].pulled ? no_attributes.id() : arrays.vertices.id());
    if (kWays[i].pulled) {
      glDrawArrays(GL_TRIANGLES, 0, corners);
    } else {
      glDrawElements(GL_TRIANGLES, corners, GL_UNSIGNED_INT, nullptr);
    }
    target->resolve(size, size);
  };

  std::array<std::vector<DrawTime>, kWays.size()> times;
  for (int round = -1; round < rounds; ++round) {  // the first compiles
    for (std::size_t i = 0; i < kWays.size(); ++i) {
      const DrawTime took = time_drawing(draws, [&] { draw(i); });
      if (round >= 0) times[i].push_back(took);
    }
  }
  std::vector<std::uint8_t> first;
  for (std::size_t i = 0; i < kWays.size(); ++i) {
    const bool is_own = kWays[i].normal_in == NormalIn::Attribute;
    std::vector<std::uint8_t> pixels(4 * std::size_t(size) * std::size_t(size));
    draw(i);
    target->read(size, size, pixels);
    if (i == 0) first = pixels;
    std::size_t different = 0;
    for (std::size_t p = 0; p < pixels.size(); p += 4) {
      different += !std::equal(&pixels[p], &pixels[p] + 4, &first[p]);
    }
    const DrawTime took = median(times[i]);
    std::printf("| %s | %d x %d | %.1f | %.3f | %.3f | %zu |\n", kWays[i].name, size, size,
                double((is_own ? provoking : shared).bytes()) / double(terrain.normals.size()),
                took.processor_ms, took.gpu_ms, different);
  }
  return Done{};
}

int run(int argc, char** argv) {
  CLI::App app{"How a flat triangle gets its one normal on the GPU"};
  int triangles = 2000000, rounds = 9, draws = 1;
  app.add_option("--triangles", triangles)->check(CLI::Range(2, 40000000));
  app.add_option("--rounds", rounds)->check(CLI::Range(1, 1000));
  app.add_option("--draws", draws, "frames that are timed together")->check(CLI::Range(1, 1000));
  CLI11_PARSE(app, argc, argv);
  const Terrain terrain = make_terrain(triangles);
  std::printf(
      "| how | pixels | bytes a triangle | processor, ms | GPU, ms | other pixels |\n"
      "|---|--:|--:|--:|--:|--:|\n");
  for (const int size : {100, 1080}) {
    const Status printed = print_table(terrain, size, rounds, draws);
    if (printed.ok()) continue;
    std::fprintf(stderr, "%s\n", printed.failure().message.c_str());
    return 1;
  }
  return 0;
}

}  // namespace
}  // namespace crease::bench

int main(int argc, char** argv) {
  return crease::bench::run(argc, argv);
}
