// A file says how wrong its blocks are at both ends; what a contraction between them adds is worked
// out again from the shape, and should be what the simplifier said.
#include "codec/encoded_model.h"
#include "crease/build_progressive_arrays.h"
#include "crease/compare.h"
#include "crease/decode_model.h"
#include "crease/import.h"
#include "crease/progressive_mesh.h"
#include "support/mesh_builder.h"
#include "support/mesh_zoo.h"
#include "support/sanitized.h"
#include "support/shared_data.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <tuple>
#include <vector>

namespace crease {
namespace {

using Place = std::tuple<std::int32_t, std::int32_t, std::int32_t>;

// By where v_s stands, where only one does.
std::map<Place, LevelError> errors_by_place(const ContractionSequence& sequence) {
  std::map<Place, LevelError> errors;
  std::map<Place, int> count;
  for (const Contraction& c : sequence.contractions) {
    const Place place{c.position.x, c.position.y, c.position.z};
    errors[place] = c.error;
    ++count[place];
  }
  std::erase_if(errors, [&](const auto& at) { return count[at.first] > 1; });
  return errors;
}

double median(std::vector<double> values) {
  REQUIRE(!values.empty());
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

struct Ratios {
  std::vector<double> surface;  // decoded over the simplifier's, above a grid step
  std::vector<double> turned;   // decoded less the simplifier's, degrees
};

Ratios ratios(const EncodedCase& c) {
  const BlockFile file = opened(c.bytes);
  const Result<DecodedModel> model = decode_model(file);
  REQUIRE(model.ok());
  const std::map<Place, LevelError> told = errors_by_place(c.sequence);
  Ratios result;
  for (const auto& [place, error] : errors_by_place(model->sequence)) {
    const auto at = told.find(place);
    if (at == told.end()) continue;
    const double step = c.sequence.grid.step;
    result.surface.push_back((double(error.surface) + step) / (double(at->second.surface) + step));
    result.turned.push_back(double(error.degrees) - double(at->second.degrees));
  }
  return result;
}

void check_errors(const EncodedCase& c) {
  const Ratios r = ratios(c);
  CHECK(r.surface.size() * 4 > c.sequence.contractions.size());
  CHECK(median(r.surface) == doctest::Approx(1).epsilon(0.05));
  const auto is_far = [](double ratio) { return ratio > 1.5 || ratio < 1 / 1.5; };
  CHECK(8 * std::size_t(std::count_if(r.surface.begin(), r.surface.end(), is_far)) <
        r.surface.size());
  CHECK(std::abs(median(r.turned)) < 1);
}

TEST_CASE("what is decoded is as wrong as the simplifier said") {
  check_errors(simplified_case(smooth_sphere(40, 60), 400, 14, kCoarsePrecision));
  for (const std::string name : {"scan/bunny_stanford.ply.xz", "cad/fandisk.off",
                                 "cad/kuka_iiwa14_robot.obj.zst", "city/delft_36k.obj.zst"}) {
    const std::filesystem::path path = shared_model(name);
    if (path.empty() || !std::filesystem::exists(path)) continue;
    if (kSanitized && name != "cad/fandisk.off") continue;
    INFO(name);
    Result<Imported> in = import_mesh(path, {});
    REQUIRE(in.ok());
    check_errors(simplified_case(std::move(in->mesh), 8000, 20, kCoarsePrecision));
  }
}

// By how much more than they say levels are off, everywhere, the most of some levels: `lost`, what
// of the full mesh is far from the level, and `added`, what of the level is far from the full mesh.
// Distances below a few steps of the grid are left out.
struct Understated {
  double lost = 0, added = 0;
};

Understated most_understated(const Mesh& full, const ContractionSequence& sequence, double said) {
  Understated most;
  for (const double left : {0.8, 0.5, 0.2, 0.05}) {
    const std::size_t count =
        sequence.contractions.size() - std::size_t(left * double(sequence.contractions.size()));
    const Level level = apply_contractions(full, sequence, count);
    const Mesh mesh = mesh_of_level(full, sequence, level);
    if (mesh.triangle_count() == 0) continue;
    LevelError error;
    for (std::size_t i = 0; i < count; ++i) {
      error = larger(error, sequence.contractions[i].error);
    }
    const Result<Comparison> measured = compare_meshes(full, mesh, {.samples = 1000, .threads = 1});
    REQUIRE(measured.ok());
    const double stated = said * double(std::max(error.surface, error.line));
    const auto take = [&](double far, double& into) {
      if (far < 8 * sequence.grid.step) return;
      into = std::max(into, stated > 0 ? far / stated : HUGE_VAL);
    };
    take(measured->distance.a_to_b.max, most.lost);
    take(measured->distance.b_to_a.max, most.added);
  }
  return most;
}

// Witnesses are points, all of them of the full mesh, and a tenth farther away does not count. Of
// what the level adds, as where a flat region fills its notch, only the displacement of lines is
// told, which is a mean. Without witnesses it was up to 4.1, decoded or not.
constexpr Understated kSimplified{1.8, 3}, kDecoded{1.6, 2.1};

bool operator<=(const Understated& a, const Understated& b) {
  return a.lost <= b.lost && a.added <= b.added;
}

void check_stated(const EncodedCase& c) {
  const Understated simplified = most_understated(c.mesh, c.sequence, 1);
  INFO("lost " << simplified.lost << ", added " << simplified.added);
  CHECK(simplified <= kSimplified);
  const BlockFile file = opened(c.bytes);
  const Result<DecodedModel> model = decode_model(file);
  REQUIRE(model.ok());
  const Understated decoded = most_understated(model->mesh, model->sequence, 1);
  INFO("decoded: lost " << decoded.lost << ", added " << decoded.added);
  CHECK(decoded <= kDecoded);
}

TEST_CASE("a level is hardly farther from the full mesh than it says") {
  for (ZooMesh& z : mesh_zoo()) {
    if (z.mesh.triangle_count() < 100) continue;
    INFO(z.name);
    check_stated(simplified_case(std::move(z.mesh), 400, 16, kCoarsePrecision));
  }
  for (const std::string name : {"cad/fandisk.off", "city/delft_36k.obj.zst"}) {
    const std::filesystem::path path = shared_model(name);
    if (path.empty() || !std::filesystem::exists(path) || kSanitized) continue;
    INFO(name);
    Result<Imported> in = import_mesh(path, {});
    REQUIRE(in.ok());
    check_stated(simplified_case(std::move(in->mesh), 8000, 20, kCoarsePrecision));
  }
}

// Leaves of a tree: cards of two quads in one plane, all over a ball, none of which touches
// another.
Mesh loose_cards(int count) {
  MeshBuilder b;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto direction = [&] { return normalized(Vec3d{any(random), any(random), any(random)}); };
  for (int i = 0; i < count; ++i) {
    const Vec3d out = direction();
    const Vec3d u = normalized(cross(out, direction())), v = normalized(cross(out, u));
    b.grid(out * (0.6 + 0.4 * std::abs(any(random))), u * 0.06, v * 0.12, 1, 2);
  }
  return b.take();
}

TEST_CASE("what cards lose before they join is told as little, though others have joined by then") {
  const int count = 800;
  const EncodedCase c = simplified_case(loose_cards(count), 8000, 24, kCoarsePrecision);
  const BlockFile file = opened(c.bytes);
  const Result<DecodedModel> model = decode_model(file);
  REQUIRE(model.ok());
  ProgressiveMesh levels(build_progressive_arrays(model->mesh, model->sequence));
  for (const int left : {3900, 3200, 2600, 2200, 1800}) {  // of 4000
    CAPTURE(left);
    levels.set_triangle_count(std::size_t(left) * std::size_t(count) / 1000);
    const Result<Comparison> measured = compare_meshes(c.mesh, levels.extract(), {.samples = 1000});
    REQUIRE(measured.ok());
    CHECK(double(levels.error().surface) <= 2 * measured->distance.a_to_b.max + 1e-5);
  }
}

TEST_CASE("a level that says half of how far it is from the full mesh is found out") {
  const EncodedCase c = simplified_case(smooth_sphere(40, 60), 400, 16, kCoarsePrecision);
  CHECK(most_understated(c.mesh, c.sequence, 0.5).lost > kSimplified.lost);
}

}  // namespace
}  // namespace crease
