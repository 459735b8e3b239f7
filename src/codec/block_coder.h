// A block, written once for both directions: with a RangeEncoder and a guide that knows the answers
// it writes, with a RangeDecoder it finds them. What is decided in which order stands in
// docs/format-block.md.
//
//   BlockCoder coder(range_decoder, no_guide, coding, limits, coarse_mesh);
//   if (coder.run()) use(coder.take_end(block, names), coder.take_splits());
//
// A guide has, for local ids (vertices and triangles in the order in which the coder knows them):
//   is_split(v), goes_to_second(v, t), introduced(v, out), position(v, second)   of the node at v
//   name_children(swapped)          from now on the present split's children change their names
//   did_split(v, u, order)          v is the first child now, u the second; triangles were added
//   roots(), root_triangles()       vertices without a coarse triangle, and triangles of the base
//   root_names()                    of those that a coarser block has made; of others kNone
//   category(t), derived(t), label(t), value(layer, t, c)    at the fine end
#pragma once

#include "codec/between_model.h"
#include "codec/block_end.h"
#include "codec/coded_numbers.h"
#include "codec/direction_mixture.h"
#include "codec/mixed_bit.h"
#include "codec/pair_odds.h"
#include "codec/patch_mesh.h"
#include "codec/place_model.h"
#include "codec/predict_position.h"
#include "codec/predict_value.h"
#include "codec/ring.h"
#include "codec/spot.h"
#include "codec/stream.h"
#include "codec/triangle_lists.h"
#include "crease/ids.h"

#include "hierarchy/between.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace crease::codec {

// A triangle that a split of v into t and u introduces: (t, u, third) or (u, t, third).
struct Introduced {
  std::uint32_t third = 0;
  bool first_leads = false;  // (t, u, third)
};

struct Split {
  std::uint32_t vertex = 0;          // becomes the first child; the second is the next new vertex
  std::uint32_t first_triangle = 0;  // those introduced are the next ones from here
  std::uint32_t triangle_count = 0;
  Vec3i parent_position{};  // grid units
};

struct BlockLimits {
  std::uint32_t vertices = 0, triangles = 0;  // at the fine end
};

struct NoGuide {};

template <class Coder, class Guide>
class BlockCoder {
 public:
  BlockCoder(Coder& coder, Guide& guide, const BlockCoding& coding, const BlockLimits& limits,
             PatchMesh coarse)
      : coder_(coder), guide_(guide), coding_(coding), limits_(limits), mesh_(std::move(coarse)) {
    coarse_triangles_ = static_cast<std::uint32_t>(mesh_.triangles.size());
    coarse_vertices_ = static_cast<std::uint32_t>(mesh_.positions.size());
    was_derived_ = mesh_.derived;
    around_.fill(mesh_.positions.size(), mesh_.triangles, 3);
  }

  // False: the bytes are not a block of these limits.
  bool run() {
    coder_.enter(Stream::Roots);
    keep_coarse_positions();
    keep_coarse_normals();
    if (!code_roots() || !code_splits()) return false;
    coder_.enter(Stream::Categories);
    code_categories();
    code_derived();
    coder_.enter(Stream::Values);
    if (!coding_.layers.empty()) find_areas();
    mesh_.values.resize(coding_.layers.size());
    for (std::size_t l = 0; l < coding_.layers.size(); ++l) {
      mesh_.values[l].resize(3 * mesh_.triangles.size());
      code_layer(coding_.layers[l], mesh_.values[l], l);
    }
    coder_.enter(Stream::Labels);
    code_labels();
    return !coder_.failed() && !corrupt_;
  }

  const PatchMesh& mesh() const { return mesh_; }

  // Once, after run(). `names`: of the vertices at the coarse end.
  FineEnd take_end(std::uint32_t block, std::vector<VertexName> names) {
    names.resize(mesh_.positions.size());
    for (std::uint32_t v = 0; v < names.size(); ++v) {
      if (was_split(v)) names[v] = {block, v};
    }
    for (std::uint32_t i = 0; i < root_names_.size(); ++i) {
      if (root_names_[i].block != kNone) names[coarse_vertices_ + i] = root_names_[i];
    }
    return {std::move(mesh_), std::move(names), std::move(labels_)};
  }
  std::vector<Split> take_splits() { return std::move(splits_); }

 private:
  // An index below `count`.
  std::uint32_t code_below(std::uint32_t count, std::uint32_t value) {
    const std::uint32_t index = count > 0 ? code_index(coder_, count, value) : 0;
    if (index < count) return index;
    corrupt_ = true;
    return 0;
  }

  // Roots.
  bool code_roots();
  std::uint32_t add_vertex(const Vec3i& position) {
    mesh_.positions.push_back(position);
    around_.add_vertex();
    return static_cast<std::uint32_t>(mesh_.positions.size() - 1);
  }
  std::uint32_t add_triangle(const Corners& corners) {
    const std::uint32_t t = static_cast<std::uint32_t>(mesh_.triangles.size());
    mesh_.triangles.push_back(corners);
    for (std::uint32_t v : corners) around_.add(v, t);
    return t;
  }

  // Splits.
  struct Shape {                           // of one split
    std::vector<std::uint32_t> triangles;  // those at the vertex
    std::vector<char> to_second;           // per triangle
    std::vector<Introduced> introduced;    // in the order in which they are added
  };
  struct Fan {  // the shape where the triangles are one fan: see make_fan()
    std::uint32_t first = 0, last = 0;
    bool single = false;
  };
  bool code_splits();
  bool look_around(std::uint32_t v);
  void forget_ring_if_large(std::uint32_t v);
  bool code_flag(std::uint32_t v, bool fan, bool splits);
  struct Beside {  // the vertices beside one
    Spot sizes{};
    std::uint32_t split = 0, count = 0;
  };
  Beside look_beside(std::uint32_t v, bool fan);
  bool split(std::uint32_t v, bool fan);
  void code_shape(std::uint32_t v, bool fan);
  void ask_shape(std::uint32_t v);
  bool find_fan(Fan& fan);
  void make_fan(const Fan& fan);
  void code_fan(Fan fan);
  Fan code_likely_fan(Fan fan);
  void code_general(std::uint32_t v);
  void apply(std::uint32_t v, std::uint32_t u);
  void apply_fan(std::uint32_t v, std::uint32_t u);
  void add_beside(std::uint32_t v, std::uint32_t neighbour, std::size_t after,
                  std::uint32_t triangle);
  void code_positions(std::uint32_t t, std::uint32_t u, const Vec3i& s);
  Surroundings surroundings_of_split(std::uint32_t t, std::uint32_t u, const Vec3i& s);
  struct StaysContext {
    std::size_t share = 0, first = 0, second = 0, which_has_more = 0;
  };
  static StaysContext stays_context(const Surroundings& around, std::size_t triangles_t,
                                    std::size_t triangles_u);
  bool code_stays(std::size_t question, const StaysContext& context, bool stays);
  Miss expected_miss(std::uint32_t v, const Surroundings& around) const;
  ChildRing child_ring(bool second, const Vec3i& s, const Vec3i& sibling) const;
  Vec3i code_position(std::uint32_t v, bool second, const Vec3i& position,
                      const Surroundings& around, Leaving leaving, const ChildRing& ring,
                      const Vec3i& sibling);
  void see_neighbours(std::uint32_t v, const Surroundings& around, const Vec3i& sibling,
                      SeenPlace& seen) const;
  void note_miss(std::uint32_t v, const PlaceMixture& mixture, const Step& place);
  bool code_between(std::uint32_t t, std::uint32_t u, Vec3i& at_t, Vec3i& at_u,
                    const Surroundings& around);
  Vec3i code_other_end(std::uint32_t t, const Vec3i& at_t, const Vec3i& at_u,
                       const Surroundings& around, const Between& between);

  // What triangles and corners have at the fine end.
  static constexpr std::size_t kBends = 4;
  struct LayerModels {
    std::array<std::array<AdaptiveBit, kBends>, 3> is_uniform;
    std::array<std::array<std::array<AdaptiveBit, kBends>, 2>, 4> same_as;
    std::array<SignedModel, kDoubts + 1> residual;  // by doubt; the last: to what it is like
    std::array<SignedModel, 4> residual_in_grains;  // by component
    // Of predict_value(), and of another value that a new one may be like: the bits that they were
    // off by, of late.
    std::array<std::uint32_t, 2> misses{};
    void learn_misses(const CodedValue& value, const CodedValue& by_map, const CodedValue& like,
                      std::size_t dimension) {
      for (std::uint32_t& miss : misses) miss -= miss / 16;
      for (std::size_t k = 0; k < dimension; ++k) {
        misses[0] += bits_between(value[k], by_map[k]);
        misses[1] += bits_between(value[k], like[k]);
      }
    }
    std::array<AdaptiveBit, 2> is_of_grain;             // by whether what is expected is
    std::array<std::array<AdaptiveBit, 2>, 2> is_kept;  // by whether the vertex stays, is new
    DirectionModel direction, corner_direction;

    explicit LayerModels(const LearningRates& rates)
        : direction(false, rates), corner_direction(true, rates) {}
  };
  struct Normals {  // of a vertex, at a layer of directions; zero where there is none
    Spot geometric{}, stored{};
  };
  void keep_coarse_positions();
  void keep_coarse_normals();
  void start_directions(const std::vector<CodedValue>& values, const OctahedralCoding& coding);
  DirectionCandidates direction_candidates(std::uint32_t v, const Spot& had, Sizes& sizes) const;
  Spot twice_area(std::uint32_t t) const;
  void find_areas();
  std::size_t bend(std::uint32_t t, std::uint32_t other) const;
  void code_categories();
  void code_derived();
  void code_layer(const BlockLayer& layer, std::vector<CodedValue>& values, std::size_t l);
  bool knows_corners(const BlockLayer& layer, std::uint32_t v) const;
  void code_vertex(const BlockLayer& layer, std::vector<CodedValue>& values, LayerModels& models,
                   std::uint32_t v);
  CodedValue code_value(const BlockLayer& layer, LayerModels& models, const CodedValue& value,
                        const CodedValue& like, const ValuePrediction& by_map);
  ValuePrediction expected_value(const BlockLayer& layer, const std::vector<CodedValue>& values,
                                 std::span<const std::uint32_t> corners);
  CodedValue code_corner_direction(const BlockLayer& layer, const std::vector<CodedValue>& values,
                                   LayerModels& models, std::size_t i, bool fan,
                                   const CodedValue& value);
  bool had_at_coarse_end(const BlockLayer& layer, std::uint32_t corner) const;
  static Spot direction_of(const BlockLayer& layer, const CodedValue& value);
  CodedValue code_shared_value(const BlockLayer& layer, const std::vector<CodedValue>& values,
                               LayerModels& models, std::uint32_t v);
  void code_labels();
  // Where the triangles lie that have a label: patches are boxes, so that tells of the others.
  struct LabelBox {
    std::uint32_t label = 0;
    std::array<double, 3> low{}, high{};
  };
  LabelBox* nearest_box(const std::array<double, 3>& place, double& distance);
  std::array<std::uint32_t, 3> neighbours_before(std::uint32_t t) const;
  bool is_new(std::uint32_t t) const { return t >= coarse_triangles_; }
  bool was_split(std::uint32_t v) const { return v >= coarse_vertices_ || generation_[v] > 0; }

  Coder& coder_;
  Guide& guide_;
  const BlockCoding& coding_;
  BlockLimits limits_;
  PatchMesh mesh_;
  std::uint32_t coarse_triangles_ = 0, coarse_vertices_ = 0;
  bool corrupt_ = false;
  TriangleLists around_;  // per vertex
  // Per vertex, of its list: what is one of the fan leaves fans in order behind.
  std::vector<RingKind> ring_kind_;
  std::vector<std::uint8_t> generation_;  // splits above, per vertex
  std::vector<FourFloats> miss_;  // per vertex: tangent, normal, and 1 where it was looked for
  float mean_size_ = 0;           // of an edge at the coarse end
  std::vector<Split> splits_;
  std::vector<std::uint32_t> labels_;
  std::vector<std::uint32_t> origin_;    // per vertex: the one at the coarse end it comes from
  std::vector<char> has_moved_;          // per vertex, from there
  std::vector<Spot> coarse_normals_;     // per vertex of the coarse end, if a layer has directions
  std::vector<Vec3i> coarse_positions_;  // likewise, if a layer is on a lattice
  std::vector<Normals> normals_;         // per vertex

  Ring ring_;
  Shape shape_, wanted_shape_;
  Fan fan_;  // the shape, if the present split is one of the fan
  bool is_one_of_fan_ = false, is_closed_fan_ = false;
  std::array<Spot, 2 * kLargestRing + 2> places_;  // of ring_.vertices, from the present vertex
  std::vector<std::uint32_t> ring_vertices_;       // scratch
  // Per vertex: when it was last found in the ring, of code_general()'s rings, and where.
  std::vector<std::uint32_t> ring_of_vertex_, rank_of_vertex_;
  std::uint32_t ring_count_ = 0;
  std::vector<char> was_derived_;  // per coarse triangle
  struct Area {
    // A triangle's normal, twice its area long; and one, with 1 as fourth, or all 0.
    Spot twice{}, unit{};
  };
  std::vector<Area> areas_;             // per triangle of the fine end
  std::vector<char> is_known_;          // per corner, of the present layer
  std::vector<CodedValue> wanted_;      // likewise; of an encoder
  std::vector<std::uint32_t> corners_;  // of the present vertex
  std::vector<CodedValue> tried_;
  std::vector<ValueSample> samples_;
  std::vector<RingVertex> ranked_;
  std::vector<LabelBox> boxes_;

  static constexpr std::size_t kMostSeen = 16;  // neighbours whose coordinates a child may have
  static constexpr std::size_t kMostTried = 6, kFarthestBeside = 17;
  static constexpr std::size_t kGenerations = 6, kSizes = 12, kValences = 12;
  MagnitudeModel root_count_, root_triangle_count_, root_block_, root_vertex_;
  AdaptiveBit is_named_;
  std::vector<VertexName> root_names_;
  std::array<SignedModel, 3> root_position_;
  struct FlagModels {
    template <std::size_t N, std::size_t M>
    using Table = std::array<std::array<std::array<AdaptiveBit, M>, N>, kGenerations>;
    Table<3, kSizes> by_size;
    Table<3, kValences> by_valence;
    Table<5, kSizes> by_neighbours;
    std::array<std::array<AdaptiveBit, 3>, kGenerations> by_kind;
  };
  FlagModels flag_models_;
  std::array<MixingWeights<4>, 3> flag_weights_;
  std::array<AdaptiveBit, 3> is_fan_;
  AdaptiveBit is_single_;
  PairOdds pair_odds_;
  MagnitudeModel introduced_count_;
  AdaptiveBit is_in_ring_, first_leads_;
  std::array<AdaptiveBit, 3> to_second_;
  struct StaysModels {
    std::array<AdaptiveBit, 16> by_share;
    std::array<std::array<AdaptiveBit, 10>, 10> by_triangles;
    std::array<std::array<AdaptiveBit, 3>, 8> by_both;
    MixingWeights<3> weights;
  };
  std::array<StaysModels, 3> stays_;  // the first child; the second by whether the first does
  std::array<PlaceModel, 5> place_models_{PlaceModel(Leaving::One, coding_.rates),
                                          PlaceModel(Leaving::SecondOfBoth, coding_.rates),
                                          PlaceModel(Leaving::FirstOfBoth, coding_.rates),
                                          PlaceModel(Leaving::SecondBetween, coding_.rates),
                                          PlaceModel(Leaving::FirstBetween, coding_.rates)};
  SeenModels seen_models_;
  SeenGate seen_gate_;
  AdaptiveBit is_between_{0.75, 10};
  EighthsModel eighths_;
  StepAxisModel step_axes_;
  std::array<AdaptiveBit, 2> same_part_;
  std::array<std::array<AdaptiveBit, 4>, 8> same_material_;
  TreeModel<6> other_material_;
  AdaptiveBit any_derived_;
  std::array<AdaptiveBit, 2> is_derived_;
  AdaptiveBit any_label_;
  std::array<std::array<AdaptiveBit, 3>, 2> same_label_;
  AdaptiveBit other_label_;
  MagnitudeModel label_;
};

}  // namespace crease::codec

#include "codec/block_attributes.h"
#include "codec/block_places.h"
#include "codec/block_splits.h"
#include "codec/block_values.h"
