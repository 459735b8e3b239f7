// A file says how wrong its blocks are at both ends; what a contraction between them adds is worked
// out again from the shape, and should be what the simplifier said.
#include "codec/encoded_model.h"
#include "crease/decode_model.h"
#include "crease/import.h"
#include "support/mesh_zoo.h"
#include "support/sanitized.h"
#include "support/shared_data.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
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
  CHECK(10 * std::size_t(std::count_if(r.surface.begin(), r.surface.end(), is_far)) <
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

}  // namespace
}  // namespace crease
