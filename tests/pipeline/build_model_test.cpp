#include "crease/build.h"
#include "crease/progressive_mesh.h"
#include "crease/threads.h"
#include "support/level_equality.h"
#include "support/mesh_zoo.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <limits>

namespace crease {
namespace {

Case simplified(Mesh mesh, Placement placement) {
  Case c;
  c.mesh = std::move(mesh);
  const Grid grid = make_grid(c.mesh, {});
  snap(c.mesh, grid);
  SimplifyOptions options;
  options.placement = placement;
  Result<ContractionSequence> sequence = simplify(c.mesh, grid, options);
  REQUIRE(sequence.ok());
  c.sequence = std::move(*sequence);
  c.arrays = std::make_shared<const ProgressiveArrays>(
      arrange(c.mesh, c.sequence, restructure(c.mesh, c.sequence), &c.arrangement));
  return c;
}

TEST_CASE("what the simplifier makes is valid, and every level is that of the plain simulation") {
  for (const ZooMesh& z : mesh_zoo()) {
    for (Placement placement : {Placement::Endpoint, Placement::Optimal}) {
      CAPTURE(z.name);
      CAPTURE(static_cast<int>(placement));
      const Case c = simplified(z.mesh, placement);
      const Status valid = check_contractions(c.mesh, c.sequence);
      CHECK_MESSAGE(valid.ok(), (valid.ok() ? "" : valid.failure().message));
      const Status sound = check_progressive_arrays(*c.arrays);
      CHECK_MESSAGE(sound.ok(), (sound.ok() ? "" : sound.failure().message));
      if (!valid.ok() || !sound.ok()) continue;
      ProgressiveMesh pm(c.arrays);
      const std::size_t count = pm.contraction_count();
      const std::size_t step = 1 + count / (kSanitized ? 8 : 25);
      for (std::size_t n = 0; n <= count; n += step) {
        CAPTURE(n);
        pm.set_applied(n);
        CHECK(difference(c, pm, apply_contractions(c.mesh, c.sequence, n)) == "");
      }
      pm.set_applied(0);
      CHECK(difference(c, pm, apply_contractions(c.mesh, c.sequence, 0)) == "");
    }
  }
}

TEST_CASE("a smooth mesh stays smooth under the simplifier: three sections, two of them empty") {
  for (Placement placement : {Placement::Endpoint, Placement::Optimal}) {
    const Case c = simplified(smooth_sphere(24, 32), placement);
    CHECK(c.arrays->full.fn_triangles == 0);
    CHECK(c.arrays->full.nsn_triangles == 0);
    CHECK(c.arrays->full.nsn_vertices == 0);
  }
}

TEST_CASE("a built model is its file, and a stopped build says so") {
  const Result<Built> built = build_model(hard_cylinder(24, 4), {});
  REQUIRE(built.ok());
  const Result<BlockFile> file = BlockFile::open(memory_source(built->file_bytes));
  REQUIRE(file.ok());
  CHECK(validate_crease(*file).empty());
  CHECK(file->facts().bands.size() == built->statistics.bands.size());
  CHECK(file->block_count() == built->blocks);
  CHECK(file->facts().triangle_count == hard_cylinder(24, 4).triangle_count());

  // At its beginning and on the way.
  for (const double share : {0.0, 0.01, 0.5}) {
    BuildOptions options;
    options.simplify.patch_triangles = 300;
    options.simplify.threads = 1;
    double last = 0;
    options.simplify.progress = [&](const char* now, double done) {
      if (std::string(now) != "encode") return true;
      CHECK(done >= last);
      last = done;
      return done < share;
    };
    const Result<Built> stopped = build_model(smooth_sphere(40, 60), options);
    REQUIRE(!stopped.ok());
    CHECK(stopped.failure().error == Error::Interrupted);
    CHECK(last < share + 0.4);
  }
}

TEST_CASE("a mesh that is none, and options out of their ranges, are refused") {
  const auto refusal = [](auto change) {
    Mesh mesh = smooth_sphere(8, 12);
    BuildOptions options;
    change(mesh, options);
    const Result<Built> built = build_model(std::move(mesh), options);
    REQUIRE(!built.ok());
    return built.failure().error;
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  CHECK(refusal([&](Mesh& m, BuildOptions&) { m.layers[0].values[3] = nan; }) == Error::Invalid);
  CHECK(refusal([](Mesh& m, BuildOptions&) {
          m.material_of_triangle.assign(m.triangle_count(), MaterialId{7});
        }) == Error::Invalid);
  CHECK(refusal([&](Mesh& m, BuildOptions&) {
          m.materials = {{"paint", {nan, 0, 0, 1}, ""}};
        }) == Error::Invalid);
  CHECK(refusal([](Mesh&, BuildOptions& o) { o.simplify.patch_triangles = 0; }) == Error::Invalid);
  CHECK(refusal([&](Mesh&, BuildOptions& o) { o.simplify.normal_weight = nan; }) == Error::Invalid);
  CHECK(refusal([](Mesh&, BuildOptions& o) { o.simplify.normal_weight = -1; }) == Error::Invalid);
  for (const int bits : {-1, 1, 3, 17, 50}) {
    CAPTURE(bits);
    CHECK(refusal([&](Mesh&, BuildOptions& o) { o.attributes.normal_bits = bits; }) ==
          Error::BadValue);
    CHECK(refusal([&](Mesh&, BuildOptions& o) { o.attributes.texcoord_bits = bits; }) ==
          Error::BadValue);
    CHECK(refusal([&](Mesh&, BuildOptions& o) { o.attributes.color_bits = bits; }) ==
          Error::BadValue);
  }
}

TEST_CASE("a built file is the same for 1, 2 and 7 threads, and so is what is decoded" *
          doctest::test_suite("threads")) {
  for (const Mesh& mesh : {height_field(40), city_blocks(6, 3)}) {
    BuildOptions options;
    options.simplify.patch_triangles = 300;
    options.simplify.threads = 1;
    const Result<Built> alone = build_model(mesh, options);
    REQUIRE(alone.ok());
    const Result<BlockFile> file = BlockFile::open(memory_source(alone->file_bytes));
    REQUIRE(file.ok());
    CHECK(file->block_count() > 7);
    const Result<DecodedModel> model = decode_model(*file);
    REQUIRE(model.ok());
    for (const int threads : {2, 7}) {
      CAPTURE(threads);
      options.simplify.threads = threads;
      const Result<Built> built = build_model(mesh, options);
      REQUIRE(built.ok());
      CHECK(built->file_bytes == alone->file_bytes);
      const Result<DecodedModel> decoded =
          decode_model(*file, {.for_each = loop_on_threads(threads)});
      REQUIRE(decoded.ok());
      CHECK(decoded->mesh.positions == model->mesh.positions);
      CHECK(decoded->mesh.triangles == model->mesh.triangles);
      CHECK(decoded->mesh.layers[0].values == model->mesh.layers[0].values);
      CHECK(decoded->mesh.layers[0].of_corner == model->mesh.layers[0].of_corner);
    }
  }
}

TEST_CASE("a mesh without normals is refused") {
  Mesh mesh = smooth_sphere(8, 12);
  mesh.layers.clear();
  const Result<Built> built = build_model(std::move(mesh), {});
  REQUIRE_FALSE(built.ok());
  CHECK(built.failure().error == Error::Invalid);
}

}  // namespace
}  // namespace crease
