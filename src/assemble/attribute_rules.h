// What becomes of the attributes at v_t and v_u: the rules of one contraction, for one layer.
//
// G03 3.4: a collapsed triangle links the attributes it has at v_t and at v_u. Of
// what is linked, the attributes that are live at v_s become one; those that are not are removed.
// This differs in three places, each with its reason:
// (1) The contraction's record decides for all that a linear level shows at v_s: an attribute
//     becomes what its AttributeChange says, or stays what it is. So the levels of this hierarchy
//     are those of apply_contractions(). The simplifier follows G03, but does not join two face
//     values, which never change (DB03 rule b), and knows no attribute that only other cuts show.
// (2) Attributes with equal ids are one, linked by a triangle or not.
// (3) An attribute that no level shows, blind or about to be, joins what it is linked with if that
//     is one attribute; is joined with other such ones if there is nothing else; and stays apart
//     where face values or categorical values would have to become one.
#pragma once

#include "crease/contraction.h"
#include "crease/mesh.h"
#include "mesh/octahedral.h"

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace crease {

// An attribute at v_t or v_u.
struct Candidate {
  AttributeId id{};
  bool is_live = false;   // at v_s: some cut shows it there
  bool is_shown = false;  // some linear level shows it at v_s, right after the contraction
  bool is_face_value = false;
};

// The values of a layer: the input's, the sequence's, and those that rule (3) makes.
class RuledValues {
 public:
  RuledValues(const AttributeLayer& source, const ContractionSequence& sequence, std::size_t layer);

  std::span<const float> value(AttributeId id) const;
  // A new attribute between these: on the sphere, and on the source's lattice if that has one, or
  // component by component. Inherits the first one's, and its id, where placement is at endpoints
  // or directions are opposite.
  AttributeId blend(std::span<const AttributeId> ids);
  bool can_blend() const { return source_.interpolation != Interpolation::Categorical; }
  const AttributeLayer& source() const { return source_; }

 private:
  const AttributeLayer& source_;
  const ContractionSequence& sequence_;
  const std::size_t layer_;
  const std::size_t known_count_;
  std::optional<OctahedralCoding> lattice_;
  std::vector<float> blended_;
};

// Keeps its memory from contraction to contraction.
class AttributeRules {
 public:
  // Per candidate the id of what it becomes at v_s, kNoAttribute if it is removed. Candidates with
  // equal results have become one. `links` are pairs of candidates; `changes` may be of any layer.
  std::span<const AttributeId> apply(std::span<const Candidate> candidates,
                                     std::span<const std::pair<std::uint32_t, std::uint32_t>> links,
                                     std::span<const AttributeChange> changes, std::size_t layer,
                                     RuledValues& values);

 private:
  void link(std::uint32_t a, std::uint32_t b);
  std::uint32_t root(std::uint32_t i);
  void link_equal_ids(std::span<const Candidate> candidates);
  void decide_unshown(std::span<const Candidate> candidates, std::span<const std::uint32_t> linked,
                      RuledValues& values);

  std::vector<std::uint32_t> parent_, order_;
  std::vector<AttributeId> result_, ids_;
};

}  // namespace crease
