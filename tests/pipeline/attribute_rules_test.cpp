#include "assemble/attribute_rules.h"

#include <doctest/doctest.h>

#include <vector>

namespace crease {
namespace {

struct Rules {
  AttributeLayer layer;
  ContractionSequence sequence;  // Optimal
  std::vector<AttributeId> results;

  explicit Rules(Interpolation interpolation, std::uint32_t dimension, std::vector<float> values)
      : layer{"layer", AttributeRole::Other, interpolation, dimension, std::move(values), {}} {}

  // Returns the value that each candidate ends with, empty if it is removed.
  std::vector<std::vector<float>> apply(std::vector<Candidate> candidates,
                                        std::vector<std::pair<std::uint32_t, std::uint32_t>> links,
                                        std::vector<AttributeChange> changes = {}) {
    RuledValues values(layer, sequence, 0);
    AttributeRules rules;
    const auto ids = rules.apply(candidates, links, changes, 0, values);
    results.assign(ids.begin(), ids.end());
    std::vector<std::vector<float>> found;
    for (AttributeId id : results) {
      found.emplace_back();
      if (id == kNoAttribute) continue;
      const auto value = values.value(id);
      found.back().assign(value.begin(), value.end());
    }
    return found;
  }
};

Candidate shown(std::uint32_t id) {
  return {AttributeId{id}, true, true, false};
}
Candidate blind(std::uint32_t id) {
  return {AttributeId{id}, true, false, false};
}
Candidate face(Candidate c) {
  c.is_face_value = true;
  return c;
}
Candidate dead(Candidate c) {
  c.is_live = false;
  return c;
}

using Values = std::vector<std::vector<float>>;

TEST_CASE("blind attributes that a collapsed triangle links become one, half way between") {
  Rules linear(Interpolation::Linear, 1, {2, 4, 9});
  CHECK(linear.apply({blind(0), blind(1)}, {{0, 1}}) == Values{{3}, {3}});
  CHECK(linear.results[0] == linear.results[1]);
  CHECK(linear.apply({blind(0), blind(1), blind(2)}, {{0, 2}, {1, 2}}) == Values{{5}, {5}, {5}});
  CHECK(linear.apply({blind(0), blind(1)}, {}) == Values{{2}, {4}});
}

TEST_CASE("directions meet on the sphere, opposite ones do not") {
  Rules normals(Interpolation::Direction, 3, {1, 0, 0, 0, 1, 0, -1, 0, 0});
  const Values met = normals.apply({blind(0), blind(1)}, {{0, 1}});
  CHECK(met[0][0] == doctest::Approx(std::sqrt(0.5)));
  CHECK(met[0][1] == doctest::Approx(std::sqrt(0.5)));
  CHECK(normals.apply({blind(0), blind(2)}, {{0, 1}})[1] == std::vector<float>{1, 0, 0});
}

TEST_CASE("categorical values stay apart, linked or not") {
  Rules categories(Interpolation::Categorical, 1, {2, 4});
  CHECK(categories.apply({blind(0), blind(1)}, {{0, 1}}) == Values{{2}, {4}});
}

TEST_CASE("face values stay what they are; others join a single one") {
  Rules linear(Interpolation::Linear, 1, {2, 4, 9});
  CHECK(linear.apply({face(blind(0)), face(blind(1))}, {{0, 1}}) == Values{{2}, {4}});
  CHECK(linear.apply({face(blind(0)), blind(1)}, {{0, 1}}) == Values{{2}, {2}});
}

TEST_CASE("the record decides for what a level shows, and draws blind attributes along") {
  Rules linear(Interpolation::Linear, 1, {2, 4, 9});
  CHECK(linear.apply({shown(0), shown(1)}, {{0, 1}}) == Values{{2}, {4}});
  CHECK(linear.apply({shown(0), shown(1)}, {}, {{0, AttributeId{0}, AttributeId{1}}}) ==
        Values{{4}, {4}});
  CHECK(linear.apply({shown(0), blind(1)}, {{0, 1}}, {{0, AttributeId{0}, AttributeId{2}}}) ==
        Values{{9}, {9}});
  CHECK(linear.apply({shown(0), blind(1)}, {}, {{1, AttributeId{0}, AttributeId{2}}}) ==
        Values{{2}, {4}});  // a change of another layer
}

TEST_CASE("attributes that no cut shows are removed, and link what they linked") {
  Rules linear(Interpolation::Linear, 1, {2, 4, 9});
  CHECK(linear.apply({blind(0), dead(blind(2)), blind(1)}, {{0, 1}, {1, 2}}) ==
        Values{{3}, {}, {3}});
}

TEST_CASE("equal indices are one attribute, whatever is between them") {
  Rules linear(Interpolation::Linear, 1, {2, 4});
  linear.apply({blind(0), blind(1), blind(0)}, {});
  CHECK(linear.results[0] == linear.results[2]);
  CHECK(linear.results[0] != linear.results[1]);
}

}  // namespace
}  // namespace crease
