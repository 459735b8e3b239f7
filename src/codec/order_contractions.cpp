#include "codec/order_contractions.h"

#include "base/wide.h"
#include "codec/contracting_patch.h"
#include "codec/defer_folds.h"
#include "codec/face_normals.h"
#include "codec/patch_geometry.h"
#include "codec/patch_lines.h"
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
constexpr std::size_t kFewOfThem = 8;  // one of so many
constexpr double kMostCost = 1e300;    // of nonsense, that a hostile block may have

using simplification::Quadric;

class CostEstimator {
 public:
  CostEstimator(const UnfoldedBlock& block, const BlockCoding& coding,
                std::span<const LayerSchema> layers, std::span<const LayerValues> values,
                const ContractingPatch& patch, Witnesses& witnesses)
      : block_(block),
        witnesses_(witnesses),
        geometry_(block.end),
        surface_(block.end.positions.size()),
        is_contracted_(contracted_vertices(block)),
        is_face_(faces_of(block.end, coding)),
        wedges_(block, layers, values, geometry_, is_contracted_),
        lines_(block, coding, patch, geometry_, is_contracted_, is_face_, wedges_) {
    if (std::find(is_face_.begin(), is_face_.end(), 1) != is_face_.end()) {
      faces_.emplace(block, coding, values, is_face_);
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
      double longest = 0;
      for (const std::uint32_t t : vanished) {
        const double side2 = geometry_.longest_side2(patch.corners(t));
        cost += kPartWeight * 0.5 * geometry_.normal(t).size * side2;
        longest = std::max(longest, side2);
      }
      surface += std::sqrt(longest);  // what it stood for is gone
    }
    const bool stays = geometry_.place(first) == at;
    geometry_.move(first, at);
    for (const std::uint32_t t : around) {
      const ScaledNormal before = geometry_.normal(t);
      geometry_.find_normal(t, patch.corners(t));
      if (is_face_[t]) cost += turning_cost(before, geometry_.normal(t));
    }
    for (const std::uint32_t t : vanished) {
      if (is_face_[t]) cost += vanishing_cost(geometry_.normal(t), around);
    }
    cost += wedges_.contract(patch, vanished, first, second, at);
    own_ = {static_cast<float>(surface),
            static_cast<float>(lines ? mean_distance(line_off, lines->weight) : 0),
            std::max(wedges_.degrees(), turned(patch, vanished, first, parent)), wedges_.texture()};
    far_ = distance_of_witnesses(patch, vanished, first, parent, stays);
    flat_count_ += cost <= 2 * tie;
    return cost <= kMostCost ? cost : kMostCost;  // also if it is no number
  }

  // Contractions so far that change nothing.
  std::size_t flat_count() const { return flat_count_; }

  // Of the last contraction: see OrderedContraction.
  const LevelError& own() const { return own_; }
  float far() const { return far_; }

  std::vector<WedgeValues> take_wedges() { return std::move(wedges_).take(); }

 private:
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
                                          std::uint32_t first, const Vec3i& parent, bool stays) {
    const std::span<const std::uint32_t> around = patch.around(first);
    const std::size_t first_changed = stays ? around.size() - patch.moved_count() : 0;
    const Vec3d at = geometry_.place(first);
    witness_mover_.start();
    for (std::uint32_t i = 0; i < around.size(); ++i) {
      const Corners& corners = patch.corners(around[i]);
      const std::uint32_t c = corner_of(corners, first), t = block_.triangles[around[i]];
      witness_mover_.add(t, geometry_.place(corners[kCornerAfter[c]]) - at,
                         geometry_.place(corners[kCornerBefore[c]]) - at);
      if (i >= first_changed) witness_mover_.take(t, i, witnesses_);
    }
    for (const std::uint32_t t : vanished) {
      witness_mover_.take(block_.triangles[t], kNone, witnesses_);
    }
    const float farthest = witness_mover_.measure(witnesses_, parent);
    witness_mover_.settle(witnesses_);
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
  Witnesses& witnesses_;  // of the model
  WitnessMover witness_mover_;
  PatchGeometry geometry_;
  std::vector<Quadric> surface_;     // per vertex, about the origin
  std::vector<char> is_contracted_;  // per vertex: a contraction touches it
  std::vector<char> is_face_;        // per triangle; see faces_of()
  WedgeQuadrics wedges_;
  PatchLines lines_;
  std::optional<FaceNormals> faces_;
  std::vector<Vec3i> positions_;  // for faces_
  float far_ = 0;
  LevelError own_;
  double turn_weight_ = 0;
  std::size_t flat_count_ = 0;
};

}  // namespace

ContractionOrder order_contractions(const UnfoldedBlock& block, const BlockCoding& coding,
                                    std::span<const LayerSchema> layers,
                                    std::span<const LayerValues> values, Witnesses& witnesses) {
  ContractingPatch patch(block.end);
  CostEstimator estimator(block, coding, layers, values, patch, witnesses);
  std::vector<double> cost_of_vertex(block.vertices.size(), 0);
  std::vector<OrderedContraction> order;
  order.reserve(block.splits.size());
  for (std::size_t i = block.splits.size(); i-- > 0;) {
    const Split& split = block.splits[i];
    const std::uint32_t first = split.vertex, second = block.second_child(i);
    const double cost = std::max({estimator.contract(patch, first, second, split.parent_position),
                                  cost_of_vertex[first], cost_of_vertex[second]});
    cost_of_vertex[first] = cost;
    order.push_back({static_cast<std::uint32_t>(i), cost, estimator.own(), estimator.far()});
  }
  std::stable_sort(
      order.begin(), order.end(),
      [](const OrderedContraction& a, const OrderedContraction& b) { return a.cost < b.cost; });
  if (estimator.flat_count() > order.size() / kFewOfThem)
    order = defer_folds(block, std::move(order));
  return {std::move(order), estimator.take_wedges()};
}

}  // namespace crease::codec
