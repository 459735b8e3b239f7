// Who uses the value that a slot owns, in one attribute layer (DB03's SN vertices and SN triangles,
// for any layer).
//
// A slot owns at most one attribute of a layer at a time; a triangle is shared if at every level
// all three corners have what their slots own, else explicit: it stores its own indices. Explicit
// is for life, so the classes come out of following the sequence once, demoting triangles where a
// slot would have to own two attributes. Following it a second time with the classes known demotes
// nobody: then all shared triangles at a slot agree, always.
#pragma once

#include "assemble/replay.h"
#include "crease/contraction.h"
#include "crease/mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace crease {

class Sharing {
 public:
  Sharing(const Mesh& snapped, const ContractionSequence& sequence, std::size_t layer);

  // Normals: a slot owns one iff all its corners share it (DB03's SN vertex), and a triangle that
  // is derived at any level is explicit, since its normal will be its own.
  void own_where_all_agree();
  // Other layers: every slot owns the attribute that most of its corners have.
  void own_what_most_have();
  // The second time: what the shared triangles have. Slots without any own nothing, or, if `all`,
  // some attribute of theirs.
  void own_what_is_used(bool all);

  // Normals decide which slot v_s stands in: one that can own what its shared triangles have, at
  // the least cost. True: p's.
  bool prefers_p(const Step& step, std::span<const AttributeChange> changes) const;

  // Updates what the kept slot owns and demotes who cannot be served. Before Replay::contract().
  void contract(const Replay& replay, const Step& step, bool keep_p,
                std::span<const AttributeChange> changes);

  bool is_explicit(std::size_t triangle) const { return explicit_[triangle] != 0; }
  void make_explicit(std::size_t triangle) { explicit_[triangle] = 1; }
  void make_all_explicit() { explicit_.assign(explicit_.size(), 1); }
  std::size_t explicit_count() const;
  std::uint32_t owned(std::uint32_t slot) const { return owned_[slot]; }  // or kNone

 private:
  std::size_t shared_count(std::span<const std::uint32_t> corners) const;
  std::uint32_t after(std::uint32_t id, std::span<const AttributeChange> changes) const;
  void demote(std::span<const std::uint32_t> corners);
  void explicit_where_not_owned();
  void find_twins();
  bool are_twins(std::uint32_t a, std::uint32_t b) const;

  const Mesh& mesh_;
  const ContractionSequence& sequence_;
  std::size_t layer_;
  std::vector<std::uint32_t> owned_;    // per slot
  std::vector<std::uint8_t> explicit_;  // per triangle
  // Per attribute: another one has the same bits. A slot's own value has no index, so an extracted
  // corner finds the others it shares with by their bits; twins at one vertex would be taken for
  // one.
  std::vector<std::uint8_t> has_twin_;
};

}  // namespace crease
