// What a contraction sequence promises, on the zoo and on real models: it is legal, and it is the
// same to the bit whatever the number of threads.
#include "crease/import.h"
#include "crease/simplify.h"
#include "support/mesh_zoo.h"
#include "support/sanitized.h"
#include "support/shared_data.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace crease;

namespace {

template <typename T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

bool same_sequence(const ContractionSequence& a, const ContractionSequence& b) {
  static_assert(sizeof(Contraction) == 52, "no padding, so bits can be compared");
  bool same = same_bits(a.contractions, b.contractions) && same_bits(a.changes, b.changes) &&
              same_bits(a.derived, b.derived) && a.new_values.size() == b.new_values.size();
  for (std::size_t l = 0; same && l < a.new_values.size(); ++l) {
    same = same_bits(a.new_values[l], b.new_values[l]);
  }
  return same;
}

void check_all(Mesh mesh, std::uint32_t patch_triangles) {
  const Grid grid = make_grid(mesh, {});
  snap(mesh, grid);
  for (Placement placement : {Placement::Optimal, Placement::Endpoint}) {
    SimplifyOptions options;
    options.placement = placement;
    options.patch_triangles = patch_triangles;
    options.threads = 1;
    const ContractionSequence one = *simplify(mesh, grid, options);
    const Status legal = check_contractions(mesh, one);
    CHECK_MESSAGE(legal.ok(), (legal.ok() ? "" : legal.failure().message));
    for (int threads : {2, 7}) {
      options.threads = threads;
      CHECK(same_sequence(one, *simplify(mesh, grid, options)));
    }
    if (placement == Placement::Optimal) continue;
    // Endpoint placement never moves a vertex to a new place and makes no new attribute values.
    for (const std::vector<float>& values : one.new_values) CHECK(values.empty());
  }
}

}  // namespace

TEST_CASE("sequences of the zoo are legal and the same for 1, 2 and 7 threads" *
          doctest::test_suite("threads")) {
  for (const ZooMesh& z : mesh_zoo()) {
    CAPTURE(z.name);
    check_all(z.mesh, 200);  // many patches even for small meshes
  }
}

TEST_CASE("sequences of real models are legal and the same for 1, 2 and 7 threads" *
          doctest::test_suite("threads")) {
  for (const char* name : {"cad/hoppe_cessna.obj.zst", "city/berlin_52k.obj.zst",
                           "attributes/pirate.obj.zst", "nasty/topology_everything_twice.obj"}) {
    const std::filesystem::path path = shared_model(name);
    if (path.empty() || (kSanitized && std::filesystem::file_size(path) > 200'000)) continue;
    CAPTURE(name);
    check_all(import_mesh(path, {})->mesh, 4000);
  }
}

TEST_CASE("a part that disappears is in the error") {
  // Eight boxes in a row, each half of the one before, far apart.
  Mesh mesh = hard_box(1);
  const Mesh box = mesh;
  const std::size_t corners = box.positions.size();
  for (int i = 1; i < 8; ++i) {
    const double size = std::pow(0.5, i);
    for (const Vec3d& p : box.positions) mesh.positions.push_back(p * size + Vec3d{10.0 * i, 0, 0});
    for (const Triangle& t : box.triangles) {
      Triangle copy;
      for (int c = 0; c < 3; ++c) copy[c] = VertexId(index_of(t[c]) + corners * std::size_t(i));
      mesh.triangles.push_back(copy);
    }
    const std::vector<AttributeId>& of_corner = box.normals()->of_corner;
    mesh.layers[0].of_corner.insert(mesh.layers[0].of_corner.end(), of_corner.begin(),
                                    of_corner.end());
  }
  const Grid grid = make_grid(mesh, {});
  snap(mesh, grid);
  const ContractionSequence sequence = *simplify(mesh, grid, {});
  float told = 0;
  for (std::size_t n = 0; n < sequence.contractions.size(); ++n) {
    told = std::max(told, sequence.contractions[n].error.surface);
    const Level level = apply_contractions(mesh, sequence, n + 1);
    for (int i = 0; i < 8; ++i) {
      const auto begin = level.alive.begin() + std::ptrdiff_t(box.triangle_count()) * i;
      if (std::count(begin, begin + std::ptrdiff_t(box.triangle_count()), true) > 0) continue;
      CAPTURE(n);
      CAPTURE(i);
      CHECK(double(told) >= 0.5 * std::pow(0.5, i));
    }
  }
}

TEST_CASE("a part without area that disappears is not in the error") {
  Mesh mesh = hard_box(1);
  const std::size_t box_triangles = mesh.triangle_count(), first = mesh.positions.size();
  for (const double x : {5.0, 5.0, 9.0}) mesh.positions.push_back({x, 0, 0});
  mesh.triangles.push_back({VertexId(first), VertexId(first + 1), VertexId(first + 2)});
  mesh.layers[0].of_corner.insert(mesh.layers[0].of_corner.end(), 3, AttributeId{0});
  const Grid grid = make_grid(mesh, {});
  snap(mesh, grid);
  const ContractionSequence sequence = *simplify(mesh, grid, {});
  const Level level = apply_contractions(mesh, sequence, 1);
  REQUIRE(!level.alive[box_triangles]);
  CHECK(sequence.contractions[0].error.surface == 0);
}

TEST_CASE("work that is told to stop stops and says so") {
  Mesh mesh = smooth_sphere(40, 40);
  const Grid grid = make_grid(mesh, {});
  snap(mesh, grid);
  SimplifyOptions options;
  options.progress = [](const char*, double) { return false; };
  const Result<ContractionSequence> stopped = simplify(mesh, grid, options);
  REQUIRE(!stopped.ok());
  CHECK(stopped.failure().error == Error::Interrupted);
}
