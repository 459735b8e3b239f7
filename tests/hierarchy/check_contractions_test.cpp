#include "crease/contraction.h"
#include "support/mesh_zoo.h"
#include "support/random_contractions.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <string>

namespace crease {
namespace {

struct Broken {
  const char* what;                                // part of the message
  std::function<void(ContractionSequence&)> harm;  // done to a valid sequence
};

TEST_CASE("every broken promise of a sequence is found and named") {
  Mesh mesh = hard_box(3);
  const Grid grid = make_grid(mesh, {.bits = 10});
  snap(mesh, grid);
  const ContractionSequence valid =
      random_contractions(mesh, grid, {.seed = 5, .placement = Placement::Endpoint});
  REQUIRE(check_contractions(mesh, valid).ok());
  REQUIRE(valid.changes.size() > 2);
  REQUIRE(valid.derived.size() > 2);
  const auto first_with_change = [](ContractionSequence& s) -> Contraction& {
    for (Contraction& c : s.contractions) {
      if (c.change_count > 0) return c;
    }
    return s.contractions[0];
  };

  const Broken cases[] = {
      {"vertex out of range", [](auto& s) { s.contractions[2].removed = VertexId{9999}; }},
      {"a vertex with itself", [](auto& s) { s.contractions[2].kept = s.contractions[2].removed; }},
      {"removed before", [](auto& s) { s.contractions[2].removed = s.contractions[0].removed; }},
      {"not at an endpoint",
       [](auto& s) {
         s.contractions[2].position += Vec3i{1, 0, 0};
       }},
      {"not a number", [](auto& s) { s.contractions[2].error.line = -1; }},
      {"less than that of a contraction", [](auto& s) { s.contractions.back().error = {}; }},
      {"changes out of range", [](auto& s) { s.contractions[2].change_count = 1u << 30; }},
      {"derived triangles out of range", [](auto& s) { s.contractions[2].first_derived = ~0u; }},
      {"layer out of range", [](auto& s) { s.changes[0].layer = 7; }},
      {"attribute out of range", [](auto& s) { s.changes[0].to = AttributeId{99999}; }},
      {"becomes itself", [](auto& s) { s.changes[0].to = s.changes[0].from; }},
      {"does not stand", [](auto& s) { s.changes[0].from = s.changes.back().to; }},
      {"derived triangle out of range", [](auto& s) { s.derived[0] = TriangleId{99999}; }},
      {"derived twice", [](auto& s) { s.derived[1] = s.derived[0]; }},
      {"not finite", [](auto& s) { s.new_values[0].assign(3, std::nanf("")); }},
      {"odd number", [](auto& s) { s.new_values[0].push_back(1); }},
      {"changes twice",
       [&](auto& s) {
         Contraction& c = first_with_change(s);
         const AttributeChange change = s.changes_of(c)[0];
         c.first_change = static_cast<std::uint32_t>(s.changes.size());
         c.change_count = 2;
         s.changes.insert(s.changes.end(), 2, change);
       }},
      {"depend on their order",
       [&](auto& s) {
         Contraction& c = first_with_change(s);
         const AttributeChange change = s.changes_of(c)[0];
         c.first_change = static_cast<std::uint32_t>(s.changes.size());
         c.change_count = 2;
         s.changes.push_back(change);
         s.changes.push_back({change.layer, change.to, change.from});
       }},
  };
  for (const Broken& broken : cases) {
    CAPTURE(broken.what);
    ContractionSequence sequence = valid;
    broken.harm(sequence);
    const Status status = check_contractions(mesh, sequence);
    REQUIRE(!status.ok());
    CHECK(status.failure().error == Error::Invalid);
    CHECK_MESSAGE(status.failure().message.find(broken.what) != std::string::npos,
                  status.failure().message);
  }
}

TEST_CASE("random sequences of random complexes are valid") {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Mesh mesh = random_complex(seed, 12, 30);
    const Grid grid = make_grid(mesh, {.length = 0.25});
    snap(mesh, grid);
    const ContractionSequence s = random_contractions(
        mesh, grid,
        {.seed = seed, .placement = seed % 2 == 0 ? Placement::Endpoint : Placement::Optimal});
    const Status status = check_contractions(mesh, s);
    CHECK_MESSAGE(status.ok(), (status.ok() ? "" : status.failure().message));
  }
}

}  // namespace
}  // namespace crease
