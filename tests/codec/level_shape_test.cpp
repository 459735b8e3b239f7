// Levels between the ends of a block, whose order no file has, are shapes as good as the ends are.
#include "codec/encoded_model.h"
#include "crease/decode_model.h"
#include "support/facade.h"
#include "support/mesh_builder.h"
#include "support/sanitized.h"
#include "support/steeples.h"
#include "support/trunk.h"
#include "support/village.h"

#include <doctest/doctest.h>

#include <cmath>

namespace crease {
namespace {

// A regular grid over x and y from 0 to 1: land with hills, and a flat sea where they would be
// deep.
Mesh coast(int cells) {
  MeshBuilder builder;
  const auto at = [&](int x, int y) {
    const double u = double(x) / cells, v = double(y) / cells;
    const double height = std::sin(5 * u + 1) * std::cos(7 * v) + 0.2 * std::sin(31 * u * v);
    return builder.at({u, v, 0.2 * std::fmax(0.0, height)});
  };
  const AttributeId up = builder.normal({0, 0, 1});
  for (int y = 0; y < cells; ++y) {
    for (int x = 0; x < cells; ++x) {
      builder.quad({at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)}, up);
    }
  }
  return builder.take();
}

// After this share of its contractions.
Mesh level_after(double share, const DecodedModel& model) {
  const std::size_t count = std::size_t(share * double(model.sequence.contractions.size()));
  return mesh_of_level(model.mesh, model.sequence,
                       apply_contractions(model.mesh, model.sequence, count));
}

}  // namespace

TEST_CASE("hardly a triangle of a flat sea faces down at any level") {
  const EncodedCase c = simplified_case(coast(kSanitized ? 90 : 180), 16'000, 14, kCoarsePrecision);
  const Result<DecodedModel> model = decode_model(opened(c.bytes));
  REQUIRE(model.ok());
  std::size_t most = 0;
  for (const double share : {0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6}) {
    const Mesh level = level_after(share, *model);
    std::size_t down = 0;
    for (const Triangle& t : level.triangles) {
      const auto at = [&](std::size_t i) { return level.positions[index_of(t[i])]; };
      down += cross(at(1) - at(0), at(2) - at(0)).z < 0;
    }
    most = std::max(most, down);
  }
  CHECK(most <= 4);
}

TEST_CASE("boxes of a village that comes from a file are whole or gone at every level") {
  const EncodedCase c = simplified_case(village(), 2'000, 14, kCoarsePrecision);
  const Result<DecodedModel> model = decode_model(opened(c.bytes));
  REQUIRE(model.ok());
  std::size_t any_gone = 0;
  for (const double share : {0.5, 0.8, 0.85, 0.9, 0.93, 0.96, 0.98}) {
    const Mesh level = level_after(share, *model);
    const BoxCount boxes = count_boxes(c.mesh, level);
    CAPTURE(share);
    CHECK(boxes.broken <= kBoxes / 25);
    any_gone += boxes.gone > 0 && boxes.whole > 0;
  }
  CHECK(any_gone >= 2);
}

TEST_CASE("windows of a facade that comes from a file are whole or gone at every level") {
  const EncodedCase c = simplified_case(facade(), 2'000, 14, kCoarsePrecision);
  const Result<DecodedModel> model = decode_model(opened(c.bytes));
  REQUIRE(model.ok());
  std::size_t any_gone = 0;
  for (const double share : {0.3, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95}) {
    const WindowCount windows = count_windows(c.mesh, level_after(share, *model));
    CAPTURE(share);
    CHECK(windows.broken <= kWindows / 20);
    any_gone += windows.gone > 0 && windows.whole > 0;
  }
  CHECK(any_gone >= 2);
}

TEST_CASE("no spire of a model from a file floats over a drum that is gone") {
  const EncodedCase c = simplified_case(steeples(), 2'000, 14, kCoarsePrecision);
  const Result<DecodedModel> model = decode_model(opened(c.bytes));
  REQUIRE(model.ok());
  bool any_gone = false;
  for (const double share : {0.5, 0.7, 0.8, 0.85, 0.9, 0.93, 0.95, 0.97, 0.98, 0.99}) {
    const SteepleCount steeples = count_steeples(level_after(share, *model));
    CAPTURE(share);
    CHECK(steeples.floating <= kSteeples / 20);
    any_gone |= steeples.whole > kSteeples / 10 && steeples.whole < kSteeples * 9 / 10;
  }
  CHECK(any_gone);
}

TEST_CASE("small pieces amid what is larger are worth their shading") {
  const EncodedCase c = simplified_case(trunk_amid_hills(), 2'000, 14, kCoarsePrecision);
  const Result<DecodedModel> model = decode_model(opened(c.bytes));
  REQUIRE(model.ok());
  for (const double share : {0.5, 0.7, 0.8, 0.85}) {
    CAPTURE(share);
    CHECK(count_pieces(level_after(share, *model)) == kPieces);  // 6 of the last by distances
  }
}

}  // namespace crease
