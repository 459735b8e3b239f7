// A cut through a hierarchy that moves by splits and merges: the active vertices, the corners that
// stand at each, the active triangles with their slots and the values of their corners.
//
//   ActiveCut cut(hierarchy);             // nothing is split
//   cut.split(cut.slot_of(root));         // v_t keeps the slot, v_u gets one
//   cut.merge(s);                         // the exact inverse
//
// A split costs: three look-ups per introduced triangle (WedgeMap), one comparison per corner at
// v_s, a look-up and a write per corner that goes to v_u. Nothing depends on the model's size.
// Normals, colours and kinds are not computed here: what may have changed is marked.
//
// Many moves cost less together, since corners go straight to where the last of them leaves them:
//
//   cut.merge_vertices(s, cut.children(s));   // any number of them
//   cut.bring_corners_up();
//   cut.split_vertex(slot);                   // and of these
//   cut.bring_corners_down();
//
// A corner at a vertex with several attributes of a layer keeps its value, not the relative index
// of G03 3.6: on the walls of a city values stay while indices change with every move. Where a
// value may change on the way (AttributeHierarchy::keeps_values), it is looked up where the corner
// ends. A layer whose values do not repeat has an AttributeOrder for that.
//
// A vertex without triangles has no wedges and no slot; its splits and merges are never needed. So
// a split one of whose children has no triangles only renames the slot.
//
// Memory: a vertex and the corners at it 136, its position and normal to be drawn 24; a triangle as
// in active_triangles.h. Whatever is active: a bit a split, 4.2 bytes a wedge, and
// the AttributeOrders.
#pragma once

#include "crease/mesh_hierarchy.h"
#include "runtime/active_triangles.h"
#include "runtime/attribute_order.h"
#include "runtime/change_set.h"
#include "runtime/corner_lists.h"
#include "runtime/wedge_map.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace crease {

inline constexpr std::uint32_t kNoSlot = kNone;

// All that a move reads and writes of a vertex, in two cache lines side by side.
struct alignas(128) ActiveVertex {
  NodeId node = kNoNode;     // kNoNode: the slot is free
  SplitId split = kNoSplit;  // of the node
  WedgeId begin{}, end{};
  Vec3i position;                   // grid units
  std::uint32_t normal = kSeveral;  // the value that all its corners show (SN of DB03)
  CornerList corners;

  static constexpr std::uint32_t kSeveral = kNone;
  static constexpr std::uint32_t kNoNormal = kNone - 1;  // no triangle of now shows one
  bool has_one_normal() const { return normal != kSeveral; }
};
static_assert(sizeof(ActiveVertex) == 128);

class ActiveCut {
 public:
  // `is_hidden`, if it is there: per triangle, whether it is left out, as if it were not active.
  // Stays the caller's, who tells hide_or_show() of each change.
  explicit ActiveCut(const MeshHierarchy& hierarchy, const char* is_hidden = nullptr);

  const MeshHierarchy& hierarchy() const { return hierarchy_; }
  std::span<const ActiveVertex> vertices() const { return vertices_; }  // by slot, free ones too
  std::size_t vertex_count() const { return vertices_.size() - free_slots_.size(); }
  std::size_t triangle_count() const;
  std::array<ActiveTriangles, kPartCount>& parts() { return parts_; }
  const std::array<ActiveTriangles, kPartCount>& parts() const { return parts_; }
  ChangeSet& vertex_changes() { return vertex_changes_; }

  bool is_done(SplitId s) const { return (done_[index_of(s) / 64] >> (index_of(s) % 64) & 1) != 0; }
  // A child of a done split that is not split itself.
  bool is_cut_leaf(NodeId n) const {
    const SplitId s = h_.split_of(n);
    return s == kNoSplit || !is_done(s);
  }
  bool can_merge(SplitId s) const {
    return is_done(s) && is_cut_leaf(h_.first_child(s)) && is_cut_leaf(h_.second_child(s));
  }
  // The split that activated a triangle, or kNoSplit. Time O(log(splits)).
  SplitId introducing_split(TriangleId t) const;
  // The slot that stands for a wedge.
  std::uint32_t slot_at(WedgeId wedge) const { return map_.slot_at(wedge); }
  // The slots of both children of s; kNoSlot if one is split or has no triangles.
  struct Children {
    std::uint32_t first = kNoSlot, second = kNoSlot;
  };
  Children children(SplitId s) const;

  // The vertex in `slot` must not be a leaf. Returns the slot of v_u, or kNoSlot if one of the
  // children has no triangles.
  std::uint32_t split(std::uint32_t slot);
  void merge(SplitId s) { merge(s, children(s)); }  // can_merge(s)
  void merge(SplitId s, const Children& slots);

  // The same in two steps: first vertices, of any number of splits, or of merges, then all corners.
  // Between them no corner, triangle or normal is to be asked for.
  std::uint32_t split_vertex(std::uint32_t slot);
  void bring_corners_down();
  void merge_vertices(SplitId s, const Children& slots);
  void bring_corners_up();

  // What a move soon to be done will read, some moves ahead; each step follows what the one before
  // it has brought.
  void prefetch_split(std::uint32_t slot, SplitId s) const;
  void prefetch_split_further(SplitId s) const;
  void prefetch_merge(std::uint32_t slot, SplitId s) const;
  void prefetch_merge_further(SplitId s) const;
  void prefetch_begins(SplitId s) const;
  Children prefetch_children(SplitId s) const;  // or who stands where they would
  // The slot that will be taken when `count` others were.
  std::uint32_t slot_to_come(std::size_t count) const {
    return count < free_slots_.size() ? free_slots_[free_slots_.size() - 1 - count] : kNoSlot;
  }
  void prefetch_vertices_of(const ActiveTriangles& part, std::size_t triangle) const {
    const std::uint32_t* const slots = &part.slots[3 * triangle];
    for (std::size_t k = 0; k < 3; ++k) prefetch_vertex(slots[k]);
  }

  CornerLists::View corners_of(std::uint32_t slot) const {
    return lists_.of(vertices_[slot].corners);
  }

  std::uint32_t normal_layer() const { return normal_layer_; }  // kNone: there is none
  std::uint32_t color_layer() const { return color_layer_; }
  std::uint32_t texcoord_layer() const { return texcoord_layer_; }  // kNone: no texture coordinates

  // By DB03, of what the corners have now, which sorted_normals() tells from then on.
  Part sort(ActiveTriangles& part, std::uint32_t triangle) const;
  std::array<std::uint32_t, 3> sorted_normals(const ActiveTriangles& part,
                                              std::uint32_t triangle) const {
    const std::size_t corner = 3 * std::size_t(triangle);
    const std::uint32_t place = place_of_layer_[normal_layer_];
    if (place == kNone) {
      const std::uint32_t* const slots = &part.slots[corner];
      return {vertices_[slots[0]].normal, vertices_[slots[1]].normal, vertices_[slots[2]].normal};
    }
    const std::size_t each = tracked_.size();
    const std::uint32_t* const values = &part.values[each * corner + place];
    return {values[0], values[each], values[2 * each]};
  }
  // The value that a corner shows, if its triangle shows stored ones: its index in the layer.
  std::size_t value_index(const ActiveTriangles& part, std::uint32_t corner_index,
                          std::size_t layer) const;
  // Of the normal layer.
  std::uint32_t normal_index(const ActiveTriangles& part, std::size_t corner_index) const {
    const ActiveVertex& v = vertices_[part.slots[corner_index]];
    if (v.has_one_normal()) return v.normal;
    return part.values[tracked_.size() * corner_index + place_of_layer_[normal_layer_]];
  }
  // Takes the triangle out of one part and into another one; nothing but its place changes.
  void move_triangle(Part from, std::uint32_t triangle, Part to);
  // The vertex looks different though the cut has not moved: it is on its way (Geomorphs), and its
  // normals are, if `with_normals`.
  void touch_moving(std::uint32_t slot, bool with_normals);
  bool is_hidden(TriangleId t) const { return is_hidden_ != nullptr && is_hidden_[index_of(t)]; }
  void hide_or_show(TriangleId t);
  // A bit a split, in their order: it is done.
  std::span<const std::uint64_t> done_words() const { return done_; }
  // No part has holes afterwards.
  void fill_holes();

  std::size_t bytes() const;  // of the state, the hierarchy apart

 private:
  // It shows its geometric normal.
  bool is_derived_now(TriangleId t) const {
    if (normal_layer_ == kNone) return true;
    const SplitId s = h_.deriving_split(t);
    return s != kNoSplit && !is_done(s);
  }
  std::uint32_t take_slot();
  void stand(std::uint32_t slot, NodeId node, const Vec3i& position);
  // Of a node; empty where there are none.
  CompactRanges::Range attributes_of_normals(NodeId node) const {
    if (normal_layer_ == kNone || node == kNoNode) return {};
    return hierarchy_.layers[normal_layer_].attribute_ranges.range(index_of(node));
  }
  void show_vertex(std::uint32_t slot, const CompactRanges::Range& normals);
  void stand_at_children(SplitId s, std::uint32_t first, std::uint32_t second,
                         const Vec3i& position);
  std::uint32_t normal_in(const CompactRanges::Range& attributes) const;
  bool is_painted() const { return color_layer_ != kNone || texcoord_layer_ != kNone; }
  // `values`: per corner one for each tracked layer; those of normals are told for all corners.
  Part kind_of(bool is_derived, std::span<const std::uint32_t, 3> slots,
               std::span<std::uint32_t> values) const;
  // The value at a corner that has `kept` one of a tracked layer.
  std::uint32_t value_of(std::size_t place, std::uint32_t slot, std::uint32_t kept) const {
    const ActiveVertex& v = vertices_[slot];
    if (tracked_[place] == normal_layer_) return v.has_one_normal() ? v.normal : kept;
    const AttributeHierarchy& layer = hierarchy_.layers[tracked_[place]];
    const CompactRanges::Range range = layer.attribute_ranges.range(index_of(v.node));
    return range.end - range.begin > 1 ? kept : layer.own_value(range.begin);
  }
  bool has_several(std::size_t place, const ActiveVertex& v) const {
    const std::uint32_t l = tracked_[place];
    return l == normal_layer_ ? !v.has_one_normal()
                              : hierarchy_.layers[l].attribute_count(v.node) > 1;
  }
  // What all corners of the wedge show wherever they stand, or kNone.
  std::uint32_t constant_at(std::size_t place, WedgeId wedge) const {
    const PackedIndices<>& constants = hierarchy_.layers[tracked_[place]].constant_of_wedge;
    return constants.empty() ? kNone : constants[index_of(wedge)] - 1;
  }
  std::uint32_t varying_value_at(std::size_t place, const ActiveVertex& v, WedgeId wedge,
                                 const CornerLists::View& seen) const;
  std::uint32_t value_at(std::size_t place, const ActiveVertex& v, WedgeId wedge,
                         const CornerLists::View& seen) const {
    const std::uint32_t constant = constant_at(place, wedge);
    return constant != kNone ? constant : varying_value_at(place, v, wedge, seen);
  }
  // A vertex that has moved, whose corners have not yet.
  struct Following {
    std::uint32_t slot;
    NodeId from;  // where its corners' values are right
    bool had_one_normal;
    bool is_new;  // another one has its corners
  };
  std::uint32_t follow(std::uint32_t slot);
  void forget_following();
  template <typename Visit>
  void visit_all(const std::vector<Following>& all, Visit visit);
  template <typename Moves, typename Visit>
  void visit_corners(const std::vector<Following>& all, Moves moves, Visit visit);
  void part_following();
  void show_following();
  bool keeps_between(std::size_t place, NodeId above, NodeId below) const;
  void renew_values(const Following& f, const ActiveVertex& v, std::size_t place);
  void look_up_values(const CornerList& list, const ActiveVertex& v, std::size_t place);
  void renew_corners(const Following& f, std::uint32_t to);
  void give_corners(std::uint32_t slot);
  void take_corners(const Following& f);
  bool goes_up(CornerRef corner);
  void activate_born();
  std::uint32_t kept_value(const CornerAt& at, std::size_t place) const {
    return parts_[at.corner.part()].values[tracked_.size() * at.corner.index() + place];
  }
  void touch_corners(const CornerList& list, bool had_one_normal, bool has_one_normal);
  void activate(TriangleId t, const std::array<WedgeId, 3>& wedges,
                const std::array<std::uint32_t, 3>& slots);
  void stand_at(CornerRef corner, std::uint32_t slot) {
    ActiveTriangles& part = parts_[corner.part()];
    part.slots[corner.index()] = slot;
    part.moved.mark(corner.triangle());
  }
  void touch_derived(SplitId s);
  void prefetch_vertex(std::uint32_t slot) const {
    const char* const vertex = reinterpret_cast<const char*>(&vertices_[slot]);
    __builtin_prefetch(vertex);
    __builtin_prefetch(vertex + 64);
  }
  void prefetch_corners(std::uint32_t slot) const;
  void prefetch_normals(NodeId node) const;
  void prefetch_normals_further(NodeId node) const;
  void prefetch_normal(std::uint32_t attribute) const;
  void prefetch_varying_values();
  void prefetch_values(WedgeId wedge) const {  // of corners that arrive
    for (const PackedIndices<>* constants : constants_) constants->prefetch(index_of(wedge));
  }
  void replace_corner(CornerRef from, CornerRef to);
  void copy_triangle(Part from, std::uint32_t source, Part to, std::uint32_t target);
  std::uint32_t* slots_of(CornerRef corner) {
    return &parts_[corner.part()].slots[3 * std::size_t(corner.triangle())];
  }
  void set_done(SplitId s, bool done) {
    const std::uint64_t bit = std::uint64_t(1) << (index_of(s) % 64);
    std::uint64_t& word = done_[index_of(s) / 64];
    word = done ? word | bit : word & ~bit;
  }

  const MeshHierarchy& hierarchy_;
  const VertexHierarchy& h_;
  const char* const is_hidden_;
  const bool is_large_;  // what there is per wedge, or per node, does not fit the nearer caches
  std::uint32_t normal_layer_ = kNone, color_layer_ = kNone, texcoord_layer_ = kNone;
  std::vector<std::uint32_t> tracked_;             // layers that have nodes of several attributes
  std::vector<std::uint32_t> place_of_layer_;      // in tracked_, or kNone
  std::vector<AttributeOrder> orders_;             // of those; empty where wedges keep values
  std::vector<const PackedIndices<>*> constants_;  // constant_of_wedge of those
  bool tracks_others_ = false;                     // layers beside normals
  bool touches_triangles_ = false;                 // some triangle is, or may become, other than SN
  std::vector<std::uint64_t> done_;                // a bit a split
  WedgeMap map_;
  std::vector<ActiveVertex> vertices_;
  std::vector<std::uint32_t> free_slots_;
  CornerLists lists_;
  std::array<ActiveTriangles, kPartCount> parts_;
  ChangeSet vertex_changes_;
  std::vector<std::uint32_t> arriving_;  // scratch of one triangle
  std::vector<Following> following_, left_;
  std::vector<std::uint32_t> following_of_slot_;  // or kNone
  std::vector<std::uint32_t> to_of_slot_;         // itself, but for one that merges left
  std::vector<SplitId> moves_;                    // that corners have not followed
  struct Born {
    TriangleId triangle;
    std::array<WedgeId, 3> wedges, begins;  // of the vertices where they are
    std::array<std::uint32_t, 3> slots;
  };
  std::vector<Born> born_;       // scratch
  std::vector<NodeId> varying_;  // scratch
};

}  // namespace crease
