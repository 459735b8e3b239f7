#include "pipeline/snap_attributes.h"

#include "crease/build.h"
#include "crease/build_progressive_arrays.h"
#include "crease/progressive_mesh.h"
#include "crease/shading.h"
#include "pipeline/fit_lattice.h"
#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

namespace crease {
namespace {

Vec3d direction(std::span<const float> v) {
  return {double(v[0]), double(v[1]), double(v[2])};
}

double degrees_between(std::span<const float> a, std::span<const float> b) {
  return degrees(
      std::atan2(length(cross(direction(a), direction(b))), dot(direction(a), direction(b))));
}

std::vector<AttributePrecision> precisions() {
  AttributePrecision coarse;
  coarse.normal_bits = 8;
  coarse.texcoord_bits = 4;
  coarse.color_bits = 4;
  AttributePrecision fine;
  fine.normal_bits = 10;
  fine.texcoord_bits = 12;
  fine.color_bits = 8;
  AttributePrecision deering;
  deering.normal_coding = NormalCoding::Deering;
  deering.normal_bits = 6;
  AttributePrecision exact;
  exact.normal_bits = exact.texcoord_bits = exact.color_bits = kExactBits;
  return {fine, coarse, deering, exact};
}

struct Snapped {
  std::vector<LayerCoding> codings;
  std::vector<SnappedLayer> layers;
};

Snapped snap_all(Mesh& mesh, const AttributePrecision& precision) {
  Snapped snapped;
  snapped.codings = codings_of(mesh, precision);
  snapped.layers = snap_to_codings(mesh, snapped.codings);
  return snapped;
}

// Corners at one vertex that share a value, as pairs of corners.
std::set<std::pair<std::size_t, std::size_t>> sharing_corners(const Mesh& mesh,
                                                              const AttributeLayer& layer) {
  std::vector<std::vector<std::size_t>> around(mesh.vertex_count());
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t corner = 0; corner < layer.of_corner.size(); ++corner) {
    for (std::size_t other : around[index_of(mesh.triangles[corner / 3][corner % 3])]) {
      if (layer.of_corner[other] == layer.of_corner[corner]) pairs.emplace(other, corner);
    }
    around[index_of(mesh.triangles[corner / 3][corner % 3])].push_back(corner);
  }
  return pairs;
}

TEST_CASE(
    "snapping keeps what is shared, joins what is equal at a vertex, and does nothing twice") {
  for (const ZooMesh& z : mesh_zoo()) {
    for (const AttributePrecision& precision : precisions()) {
      CAPTURE(z.name);
      CAPTURE(precision.normal_bits);
      Mesh mesh = z.mesh;
      const Snapped snapped = snap_all(mesh, precision);
      CHECK(check_mesh(mesh).ok());
      REQUIRE(snapped.codings.size() == mesh.layers.size());
      for (std::size_t l = 0; l < mesh.layers.size(); ++l) {
        const AttributeLayer& layer = mesh.layers[l];
        const auto before = sharing_corners(z.mesh, z.mesh.layers[l]);
        const auto after = sharing_corners(mesh, layer);
        CHECK(std::ranges::includes(after, before));
        for (const auto& [a, b] : after) {
          if (before.contains({a, b})) continue;
          CHECK(snapped.layers[l].joined > 0);
        }
        for (std::size_t a = 0; a < layer.of_corner.size(); ++a) {
          for (std::size_t b = a + 1; b < std::min(layer.of_corner.size(), a + 200); ++b) {
            if (mesh.triangles[a / 3][a % 3] != mesh.triangles[b / 3][b % 3]) continue;
            CHECK((layer.of_corner[a] == layer.of_corner[b]) ==
                  std::ranges::equal(layer.value(layer.of_corner[a]),
                                     layer.value(layer.of_corner[b])));
          }
        }
      }
      Mesh again = mesh;
      const Snapped second = snap_all(again, precision);
      for (std::size_t l = 0; l < mesh.layers.size(); ++l) {
        CHECK(again.layers[l].values == mesh.layers[l].values);
        CHECK(again.layers[l].of_corner == mesh.layers[l].of_corner);
        CHECK(second.layers[l].joined == 0);
      }
    }
  }
}

TEST_CASE("no value moves by more than its precision says, and exact ones not at all") {
  for (const ZooMesh& z : mesh_zoo()) {
    for (const AttributePrecision& precision : precisions()) {
      CAPTURE(z.name);
      Mesh mesh = z.mesh;
      const Snapped snapped = snap_all(mesh, precision);
      for (std::size_t l = 0; l < mesh.layers.size(); ++l) {
        const AttributeLayer &before = z.mesh.layers[l], &after = mesh.layers[l];
        const LayerCoding& coding = snapped.codings[l];
        if (coding.kind == LayerCoding::Kind::Exact) {
          for (std::size_t a = 0; a < before.of_corner.size(); ++a) {
            CHECK(std::ranges::equal(before.value(before.of_corner[a]),
                                     after.value(after.of_corner[a])));
          }
          continue;
        }
        double worst = 0;
        for (std::size_t corner = 0; corner < after.of_corner.size(); ++corner) {
          const auto was = before.value(before.of_corner[corner]);
          const auto is = after.value(after.of_corner[corner]);
          if (before.role == AttributeRole::Normal) {
            const double most = coding.kind == LayerCoding::Kind::Sextant ? 0.65
                                : coding.bits == 8                        ? 0.65
                                                                          : 0.16;
            CHECK(degrees_between(was, is) < most);
            worst = std::max(worst, degrees_between(was, is));
          } else {
            double squared = 0;
            for (std::size_t k = 0; k < was.size(); ++k) {
              squared += (double(was[k]) - double(is[k])) * (double(was[k]) - double(is[k]));
              CHECK(std::abs(double(was[k]) - double(is[k])) <= std::ldexp(1.0, -coding.bits - 1));
            }
            worst = std::max(worst, std::sqrt(squared));
          }
        }
        CHECK(worst <= snapped.layers[l].error_max * (1 + 1e-9));
      }
    }
  }
}

// Two walls that meet at 0.02 degrees, and two at 1 degree.
TEST_CASE("a crease that no code can tell vanishes, one that is seen stays") {
  for (double angle : {0.02, 1.0}) {
    CAPTURE(angle);
    Mesh mesh = hard_box(1);
    AttributeLayer& normals = *mesh.normals();
    const std::size_t normals_before = normals.value_count();
    // Every corner of the second triangle of a side gets a normal of its own, turned a little.
    std::vector<float> values;
    for (std::size_t corner = 0; corner < normals.of_corner.size(); ++corner) {
      Vec3d n = direction(normals.value(normals.of_corner[corner]));
      const double turn = corner / 3 % 2 == 0 ? 0 : radians(angle);
      const Vec3d across = std::abs(n.x) > 0.5 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
      n = n * std::cos(turn) + across * std::sin(turn);
      for (int k = 0; k < 3; ++k) values.push_back(static_cast<float>(n[k]));
    }
    normals.values = values;
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      for (std::size_t c = 0; c < 3; ++c) {
        normals.of_corner[3 * t + c] = AttributeId{static_cast<std::uint32_t>(3 * t)};
      }
    }
    AttributePrecision precision;
    precision.normal_bits = 10;
    const Snapped snapped = snap_all(mesh, precision);
    const std::set<AttributeId> used(mesh.normals()->of_corner.begin(),
                                     mesh.normals()->of_corner.end());
    CHECK(used.size() == (angle < 0.1 ? normals_before : 2 * normals_before));
    CHECK((snapped.layers[0].joined > 0) == (angle < 0.1));
  }
}

TEST_CASE("a smooth mesh finer than the codes stays smooth: equal values far apart stay apart") {
  Mesh mesh =
      smooth_sphere(400, 100);  // rings are half a degree apart, codes of 8 bits a whole one
  AttributePrecision precision;
  precision.normal_bits = 8;
  const Snapped snapped = snap_all(mesh, precision);
  CHECK(snapped.layers[0].joined == 0);
  for (TriangleKind kind : classify_shading(mesh).of_triangle) CHECK(kind == TriangleKind::SN);
  std::size_t equal_values = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const AttributeId* id = &mesh.normals()->of_corner[3 * t];
    CHECK(!(id[0] == id[1] && id[1] == id[2]));
    const auto value = [&](std::size_t c) { return mesh.normals()->value(id[c]); };
    equal_values +=
        std::ranges::equal(value(0), value(1)) && std::ranges::equal(value(1), value(2));
  }
  CHECK(equal_values > 0);
}

TEST_CASE("a box is snapped to itself, and zero-length normals stay") {
  for (const AttributePrecision& precision : precisions()) {
    Mesh box = hard_box(2);
    AttributeLayer& normals = *box.normals();
    std::fill_n(normals.values.begin(), 3, 0.0f);
    const Mesh before = box;
    snap_attributes(box, precision);
    CHECK(box.normals()->values == before.normals()->values);
    CHECK(box.normals()->of_corner == before.normals()->of_corner);
  }
}

TEST_CASE("new values are codes as well, and errors cover how far they moved") {
  std::size_t moved = 0;
  for (const ZooMesh& z : mesh_zoo()) {
    for (const AttributePrecision& precision : precisions()) {
      CAPTURE(z.name);
      Mesh mesh = z.mesh;
      const Grid grid = make_grid(mesh, {});
      snap(mesh, grid);
      const Snapped attributes = snap_all(mesh, precision);
      const Result<ContractionSequence> blended = simplify(mesh, grid, {});
      REQUIRE(blended.ok());
      ContractionSequence sequence = *blended;
      snap_new_values(sequence, mesh, attributes.codings);
      const Status valid = check_contractions(mesh, sequence);
      CHECK_MESSAGE(valid.ok(), (valid.ok() ? "" : valid.failure().message));
      CHECK(sequence.changes == blended->changes);
      for (std::size_t l = 0; l < mesh.layers.size(); ++l) {
        const LayerQuantizer quantizer(attributes.codings[l]);
        const std::size_t dimension = mesh.layers[l].dimension;
        std::vector<float> values = sequence.new_values[l];
        REQUIRE(values.size() == blended->new_values[l].size());
        for (std::size_t i = 0; i < values.size(); i += dimension) {
          quantizer.snap(std::span(values).subspan(i, dimension));
        }
        CHECK(values == sequence.new_values[l]);
      }
      for (std::size_t i = 0; i < sequence.contractions.size(); ++i) {
        const LevelError &before = blended->contractions[i].error,
                         &after = sequence.contractions[i].error;
        CHECK(after.surface == before.surface);
        CHECK(after.line == before.line);
        for (const AttributeChange& change : sequence.changes_of(sequence.contractions[i])) {
          const AttributeLayer& layer = mesh.layers[change.layer];
          if (index_of(change.to) < layer.value_count()) continue;
          const std::size_t at = (index_of(change.to) - layer.value_count()) * layer.dimension;
          const auto was =
              std::span(blended->new_values[change.layer]).subspan(at, layer.dimension);
          const auto is = std::span(sequence.new_values[change.layer]).subspan(at, layer.dimension);
          if (layer.role == AttributeRole::Normal) {
            CHECK(after.degrees + 1e-4 >=
                  std::min(180.0, before.degrees + degrees_between(was, is)));
          } else if (layer.role == AttributeRole::TexCoord) {
            const double distance =
                std::hypot(double(was[0]) - double(is[0]), double(was[1]) - double(is[1]));
            CHECK(after.texture + 1e-6 >= before.texture + distance);
          }
          moved += !std::ranges::equal(was, is);
        }
      }
    }
  }
  CHECK(moved > 100);
}

TEST_CASE("the file's full level has the snapped values, every other level codes only") {
  AttributePrecision precision;
  precision.normal_bits = 9;
  Mesh snapped = height_field(20);
  const Mesh input = snapped;
  snap(snapped, make_grid(snapped, {}));
  const Snapped attributes = snap_all(snapped, precision);
  BuildOptions options;
  options.attributes = precision;
  const Result<Built> built = build_model(input, options);
  REQUIRE(built.ok());
  REQUIRE(built->snapped.size() == snapped.layers.size());
  const Result<BlockFile> file = BlockFile::open(memory_source(built->file_bytes));
  REQUIRE(file.ok());
  const Result<DecodedModel> model = decode_model(*file);
  REQUIRE(model.ok());
  ProgressiveMesh pm(build_progressive_arrays(model->mesh, model->sequence));
  for (std::size_t applied : {std::size_t(0), pm.contraction_count() / 2}) {
    pm.set_applied(applied);
    const Mesh level = pm.extract();
    for (std::size_t l = 0; l < level.layers.size(); ++l) {
      const LayerQuantizer quantizer(attributes.codings[l]);
      AttributeLayer copy = level.layers[l];
      const std::size_t dimension = copy.dimension;
      for (std::size_t i = 0; i < copy.values.size(); i += dimension) {
        quantizer.snap(std::span(copy.values).subspan(i, dimension));
      }
      CHECK(copy.values == level.layers[l].values);
    }
    if (applied > 0) continue;
    for (std::size_t l = 0; l < level.layers.size(); ++l) {
      const auto values_at_corners = [&](const AttributeLayer& layer) {
        std::multiset<std::vector<float>> all;
        for (AttributeId a : layer.of_corner) {
          const auto value = layer.value(a);
          all.emplace(value.begin(), value.end());
        }
        return all;
      };
      CHECK(values_at_corners(level.layers[l]) == values_at_corners(snapped.layers[l]));
    }
  }
}

float worst_distance(const NumberLattice& lattice, std::span<const float> values) {
  float worst = 0;
  for (float x : values) {
    worst = std::max(worst, std::abs(lattice.value(lattice.nearest(x)) - x));
  }
  return worst;
}

TEST_CASE("numbers on a coarse lattice are kept exactly") {
  std::mt19937 random(5);
  for (int largest : {255, 127}) {  // as importers make them: three ways to divide
    std::vector<float> bytes;
    for (int i = 0; i < 3000; ++i) {
      const int k = static_cast<int>(random() % static_cast<unsigned>(largest + 1));
      bytes.push_back(i % 3 == 0   ? static_cast<float>(k) / static_cast<float>(largest)
                      : i % 3 == 1 ? static_cast<float>(double(k) / largest)
                                   : static_cast<float>(k * (1.0 / largest)));
    }
    const NumberLattice lattice = fit_lattice(bytes, 8);
    CHECK(lattice.divisor == static_cast<float>(largest));
    CHECK(worst_distance(lattice, bytes) == 0);
  }
  const NumberLattice texels = fit_lattice(std::vector<float>{0, 0.25f, 17.5f / 1024, 1}, 12);
  CHECK(texels.divisor == 2048);
  CHECK(texels.high == 2048);
  CHECK(fit_lattice(std::vector<float>{-8, 24, 1024}, 12).divisor == 0.125f);
  CHECK(fit_lattice(std::vector<float>{0, 0, 0}, 8).value(0) == 0);
  CHECK(fit_lattice(std::vector<float>{0.3f, 0.3f}, 8).value(0) == 0.3f);
  CHECK(fit_lattice({}, 8).high == 0);
}

TEST_CASE("grains are no larger than files have them") {
  for (const float end : {1.0f, 64.0f, 256.0f, 65536.0f}) {
    const NumberLattice lattice =
        fit_lattice(std::vector<float>{0, end}, kMaxLatticeBits, kMaxLatticeBits);
    CHECK(lattice.grain > 1);
    CHECK(lattice.grain <= kMostGrain);
    CHECK(worst_distance(lattice, std::vector<float>{0, end}) == 0);
  }
}

TEST_CASE("textures that repeat lie still") {
  std::mt19937 random(7);
  for (const double repeats : {0.5, 1.0, 3.0, 4.0, 80.0, 200.0, 1000.0, 5000.0}) {
    CAPTURE(repeats);
    Mesh mesh = torus(24, 12);
    AttributeLayer uv{"uv", AttributeRole::TexCoord, Interpolation::Linear, 2, {}, {}};
    std::uniform_real_distribution<float> any(0, float(repeats));
    for (std::size_t i = 0; i < 3 * mesh.triangle_count(); ++i) {
      uv.values.insert(uv.values.end(), {any(random), any(random)});
      uv.of_corner.push_back(AttributeId(std::uint32_t(i)));
    }
    const std::vector<float> before = uv.values;
    const std::vector<AttributeId> of_corner = uv.of_corner;
    mesh.layers.push_back(std::move(uv));
    REQUIRE(snap_attributes(mesh, {.texcoord_bits = 12}).size() == mesh.layers.size());
    const AttributeLayer& after = mesh.layers.back();
    double worst = 0;
    for (std::size_t corner = 0; corner < of_corner.size(); ++corner) {
      const auto value = after.value(after.of_corner[corner]);
      for (std::size_t k = 0; k < 2; ++k) {
        const float was = before[2 * index_of(of_corner[corner]) + k];
        worst = std::max(worst, std::abs(double(value[k]) - double(was)));
      }
    }
    CHECK(worst > 0);
    CHECK(worst <= std::min(repeats * std::exp2(-13), std::exp2(-11)));
  }
}

TEST_CASE("a few numbers are kept in a table, many are off by half a step") {
  std::mt19937 random(6);
  std::uniform_real_distribution<float> real(-0.7f, 3.1f);
  std::vector<float> palette, few, many;
  for (int i = 0; i < 200; ++i) palette.push_back(real(random));
  for (int i = 0; i < 4000; ++i) few.push_back(palette[random() % palette.size()]);
  for (int i = 0; i < 4000; ++i) many.push_back(real(random));
  const NumberLattice table = fit_lattice(few, 8);
  CHECK(table.palette.size() == 200);
  CHECK(worst_distance(table, few) == 0);
  for (int bits : {4, 8, 12, 16}) {
    const NumberLattice lattice = fit_lattice(many, bits);
    CHECK(lattice.palette.empty());
    CHECK(double(worst_distance(lattice, many)) <= 3.8 / std::ldexp(1.0, bits + 1));
    CHECK(lattice.high - lattice.low <= 2 << bits);
    for (std::int32_t code = lattice.low; code <= lattice.high; ++code) {
      CHECK(lattice.nearest(lattice.value(code)) == code);
    }
  }
}

TEST_CASE("coarse lattices have grains: the input's values exactly, and blends between them") {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> real(-0.7f, 3.1f);
  std::vector<float> palette, few, texels, bytes;
  for (int i = 0; i < 100; ++i) palette.push_back(real(random));
  for (int i = 0; i < 4000; ++i) few.push_back(palette[random() % palette.size()]);
  for (int i = 0; i < 4000; ++i) texels.push_back(static_cast<float>(random() % 60) / 32 - 1);
  for (int i = 0; i < 4000; ++i) bytes.push_back(static_cast<float>(random() % 256) / 255);
  for (const std::vector<float>& values : {few, texels, bytes}) {
    for (const int blend_bits : {9, 12}) {
      const NumberLattice lattice = fit_lattice(values, 14, blend_bits);
      CHECK(worst_distance(lattice, values) == 0);
      for (float x : values) CHECK(lattice.nearest(x) % lattice.grain == 0);
      CHECK(lattice.low % lattice.grain == 0);
      CHECK(lattice.high % lattice.grain == 0);
      CHECK(lattice.high - lattice.low >= (1 << blend_bits) - 1);
      CHECK(lattice.high - lattice.low < 2 << blend_bits);
      for (std::int32_t code = lattice.low; code < lattice.high; ++code) {
        CHECK(lattice.value(code) < lattice.value(code + 1));
        CHECK(lattice.nearest(lattice.value(code)) == code);
      }
    }
  }
  CHECK(fit_lattice(texels, 14, 12).divisor == 32 * 128);
  CHECK(fit_lattice(bytes, 14, 7).grain == 1);
  CHECK(fit_lattice(std::vector<float>{0.3f, 0.3f}, 14, 12).grain == 1);
}

// A height field whose texture coordinates are a regular grid, or off one by less than their bits.
Mesh textured_field(int size, float jitter) {
  Mesh mesh = height_field(size);
  AttributeLayer uv{.name = "uv",
                    .role = AttributeRole::TexCoord,
                    .interpolation = Interpolation::Linear,
                    .dimension = 2,
                    .values = {},
                    .of_corner = {}};
  std::mt19937 random(8);
  std::uniform_real_distribution<float> off(-jitter, jitter);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3d p = mesh.positions[v];
    for (const double x : {p.x, p.y}) {
      const double cells = size;
      uv.values.push_back(static_cast<float>(std::round(x * cells) / cells) + off(random));
    }
  }
  for (const Triangle& t : mesh.triangles) {
    for (VertexId v : t) uv.of_corner.push_back(AttributeId{static_cast<std::uint32_t>(v)});
  }
  mesh.layers.push_back(std::move(uv));
  return mesh;
}

TEST_CASE("textures on a regular grid waver no more than on one that is not quite") {
  std::vector<float> errors;
  for (const float jitter : {0.0f, 2e-6f}) {
    Mesh mesh = textured_field(32, jitter);
    const Grid grid = make_grid(mesh, {});
    snap(mesh, grid);
    const Mesh exact = mesh;
    const Snapped snapped = snap_all(mesh, {});
    if (jitter == 0) CHECK(mesh.layers.back().values == exact.layers.back().values);
    Result<ContractionSequence> sequence = simplify(mesh, grid, {});
    REQUIRE(sequence.ok());
    snap_new_values(*sequence, mesh, snapped.codings);
    float most = 0;
    for (std::size_t i = 0; i < mesh.vertex_count() / 2; ++i) {
      most = std::max(most, sequence->contractions[i].error.texture);
    }
    errors.push_back(most);
  }
  CHECK(errors[0] < 1.5f * errors[1]);
}

TEST_CASE("lattices reach as far as floats do") {
  for (float scale : {1e-30f, 1e-20f, 1e20f, 3e38f}) {
    CAPTURE(scale);
    std::vector<float> values;
    for (int i = 0; i < 1000; ++i) values.push_back(scale * std::sin(static_cast<float>(i)));
    const NumberLattice lattice = fit_lattice(values, 8);
    CHECK(worst_distance(lattice, values) <= scale / 256);
  }
  std::vector<float> far;  // a small range far from zero: floats are no finer than this
  for (int i = 0; i < 1000; ++i) far.push_back(1e6f + static_cast<float>(i * 37 % 1000) / 16);
  CHECK(worst_distance(fit_lattice(far, 16), far) == 0);
}

}  // namespace
}  // namespace crease
