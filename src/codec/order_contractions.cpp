#include "codec/order_contractions.h"

#include "base/wide.h"
#include "codec/contracting_patch.h"
#include "codec/defer_folds.h"
#include "codec/face_normals.h"
#include "codec/patch_geometry.h"
#include "codec/patch_lines.h"
#include "codec/whole_islands.h"
#include "codec/whole_parts.h"
#include "hierarchy/quadric.h"
#include "hierarchy/witnesses.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

namespace crease::codec {

namespace {

// What a face that turns by one radian costs beside one that moves by a mean edge length.
constexpr double kTurnWeight = 0.9;
// The turn counts in proportion to its chord up to this one, and to the chord's square beyond, as
// in the simplifier: squares alone make small errors all but free.
constexpr double kLinearChord = 0.8;
constexpr double kRoundingChord = 0.01;  // turns below this count less: grids round
// What the area of a part that disappears counts: quadrics count it at each of its three corners.
constexpr double kPartWeight = 3;
// Between pairs that cost the same, in flat areas nothing, the shorter goes first, as in the
// simplifier. Where more than a few of a block's do, their order says little of the simplifier's,
// and triangles could fold over.
constexpr double kLengthShare = 1e-8;
constexpr std::size_t kFewOfThem = 256;  // one of so many
constexpr double kMostCost = 1e300;      // of nonsense, that a hostile block may have
// Witnesses that are farther off than so many times what planes say: of one contraction in hundreds
// where triangles are connected. Where loose parts join, ends of a part may have joined others
// already when it is contracted itself, which comes before in the order that is found then. Where
// more than one of so many is so, all are measured again in that order.
constexpr double kAstray = 8;
constexpr std::size_t kFewAstray = 32;
// How many contractions before it the memory of one is asked for.
constexpr std::size_t kVerticesAhead = 4, kTrianglesAhead = 2;

using simplification::Quadric;

class CostEstimator {
 public:
  CostEstimator(const UnfoldedBlock& block, const ModelSchema& schema,
                std::span<const LayerValues> values, std::span<const LevelError> error_of_slot,
                const Witnesses& witnesses, const ContractingPatch& patch)
      : block_(block),
        step_(schema.facts.grid.step),
        witnesses_(witnesses, block.triangles),
        geometry_(block.end),
        surface_(block.end.positions.size()),
        is_contracted_(contracted_vertices(block)),
        is_face_(faces_of(block.end, schema.coding)),
        wedges_(block, schema.facts.layers, values, geometry_, is_contracted_),
        lines_(block, schema.coding, patch, geometry_, is_contracted_, is_face_, wedges_) {
    errors_.reserve(block.vertices.size());
    for (const std::uint32_t slot : block.vertices) {
      errors_.push_back({error_of_slot[slot], error_of_slot[slot]});
    }
    if (std::find(is_face_.begin(), is_face_.end(), 1) != is_face_.end()) {
      faces_.emplace(block, schema.coding, values, is_face_);
      if (!faces_->is_empty()) positions_ = block.end.positions;
      const double count = 3 * double(std::max<std::size_t>(1, block.end.triangles.size()));
      turn_weight_ = kTurnWeight * geometry_.edge_sum(block.end.triangles) / count;
      turn_weight_ *= turn_weight_;
    }
    add_surfaces(block.end);
  }

  // Of contracting `second` into `first`, which then stands at `parent`. See own() as well.
  double contract(ContractingPatch& patch, std::uint32_t first, std::uint32_t second,
                  const Vec3i& parent) {
    surface_[first].add(surface_[second]);
    const Quadric* const lines = lines_.join(first, second);
    const Vec3d along = geometry_.place(second) - geometry_.place(first);
    const Vec3d at = geometry_.from_origin(parent);
    const double off = surface_[first].at(at), line_off = lines ? lines->at(at) : 0;
    const double tie = kLengthShare * dot(along, along) * surface_[first].weight;
    double cost = off + line_off + tie;
    double surface = mean_distance(off, surface_[first].weight);
    const std::span<const std::uint32_t> vanished = patch.contract(first, second);
    const std::span<const std::uint32_t> around = patch.around(first);
    if (around.empty()) {
      any_part_vanishes_ = true;
      double longest = 0;
      for (const std::uint32_t t : vanished) {
        const double side2 = geometry_.longest_side2(patch.corners(t));
        const double twice_area = length(geometry_.twice_area(patch.corners(t)));
        cost += kPartWeight * 0.5 * twice_area * side2;
        if (twice_area > 0) longest = std::max(longest, side2);
      }
      surface += std::sqrt(longest);  // what it stood for is gone
    }
    const bool stays = geometry_.place(first) == at;
    geometry_.move(first, at);
    // From here on only faces ask for normals, of what is around as well if they vanish.
    const bool any_face_vanishes = std::any_of(vanished.begin(), vanished.end(),
                                               [&](std::uint32_t t) { return is_face_[t] != 0; });
    for (const std::uint32_t t : around) {
      if (!is_face_[t] && !any_face_vanishes) continue;
      const ScaledNormal before = geometry_.normal(t);
      geometry_.find_normal(t, patch.corners(t));
      if (is_face_[t]) cost += turning_cost(before, geometry_.normal(t));
    }
    for (const std::uint32_t t : vanished) {
      if (is_face_[t]) cost += vanishing_cost(geometry_.normal(t), around);
    }
    cost += wedges_.contract(patch, vanished, first, second, at);
    const double line = lines ? mean_distance(line_off, lines->weight) : 0;
    own_ = {in_units(surface), in_units(std::max(line, wedges_.displacement())),
            std::max(wedges_.degrees(), turned(patch, vanished, first, parent)), wedges_.texture()};
    Errors& errors = errors_[first];
    errors.at_fine_end = larger(errors.at_fine_end, errors_[second].at_fine_end);
    errors.now = larger(larger(errors.now, errors_[second].now),
                        added_error(errors.at_fine_end, own_, block_.coarse));
    const auto known = static_cast<float>(double(errors.now.surface) / step_);
    const float far =
        in_units(double(distance_of_witnesses(patch, vanished, first, parent, stays, known)));
    if (const float added = far - errors.at_fine_end.surface; added > own_.surface) {
      astray_count_ += double(added) > kAstray * std::max(double(own_.surface), step_);
      own_.surface = added;
      errors.now = larger(errors.now, added_error(errors.at_fine_end, own_, block_.coarse));
    }
    moves_to_end_ = moves_to_end_ && (stays || geometry_.place(second) == at);
    flat_count_ += cost <= 2 * tie;
    return cost <= kMostCost ? cost : kMostCost;  // also if it is no number
  }

  // What contracting two vertices will read of them, and then of the triangles around them.
  void prefetch_vertices(const ContractingPatch& patch, std::uint32_t first,
                         std::uint32_t second) const {
    for (const std::uint32_t v : {first, second}) {
      patch.prefetch_around(v);
      __builtin_prefetch(&surface_[v]);
      __builtin_prefetch(&surface_[v].row[2]);
      __builtin_prefetch(&geometry_.place(v));
      __builtin_prefetch(&errors_[v]);
    }
  }
  void prefetch_triangles(const ContractingPatch& patch, std::uint32_t first,
                          std::uint32_t second) const {
    for (const std::uint32_t v : {first, second}) {
      for (const std::uint32_t t : patch.around(v)) {
        __builtin_prefetch(&patch.corners(t));
        __builtin_prefetch(&geometry_.normal(t));
        __builtin_prefetch(&witnesses_.here().first[t]);
      }
    }
  }

  // Whether all contractions so far ended where one of the two was.
  bool moves_to_end() const { return moves_to_end_; }
  // Whether a part has vanished so far.
  bool any_part_vanishes() const { return any_part_vanishes_; }
  // Contractions so far that change nothing.
  std::size_t flat_count() const { return flat_count_; }
  // Contractions so far after which witnesses are much farther off than planes say.
  std::size_t astray_count() const { return astray_count_; }

  // Of the last contraction, and of `first` since.
  const LevelError& own() const { return own_; }
  const LevelError& error(std::uint32_t first) const { return errors_[first].now; }

  void give_back_witnesses(Witnesses& model) const {
    witnesses_.give_back(block_.triangles, block_.coarse_triangle_count(), model);
  }
  double radian() const { return wedges_.radian(); }
  std::vector<WedgeValues> take_wedges() { return std::move(wedges_).take(); }

 private:
  struct Errors {
    LevelError at_fine_end, now;
  };

  float in_units(double length) const { return static_cast<float>(step_ * length); }

  static std::vector<char> contracted_vertices(const UnfoldedBlock& block) {
    std::vector<char> is_contracted(block.end.positions.size(), 0);
    for (std::size_t i = 0; i < block.splits.size(); ++i) {
      is_contracted[block.splits[i].vertex] = is_contracted[block.second_child(i)] = 1;
    }
    return is_contracted;
  }

  // Triangles that show one normal, or have none of their own. Where a triangle's normal varies,
  // its wedges say what turning costs.
  static std::vector<char> faces_of(const PatchMesh& mesh, const BlockCoding& coding) {
    std::vector<char> is_face(mesh.triangles.size(), 1);
    for (std::size_t l = 0; l < coding.layers.size(); ++l) {
      if (!coding.layers[l].is_normal) continue;
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const CodedValue* values = &mesh.values[l][3 * t];
        if (mesh.derived[t] || (values[0] == values[1] && values[1] == values[2])) continue;
        is_face[t] = 0;
      }
    }
    return is_face;
  }

  // Of vertices that no contraction touches nobody asks.
  CREASE_WIDE void add_surfaces(const PatchMesh& mesh) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const Corners& corners = mesh.triangles[t];
      const ScaledNormal& n = geometry_.normal(t);
      if (n.size == 0) continue;
      Quadric plane;
      plane.add_plane(n.unit, -dot(n.unit, geometry_.place(corners[0])), 0.5 * n.size);
      plane.weight = 0.5 * n.size;
      for (const std::uint32_t v : corners) {
        if (is_contracted_[v]) surface_[v].add(plane);
      }
    }
  }

  CREASE_WIDE float distance_of_witnesses(const ContractingPatch& patch,
                                          std::span<const std::uint32_t> vanished,
                                          std::uint32_t first, const Vec3i& parent, bool stays,
                                          float known) {
    const std::span<const std::uint32_t> around = patch.around(first);
    const std::size_t first_changed = stays ? around.size() - patch.moved_count() : 0;
    const Vec3d at = geometry_.place(first);
    witness_mover_.start();
    for (std::uint32_t i = 0; i < around.size(); ++i) {
      const Corners& corners = patch.corners(around[i]);
      const std::uint32_t c = corner_of(corners, first);
      witness_mover_.add(around[i], geometry_.place(corners[kCornerAfter[c]]) - at,
                         geometry_.place(corners[kCornerBefore[c]]) - at);
      if (i >= first_changed) witness_mover_.take(around[i], i, witnesses_.here());
    }
    for (const std::uint32_t t : vanished) {
      witness_mover_.take(t, kNone, witnesses_.here());
    }
    const float farthest = witness_mover_.measure(witnesses_.here(), parent, known);
    witness_mover_.settle(witnesses_.here());
    return farthest;
  }

  // The root of the mean.
  static double mean_distance(double sum, double weight) {
    return weight > 0 ? std::sqrt(sum / weight) : 0;
  }

  double turning_cost(const ScaledNormal& before, const ScaledNormal& after) const {
    if (before.size == 0 || after.size == 0) return 0;
    const double chord2 = 2 * (1 - std::clamp(dot(before.unit, after.unit), -1.0, 1.0));
    const double weighed =
        chord2 * std::max(1.0, kLinearChord / (std::sqrt(chord2) + kRoundingChord));
    return 0.5 * turn_weight_ * after.size * weighed;
  }

  // The direction of what vanishes, unless something around it has the same.
  double vanishing_cost(const ScaledNormal& gone, std::span<const std::uint32_t> around) const {
    if (gone.size == 0) return 0;
    double best = -1;
    for (const std::uint32_t t : around) {
      const ScaledNormal& other = geometry_.normal(t);
      if (other.size > 0) best = std::max(best, dot(gone.unit, other.unit));
    }
    return turn_weight_ * gone.size * std::max(0.0, 1 - best);
  }

  float turned(const ContractingPatch& patch, std::span<const std::uint32_t> vanished,
               std::uint32_t first, const Vec3i& parent) {
    if (!faces_) return 0;
    if (!positions_.empty()) positions_[first] = parent;
    return faces_->contract(patch, vanished, first, positions_);
  }

  const UnfoldedBlock& block_;
  double step_;  // of the grid
  WitnessesOfPart witnesses_;
  WitnessMover witness_mover_;
  PatchGeometry geometry_;
  std::vector<Quadric> surface_;     // per vertex, about the origin
  std::vector<char> is_contracted_;  // per vertex: a contraction touches it
  std::vector<char> is_face_;        // per triangle; see faces_of()
  WedgeQuadrics wedges_;
  PatchLines lines_;
  std::optional<FaceNormals> faces_;
  std::vector<Vec3i> positions_;  // for faces_
  std::vector<Errors> errors_;    // per vertex
  LevelError own_;
  double turn_weight_ = 0;
  std::size_t flat_count_ = 0, astray_count_ = 0;
  bool moves_to_end_ = true, any_part_vanishes_ = false;
};

}  // namespace

LevelError added_error(const LevelError& base, const LevelError& own, const LevelError& most) {
  const auto at_most = [](float x, float limit) { return x < limit ? x : limit; };  // or no number
  const double from = double(base.degrees), by = double(own.degrees);
  const float degrees = static_cast<float>(std::sqrt(from * from + by * by));
  return {at_most(base.surface + own.surface, most.surface),
          at_most(base.line + own.line, most.line), at_most(degrees, most.degrees),
          at_most(base.texture + own.texture, most.texture)};
}

namespace {

// The errors of contractions as they come in this order.
void measure_in_order(const UnfoldedBlock& block, const ModelSchema& schema,
                      std::span<const LayerValues> values,
                      std::span<const LevelError> error_of_slot, Witnesses& witnesses,
                      std::vector<OrderedContraction>& order) {
  ContractingPatch patch(block.end);
  CostEstimator estimator(block, schema, values, error_of_slot, witnesses, patch);
  for (OrderedContraction& contraction : order) {
    const Split& split = block.splits[contraction.split];
    const std::uint32_t second = block.second_child(contraction.split);
    estimator.contract(patch, split.vertex, second, split.parent_position);
    contraction.own = estimator.own();
    contraction.error = estimator.error(split.vertex);
  }
  estimator.give_back_witnesses(witnesses);
}

}  // namespace

ContractionOrder order_contractions(const UnfoldedBlock& block, const ModelSchema& schema,
                                    std::span<const LayerValues> values,
                                    std::span<const LevelError> error_of_slot,
                                    Witnesses& witnesses) {
  ContractingPatch patch(block.end);
  CostEstimator estimator(block, schema, values, error_of_slot, witnesses, patch);
  std::vector<double> cost_of_vertex(block.vertices.size(), 0);
  std::vector<OrderedContraction> undone;
  std::vector<std::uint32_t> vanished_of_split(block.splits.size());
  std::vector<std::uint32_t> split_of_vanished(block.end.triangles.size(), kNone);
  std::vector<std::pair<double, std::uint32_t>> ranks;  // by cost, then as they were undone
  undone.reserve(block.splits.size());
  ranks.reserve(block.splits.size());
  for (std::size_t i = block.splits.size(); i-- > 0;) {
    const Split& split = block.splits[i];
    const std::uint32_t first = split.vertex, second = block.second_child(i);
    if (i >= kVerticesAhead) {
      const std::size_t later = i - kVerticesAhead;
      estimator.prefetch_vertices(patch, block.splits[later].vertex, block.second_child(later));
    }
    if (i >= kTrianglesAhead) {
      const std::size_t next = i - kTrianglesAhead;
      estimator.prefetch_triangles(patch, block.splits[next].vertex, block.second_child(next));
    }
    const double cost = std::max({estimator.contract(patch, first, second, split.parent_position),
                                  cost_of_vertex[first], cost_of_vertex[second]});
    vanished_of_split[i] = static_cast<std::uint32_t>(patch.vanished().size());
    for (const std::uint32_t t : patch.vanished()) {
      split_of_vanished[t] = static_cast<std::uint32_t>(i);
    }
    cost_of_vertex[first] = cost;
    ranks.emplace_back(cost, static_cast<std::uint32_t>(undone.size()));
    undone.push_back(
        {static_cast<std::uint32_t>(i), cost, estimator.own(), estimator.error(first)});
  }
  std::sort(ranks.begin(), ranks.end());
  std::vector<OrderedContraction> order;
  order.reserve(ranks.size());
  for (const auto& [cost, place] : ranks) order.push_back(undone[place]);
  if (estimator.flat_count() > order.size() / kFewOfThem)
    order = defer_folds(block, std::move(order));
  keep_islands_whole(block, split_of_vanished, order);
  if (estimator.any_part_vanishes()) {
    keep_parts_whole(block, vanished_of_split, estimator.radian(), order);
  }
  if (estimator.astray_count() > order.size() / kFewAstray) {
    measure_in_order(block, schema, values, error_of_slot, witnesses, order);
  } else {
    estimator.give_back_witnesses(witnesses);
  }
  const Placement placement = estimator.moves_to_end() ? Placement::Endpoint : Placement::Optimal;
  return {std::move(order), estimator.take_wedges(), placement};
}

}  // namespace crease::codec
