// The mesh while a contraction sequence is applied to it, on slots.
//
//   Replay replay(snapped, sequence);
//   for (std::uint32_t i = 0; i < sequence.contractions.size(); ++i) {
//     const Step& step = replay.look(i);             // what contraction i will do
//     replay.contract(i, keep_p, on_change);
//   }
//
// A slot is what the vertex arrays of the result have a place for. A vertex of the sequence lives
// in a slot, at first that with its own number; contraction (p, q) may keep p's slot instead of
// q's, and q lives there afterwards (DB03 8.2, where q is replaced by p).
//
// Memory: 25 bytes a triangle, 12 a triangle and layer, 32 a vertex. Time of a step: O(triangles
// around the pair).
#pragma once

#include "crease/contraction.h"
#include "crease/mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace crease {

// Before contraction: what stands around it. Corners are 3 * triangle + corner.
struct Step {
  std::uint32_t p_slot = 0, q_slot = 0;
  std::vector<std::uint32_t> at_p, at_q;  // corners of triangles that survive, ascending
  std::vector<std::uint32_t> lost;        // triangles with both, ascending
};

class Replay {
 public:
  Replay(const Mesh& snapped, const ContractionSequence& sequence);

  // Fills and returns step(). The mesh does not change.
  const Step& look(std::uint32_t contraction);

  // Does it: v_s stands in p's slot if keep_p, else in q's. Calls on_change(layer, corner, from,
  // to) for every corner at v_s whose attribute changes, normals of derived triangles excepted.
  template <typename OnChange>
  void contract(std::uint32_t contraction, bool keep_p, OnChange on_change);

  // After contract(): slots of vertices that were in vanished triangles only and that no later
  // contraction names (DB03's additional lost vertices), ascending.
  std::span<const std::uint32_t> lost_slots() const { return lost_slots_; }

  std::uint32_t attribute(std::size_t layer, std::size_t corner) const {
    return static_cast<std::uint32_t>(index_of(of_corner_[layer][corner]));
  }
  bool is_derived(std::size_t triangle) const { return derived_[triangle] != 0; }
  const Vec3i& position(std::uint32_t slot) const { return positions_[slot]; }
  const std::vector<Vec3i>& positions() const { return positions_; }

 private:
  void gather(std::uint32_t slot, std::uint32_t other, std::vector<std::uint32_t>& corners,
              std::vector<std::uint32_t>* lost);
  void drop_lost(std::uint32_t contraction);
  void move_corners(std::uint32_t kept, std::uint32_t removed);

  static constexpr std::uint32_t kDead = kNone;

  const Mesh& mesh_;
  const ContractionSequence& sequence_;
  // A triangle's three fill 24 bytes, most often of one cache line: looking is all about misses.
  struct Corner {
    std::uint32_t slot;
    std::uint32_t next;  // corner at the slot, or kNone. Chains may hold dead triangles
  };

  std::vector<Corner> corners_;  // slot kDead in all three when the triangle has vanished
  std::vector<std::vector<AttributeId>> of_corner_;
  std::vector<std::uint8_t> derived_;
  std::vector<std::uint32_t> first_corner_;  // per slot
  std::vector<std::uint32_t> valence_;       // per slot: live triangles
  std::vector<Vec3i> positions_;             // per slot
  std::vector<std::uint32_t> slot_of_vertex_, vertex_of_slot_;
  std::vector<std::uint32_t> last_use_;  // per vertex: the last contraction that names it
  Step step_;
  std::vector<std::uint32_t> lost_slots_;
};

template <typename OnChange>
void Replay::contract(std::uint32_t contraction, bool keep_p, OnChange on_change) {
  const Contraction& c = sequence_.contractions[contraction];
  const std::uint32_t kept = keep_p ? step_.p_slot : step_.q_slot;
  const std::uint32_t removed = keep_p ? step_.q_slot : step_.p_slot;
  for (TriangleId t : sequence_.derived_of(c)) derived_[index_of(t)] = 1;
  for (const AttributeChange& change : sequence_.changes_of(c)) {
    const bool is_normal = mesh_.layers[change.layer].role == AttributeRole::Normal;
    for (const std::vector<std::uint32_t>* corners : {&step_.at_p, &step_.at_q}) {
      for (std::uint32_t corner : *corners) {
        AttributeId& attribute = of_corner_[change.layer][corner];
        if (attribute != change.from || (is_normal && derived_[corner / 3] != 0)) continue;
        attribute = change.to;
        on_change(change.layer, corner, static_cast<std::uint32_t>(index_of(change.from)),
                  static_cast<std::uint32_t>(index_of(change.to)));
      }
    }
  }
  drop_lost(contraction);
  move_corners(kept, removed);
  positions_[kept] = c.position;
  const auto q = static_cast<std::uint32_t>(index_of(c.kept));
  slot_of_vertex_[q] = kept;
  vertex_of_slot_[kept] = q;
}

}  // namespace crease
