// Which vertices of a cut are on their way, so that nothing is seen to jump when the cut moves.
//
//   geomorphs.advance(seconds);                       // those that arrived are let go
//   geomorphs.before_split(cut, slot);
//   const std::uint32_t other = cut.split(slot);
//   geomorphs.after_split(cut, s, slot, other);       // both start where v_s was seen
//   if (!geomorphs.leave(cut, s, children, {})) cut.merge(s, children), geomorphs.merged(s, ..);
//   for (SplitId s : geomorphs.arrived()) ...         // those are to be merged now
//   geomorphs.mark(cut); drawing.arrive(cut, geomorphs);
//
// The cut itself knows nothing of this: its positions and values are where things go to. A split is
// done at once and its two vertices start where the one was seen, so the triangles that it brings
// start without area. A merge waits: first both vertices go to where their parent stands, then it
// takes away triangles without area and moves nothing. (Were it done at once, one vertex would have
// to stand for two that are apart.) What turns back on its way turns where it is.
//
// A vertex has one place at any moment, whatever triangles it has: there is no crack.
//
// Normals go by attribute (G03 3.6): an attribute of a child has one parent, so the corners that
// show a value at a vertex all come from one value of the vertex above, and the finer cut's shading
// kinds hold on the way. But a face normal whose corners come from different ones is shown as
// three.
//
// Memory: 4 bytes a slot, 96 per vertex on its way. Time: O(those) a frame.
#pragma once

#include "crease/mesh_hierarchy.h"
#include "runtime/active_cut.h"
#include "runtime/draw_values.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crease {

class Geomorphs {
 public:
  // Of one advance; time that has no end would be no number any more.
  static constexpr double kLongest = 1e6;

  explicit Geomorphs(const MeshHierarchy& hierarchy);

  void set_seconds(double seconds) { seconds_ = seconds; }
  bool is_on() const { return seconds_ > 0; }
  std::size_t moving_count() const { return moving_.size(); }

  // Time goes on. Those that have come to their own place are let go.
  void advance(double seconds);

  void before_split(const ActiveCut& cut, std::uint32_t slot);
  void after_split(const ActiveCut& cut, SplitId s, std::uint32_t slot, std::uint32_t other);
  // The children of s go to where it stands. False if they are there, or nothing goes: it is to be
  // merged now. `for_room`: whatever the view says.
  bool leave(const ActiveCut& cut, SplitId s, const ActiveCut::Children& children, bool for_room);
  // They go back to where they belong.
  void stay(const ActiveCut& cut, SplitId s);
  // Was just merged: `children` as they were.
  void merged(SplitId s, const ActiveCut::Children& children);

  // What the vertex in a slot is to be merged by, or kNoSplit.
  SplitId leaving(std::uint32_t slot) const {
    const std::uint32_t i = moving_of(slot);
    return i == kNone ? kNoSplit : moving_[i].leaving;
  }
  bool is_leaving(SplitId s, const ActiveCut::Children& children) const;
  std::size_t leaving_triangles() const { return leaving_triangles_; }

  struct Leaving {
    SplitId split;
    std::uint32_t slot;  // of one of its children
    bool for_room, has_arrived;
  };
  // A copy, since what is done with them changes who moves.
  const std::vector<Leaving>& all_leaving();

  // For a drawing: all that looks different because of who moves or has arrived.
  void mark(ActiveCut& cut);

  bool is_moving(std::uint32_t slot) const { return moving_of(slot) != kNone; }
  Vec3f position(const ActiveCut& cut, std::uint32_t slot) const {
    const std::uint32_t i = moving_of(slot);
    if (i != kNone) return position_of(moving_[i]);
    return draw_position(hierarchy_.vertices.grid, cut.vertices()[slot].position);
  }
  // The normal at corners that have this value at the vertex.
  Vec3f normal(std::uint32_t slot, std::uint32_t value) const {
    const std::uint32_t i = moving_.empty() ? kNone : moving_of(slot);
    return i == kNone ? this->value(value) : normal_of(moving_[i], value);
  }
  bool moves_normal(std::uint32_t slot, std::uint32_t value) const {
    const std::uint32_t i = moving_of(slot);
    return i != kNone && row_of(moving_[i], value) != nullptr;
  }

  std::size_t bytes() const;

 private:
  struct Row {
    std::uint32_t value = kNone;
    Vec3f from, to;
  };
  struct Moving {
    std::uint32_t slot = kNoSlot;
    SplitId leaving = kNoSplit;
    bool speaks = false;  // for its sibling as well
    bool for_room = false;
    double began = 0;
    Vec3f from, to;
    Row row;                // nearly all have one normal
    std::vector<Row> more;  // the others

    bool has_rows() const { return row.value != kNone; }
    bool goes() const { return !(from == to) || has_rows(); }
    void add(const Row& added);
  };

  std::uint32_t moving_of(std::uint32_t slot) const {
    return slot < moving_of_slot_.size() ? moving_of_slot_[slot] : kNone;
  }
  float share(const Moving& m) const;
  static const Row* row_of(const Moving& m, std::uint32_t value);
  Vec3f normal_of(const Moving& m, std::uint32_t value) const;
  Vec3f value(std::uint32_t index) const {
    return hierarchy_.layers[normal_layer_].values.direction(index);
  }
  Vec3f position_of(const Moving& m) const;
  std::uint32_t value_above(SplitId s, bool second, RelativeAttribute a) const;
  template <typename Visit>
  void visit_normals(NodeId node, Visit visit) const;
  Moving going(const ActiveCut& cut, std::uint32_t slot) const;
  void set(const Moving& m);
  void drop(std::uint32_t slot);

  const MeshHierarchy& hierarchy_;
  std::uint32_t normal_layer_ = kNone;
  double seconds_ = 0, now_ = 0;
  std::vector<Moving> moving_;
  std::vector<std::uint32_t> moving_of_slot_;  // or kNone
  std::vector<std::uint32_t> at_rest_;         // slots that moved until now
  std::size_t leaving_triangles_ = 0;
  Moving above_;  // between before_split() and after_split()
  std::vector<Leaving> all_leaving_;
};

}  // namespace crease
