// One patch in one pass: pair contractions in the order of their cost until none costs less than
// the pass's limit.
//
//   PatchSimplifier patch;  // one a thread: it keeps its memory from patch to patch
//   patch.start(work, triangles, patch_id, steering);
//   PatchResult result = patch.run(progress);
//
// Inside, everything is local: 10,000 triangles take about 6 MB. Vertices that other patches share
// are locked: they neither move nor vanish.
#pragma once

#include "hierarchy/quadric.h"
#include "hierarchy/witnesses.h"
#include "parallel/shared_progress.h"
#include "simplify/area_changes.h"
#include "simplify/cost_heap.h"
#include "simplify/flat_shading.h"
#include "simplify/ring_block.h"
#include "simplify/scratch_list.h"
#include "simplify/work_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace crease::simplification {

struct Steering {
  Placement placement = Placement::Optimal;
  double cost_limit = 0;          // area * squared length, grid units
  double virtual_distance = 0;    // grid units; pairs of parts nearer than this are candidates, if
  std::uint32_t joins_below = 0;  // one of them has fewer triangles than this
  double turn_distance = 0;       // grid units; see load_turns()
  double line_weight = 1;         // of creases and borders beside surfaces
  double pull = 1e-4;             // of the optimum towards the pair's middle, see Quadric::minimum
  // A place between the ends is taken if it is this much cheaper than the better end, and the
  // optimum if it is this much cheaper than either: a file needs about 5 bits more for the one and
  // 17 for the other.
  double leaves_ends = 0.57, leaves_pair = 0.3;
  bool stays_at_ends = true;  // also where only a place between them keeps the volume
  double normal_scale = 0;    // what a normal off by one radian is worth, grid units
  double far_area = 0;        // see far_area.h
  bool is_alone = false;      // there are threads without a patch of their own
  bool keep_one_triangle = true;
};

// What rounding to the grid is worth: less than this is no reason to leave an end, grid units.
inline constexpr double kGridNoise = 0.5;

inline Vec3d to_double(const Vec3i& v) {
  return {double(v.x), double(v.y), double(v.z)};
}

class PatchSimplifier {
 public:
  using Index = std::uint32_t;

  void start(WorkMesh& work, std::span<const std::uint32_t> triangles, std::uint32_t patch_id,
             const Steering& steering);

  // The costs of all pairs, without contracting any: for choosing the first band's limit. The same
  // patch can be started at once again, as long as the mesh and the owners stay as they are.
  std::vector<double> initial_costs();

  // Once after each start(). Where `progress` is stopped under way there is no result.
  PatchResult run(SharedProgress& progress);

  // Writes triangles, positions and errors back. New attribute values keep their local numbers (at
  // or above kLocalValue) until the band's patches are put in order.
  void write_back();

 private:
  // A wedge of one layer at one vertex.
  struct Wedge {
    float value[kMaxDimension] = {};
    double area = 0;        // of its triangles
    Index id = kNone;       // attribute, or kLocalValue + local new value
    Index quadric = kNone;  // in attribute_quadrics_, or kNone: it is the same all over its
                            // triangles, or does not steer
    bool pinned = false;    // a triangle has it at all three corners: it never changes (DB03 b)
  };
  struct Slice {
    Index first = 0, count = 0;
  };
  struct Vertex {
    Index global = 0;
    Index into = kNone;    // of a removed vertex: the one it was contracted into
    Slice corners;         // in corner_pool_
    Index changed_at = 0;  // so many contractions had been made when it last changed
    bool locked = false;
    bool alive = true;
    bool flat_around = true;  // all its triangles are flat or derived
  };
  struct Errors {
    LevelError base;  // of the bands before
    LevelError now;
  };
  struct Placed {
    double cost = 0;
    double free_cost = 0;  // without what flat triangles cost: make_legal() knows that better
    Vec3d position;
    bool lasts = false;  // of make_legal(): it says the same until something around has changed
  };
  // A pair, and what is known of it as long as its ends do not change.
  struct Candidate {
    Index a, b;
    Index known_at;          // so many contractions, and one, when it was known last; 0: it has not
                             // been looked at, so that another may own its ends
    Vec3i position;          // less center_
    double cost, free_cost;  // see Placed
    double cost_of_other[3];  // free, at the other places that make_legal() tries; or kUnknown
    static constexpr double kUnknown = -1;
  };
  // Of a triangle, as it is.
  struct Facing {
    Vec3d normal;  // of unit length, or zero without area
    double area = 0;
  };
  // Of a pair at the start: its cost, then its place in candidates_.
  struct Ordered {
    float cost;
    Index pair;
  };
  // One result wedge of a contraction: which wedges of a layer become one.
  struct Joined {
    Index first_member = 0, member_count = 0;  // in Joins::members
    Index fixed = kNone;                       // the member whose value is kept, or kNone: solve
  };
  // Of a pair, with the scratch that finds it.
  struct Joins {
    ScratchList<Joined> joined;
    ScratchList<Index> common;  // the first end's corners in the triangles that have both
    ScratchList<Index> members, parent, place_of_set;
    std::vector<Index> by_id;
  };

  // Around a pair: a triangle that survives, and one that has both ends.
  struct RingTriangle {
    Index triangle;
    Index corner;          // of the end of the pair that it has
    Index next, previous;  // its other vertices, from there
  };
  struct Vanishing {
    Index triangle;
    Index third;  // its vertex that is no end
  };

  // A connected part, of which the patch may have no more than some vertices.
  struct Part {
    double loss = 0;      // PartDamage::all()
    double damage = 0;    // see hierarchy/whole_part.h; 0 if it is large
    double reach2 = 0;    // squared, how far its box's corners are from the middle
    Index triangles = 0;  // those that are left
    Index into = kNone;   // the one that it has joined
    // Parts that would float without it, a list.
    Index first_on_it = kNone, next_on_same = kNone;
    bool whole = false;  // small, all of it is the patch's, and nothing has broken it
  };

  // Triangles of one category that are connected in one plane; see islands.cpp.
  struct Region {
    double area = 0;
    bool is_large = false;   // it was not looked at to its end
    bool is_locked = false;  // other patches have some of it
    bool is_flat = true;     // it ends where its category does
  };
  struct Island {
    double area = 0;
    bool is_locked = false;
    bool is_aside = false;  // what breaks it takes no triangle from it
    std::vector<Index> members;
  };

  struct Edge {
    Index other;
    Index corner[2];        // of the vertex that it was found at, in two of its triangles
    Index other_corner[2];  // in the same triangles
    Index triangle_count;
  };

  // load_patch.cpp
  void load(std::span<const std::uint32_t> triangles, std::uint32_t patch_id);
  void load_wedges();
  void load_quadrics();
  void gather_edge_sides();
  void load_edges();
  static double square_of_difference(const Wedge& a, const Wedge& b);
  double line_weight(Index v, const Edge& edge) const;
  void add_lines(Index v, const Edge& edge, double share);
  Edge without_copies(Index v, const Edge& edge) const;
  void add_line(Index a, Index b, Index triangle, double share);

  // virtual_pairs.cpp
  void find_virtual_pairs();

  // whole_parts.cpp
  void load_parts();
  Index part_at(Index v);
  void contract_parts(Index kept, Index removed);
  Index broken_by(Index a, Index b, double cost);
  double price_of_what_rests_on(Index part, Index but) const;
  double cost_with_part(Index a, Index b, double cost);
  void vanish(Index member, double cost);

  // islands.cpp
  Index across(Index t, Index c) const;
  void find_beyond(Index member, Index other, int steps);
  Region region_around(Index t, double enough);
  Island island_around(Index t, double most);
  double price_of(const Island& island) const;
  bool loses_triangles(const Island& island) const;
  Island island_broken_by(Index a, Index b, const Placed& placed);
  Placed place_at_end(const Candidate& pair, int end);
  bool pushes_another(const Island& island, const Candidate& pair, const Placed& placed);
  bool close_island(const Island& island, double cost);

  // pair_cost.cpp
  // `bound`: a cost above it need not be exact.
  Placed place(Index a, Index b, double bound, Joins& joins) const;
  Quadric sum_of(Index a, Index b) const;
  void add_turns(Index a, Index b, Quadric& sum) const;
  // A place, and what it costs by `sum`.
  struct Chosen {
    Vec3d position;
    double cost = 0;
  };
  Chosen choose(const Quadric& sum, Index a, Index b, double bound) const;
  // By how much it grows if both ends of a pair move to x: gradient.x + offset.
  struct Volume {
    Vec3d gradient;
    double offset = 0;
    double area = 0;  // of the triangles that move
  };
  Volume volume_between(Index a, Index b) const;
  float keep_volume(Index a, Index b, Placed& placed);
  void find_costs_of_others(Candidate& pair);
  static void keep_placed(const Placed& placed, Candidate& pair) {
    pair.position = whole(placed.position);
    pair.cost = placed.cost;
    pair.free_cost = placed.free_cost;
    pair.cost_of_other[0] = Candidate::kUnknown;
  }
  void find_common(Index a, Index b, Joins& joins) const;
  // `joins.common` must be known.
  void join_wedges(std::size_t layer, Index a, Index b, Joins& joins) const;
  Joined* join_pinned(std::size_t layer, Index first, Index end, Joined* joined,
                      Joins& joins) const;
  template <typename Unite>
  void unite_equal(std::size_t layer, Slice wa, Slice wb, Joins& joins, Unite unite) const;
  void add_attribute_costs(Index a, Index b, Quadric& sum, Joins& joins) const;
  void add_endpoint_attribute_costs(Index kept, Index removed, Quadric& sum, Joins& joins) const;
  double layer_scale(std::size_t layer) const;
  void add_quadric(std::size_t layer, const Wedge& wedge, AttributeQuadric& all) const {
    const int dimension = work_->layers[layer].dimension;
    if (wedge.quadric == kNone) {
      all.add_constant(wedge.value, wedge.area, dimension);
    } else {
      all.add(attribute_quadrics_[layer][wedge.quadric], dimension);
    }
  }
  void add_fixed_cost(std::size_t layer, const Wedge& wedge, const float* value,
                      Quadric& sum) const;

  // legality.cpp
  Placed make_legal(Candidate& pair, double bound);
  double ring_cost(Index a, Index b, const Vec3d& target, double bound);
  double category_cost(Index a, Index b, const Vec3d& target);
  double vanishing_cost(Index a, Index b);
  bool is_of_card(Index v) const;
  void gather(std::size_t first, RingBlock& block) const;
  void gather_shading(std::size_t first, RingBlock& block) const;
  double fold_cost(Index a, Index b, const Vec3d& target, double bound);
  double coincidence_cost(Index a, Index b);
  void blame(Index t, double cost);

  // flat_shading.cpp
  void load_shading();
  void load_turns();
  Vec3d shown_normal(Index t) const;
  Index heir_of(const Vanishing& vanishing);
  double vanishing_error(const Vanishing& vanishing);
  void hand_over_represented();
  void derive_where_better(Index kept, LevelError& error);

  // run_patch.cpp
  void order_pairs();
  template <typename Take>
  void place_all(double bound, Take take);
  bool pop(Entry& entry);
  float next_cost() const;
  void fetch_ahead() const;
  std::size_t slot_of(Index a, Index b) const {
    return (a * 0x9e3779b1u ^ b * 0x85ebca77u) & (owners_.size() - 1);
  }
  Index survivor(Index v);
  bool claim(Index pair, Index a, Index b);
  bool is_next(const Entry& entry, double cost) const;
  void contract_or_hold(const Entry& entry, Index a, Index b, double cost, Placed& placed);
  void hold(const Entry& entry, double cost, const Placed& placed);
  void release(Index triangle);

  // contract.cpp
  void contract(Index a, Index b, const Vec3d& target, double cost);
  void find_ring(Index kept, Index removed);
  void turn_ring(Index kept);
  void contract_layer(std::size_t layer, Index kept, Index removed, const Vec3d& target,
                      LevelError& error);
  void combine_quadrics(std::size_t layer, std::span<const Index> members, Wedge& result);
  void blend_along(std::size_t layer, std::span<const Index> members, Slice of_kept,
                   double kept_share, double* value) const;
  Index chosen_value(std::size_t layer, std::span<const Index> members, Index fixed, Slice of_kept,
                     const Vec3d& target, double kept_share, Wedge& result);
  float surface_error(Index a, Index b, const Vec3d& target) const;
  // Into farthest_witness_; contract() settles them.
  void measure_witnesses(Index a, Index b, const Placed& placed);

  // Of a place on the grid, less center_.
  static Vec3i whole(const Vec3d& p) {
    return {static_cast<std::int32_t>(p.x), static_cast<std::int32_t>(p.y),
            static_cast<std::int32_t>(p.z)};
  }
  Vec3i on_grid(const Vec3d& p) const { return center_grid_ + whole(p); }
  Facing facing_of(Index t) const {
    const Index* v = &vertex_of_corner_[4 * t];
    const Vec3d& p0 = positions_[v[0]];
    const Vec3d twice = cross(positions_[v[1]] - p0, positions_[v[2]] - p0);
    const double twice_area = length(twice);
    if (!(twice_area > 0)) return {};
    return {twice * (1 / twice_area), 0.5 * twice_area};
  }
  // Twice the area long.
  Vec3d normal_if_moved(const RingTriangle& ring, const Vec3d& target) const {
    return cross(positions_[ring.next] - target, positions_[ring.previous] - target);
  }
  // A triangle's corners are 4 * triangle + 0 to 2: how far it is from one to the others is a look
  // into a table.
  static Index triangle_of(Index corner) { return corner / 4; }
  static Index corner_after(Index corner) {
    static constexpr Index kSteps[] = {1, 1, Index(-2)};
    return corner + kSteps[corner % 4];
  }
  static Index corner_before(Index corner) {
    static constexpr Index kSteps[] = {2, Index(-1), Index(-1)};
    return corner + kSteps[corner % 4];
  }
  // A corner between flat faces, or on the border of one.
  bool is_corner(Index v) const { return vertices_[v].flat_around && line_of_vertex_[v] != kNone; }
  bool has_corner_at(Index t, Index v) const {
    const Index* corners = &vertex_of_corner_[4 * t];
    return (corners[0] == v) | (corners[1] == v) | (corners[2] == v);
  }
  // The vertices of the corner after and the one before.
  const Index* others_of(Index corner) const { return &vertex_of_corner_[corner_after(corner)]; }
  RingTriangle ring_triangle(Index corner) const {
    const Index* others = others_of(corner);
    return {triangle_of(corner), corner, others[0], others[1]};
  }
  // One of each of its triangles.
  std::span<const Index> corners_of(Index v) const {
    return std::span(corner_pool_).subspan(vertices_[v].corners.first, vertices_[v].corners.count);
  }
  Slice& wedges_of(std::size_t layer, Index v) { return wedge_slices_[layer][v]; }
  Slice wedges_of(std::size_t layer, Index v) const { return wedge_slices_[layer][v]; }
  Index category_of(Index t) const { return work_->category_of_triangle[global_triangle_[t]]; }
  Index material_of_category(Index category) const { return category % work_->material_count; }
  std::size_t layer_count() const { return work_->layers.size(); }

  WorkMesh* work_ = nullptr;
  Steering steering_;
  Index loaded_ = kNone;                // the patch that was started, until it is run
  std::vector<Index> local_of_vertex_;  // all kNone between patches
  Vec3d center_;
  Vec3i center_grid_;

  std::vector<Vertex> vertices_;
  std::vector<Vec3d> positions_;       // per vertex, grid units less center_
  std::vector<Errors> errors_;         // per vertex
  std::vector<float> grown_;           // per vertex, see WorkMesh::grown_of_vertex
  std::vector<Index> changed_around_;  // per vertex: so many contractions had been made when it or
                                       // one of its triangles last changed
  std::vector<Quadric> surface_;       // per vertex
  std::vector<Quadric> turn_;          // per vertex, what its flat triangles' turning costs about;
                                       // empty: none is flat
  std::vector<Quadric> line_;          // per crease or border vertex
  std::vector<Index> line_of_vertex_;  // kNone: on no line
  std::vector<Index> corner_pool_;

  std::vector<Index> global_triangle_;
  std::vector<Index> vertex_of_corner_;  // 4 a triangle, of which the last is the first again: any
                                         // corner's others lie together
  std::vector<char> triangle_alive_;
  std::vector<Facing> facing_;
  std::vector<char> flat_;  // stored normal the same at all three corners, and not derived
  std::vector<char> derived_;
  std::vector<FlatShading> shading_;  // of flat and derived triangles; empty: there are none
  std::size_t live_triangles_ = 0;

  std::vector<std::vector<Wedge>> wedges_;                         // per layer, slices by vertex
  std::vector<std::vector<AttributeQuadric>> attribute_quadrics_;  // per layer; see Wedge
  std::vector<std::vector<Slice>> wedge_slices_;                   // per layer and vertex
  std::vector<std::vector<Index>> wedge_of_corner_;

  std::vector<Index> category_around_;     // by vertex; kNone: several
  AreaChanges by_category_, by_material_;  // of one contraction

  std::vector<Index> region_of_;  // per triangle, the last that it was found in
  Index region_count_ = 0;
  std::vector<Index> region_members_;  // of the last one, and triangles of other categories in its
  std::vector<Index> region_borders_;  // plane beside it

  std::vector<Part> parts_;          // empty: none is small
  std::vector<Index> part_of_;       // per vertex, see part_at()
  std::vector<Index> next_in_part_;  // per vertex: a circle through those of its part

  std::vector<std::pair<Index, Index>> pairs_;  // edges, then virtual pairs
  // Those that cost little enough. Contractions make pairs the same: the first that is looked at
  // afterwards owns its two ends, the others are dropped.
  std::vector<Candidate> candidates_;
  std::vector<Index>
      owners_;  // hash table of pairs that were looked at, by their ends; kNone: free
  std::size_t owner_count_ = 0;
  std::vector<Ordered> order_, order_scratch_;  // the pairs of the start, cheapest first
  std::size_t next_in_order_ = 0;
  CostHeap heap_;  // those that were looked at again
  double last_key_ = 0;

  PatchResult result_;

  // Pairs that would fold something wait in the heap at that higher cost. When the triangle that is
  // to blame has changed they may have become legal, so they are tried again at once, and the
  // waiting entry is void.
  struct Held {
    Index pair;
    Index next;  // in the list of the same triangle
    float cost;  // without the fold
    std::uint16_t tries;
    bool waiting;
    bool lasts;       // and so do the place and the cost below; see Placed
    Index looked_at;  // so many contractions had been made
    Vec3i position;   // less center_
    double cost_with_ring;
  };
  std::vector<Held> held_;
  std::vector<Index> held_of_triangle_;  // head of a list in held_, or kNone
  Index blamed_ = kNone;                 // by the last make_legal()
  double blamed_cost_ = 0;

  // Scratch of load_edges().
  std::vector<char> several_wedges_;
  std::vector<Index> edge_sides_;    // 8 * triangle + way along it
  std::vector<Index> end_of_sides_;  // by vertex
  ScratchList<Edge> edges_;
  std::vector<Index> edge_at_;  // the last that a vertex was met at

  // Scratch of one contraction.
  Joins joins_;
  ScratchList<Vanishing> vanishing_;
  ScratchList<RingTriangle> ring_;  // kept's, then removed's
  std::size_t ring_kept_ = 0;       // so many are kept's
  std::vector<RingBlock> blocks_;   // of ring_, as far as fold_cost() has looked at it
  std::uint32_t ring_count_ = 0;    // of those that make_legal() has looked at
  ScratchList<Index> touching_;
  std::vector<char> used_;
  std::vector<Wedge> results_;  // of one layer
  WitnessMover witness_mover_;
  float farthest_witness_ = 0;
  std::vector<Index> mark_;
  Index mark_now_ = 0;
};

}  // namespace crease::simplification
