#include "codec/encode_block.h"

#include "base/assert.h"
#include "codec/range_encoder.h"
#include "codec/triangle_lists.h"
#include "crease/ids.h"

#include <algorithm>
#include <utility>

namespace crease::codec {

namespace {

// Knows a plan's answers; see block_coder.h. The plan's vertices are slots: a step takes one away,
// and the other's stands for the parent.
class PlanGuide {
 public:
  PlanGuide(const BlockPlan& plan, std::span<const std::uint32_t> triangles,
            std::span<const std::uint32_t> vertices, std::span<const VertexName> names)
      : plan_(plan),
        plan_of_triangle_(triangles.begin(), triangles.end()),
        slot_of_vertex_(vertices.begin(), vertices.end()) {
    follow_steps();
    order_leaves();
    find_roots(triangles, names);
  }

  void start(const PatchMesh& mesh) {
    mesh_ = &mesh;
    for (std::uint32_t t = 0; t < plan_of_triangle_.size(); ++t) {
      const std::uint32_t p = plan_of_triangle_[t];
      std::uint32_t turn = 0;
      while (coarse_corners_[p][turn] != slot_of_vertex_[mesh.triangles[t][0]]) ++turn;
      turn_.push_back(turn);
    }
    for (const std::uint32_t slot : root_slots_) slot_of_vertex_.push_back(slot);
    for (std::uint32_t v = 0; v < slot_of_vertex_.size(); ++v) {
      const std::uint32_t first = order_[slot_of_vertex_[v]];
      std::fill_n(vertex_of_leaf_.begin() + first, leaf_count_[slot_of_vertex_[v]], v);
    }
    for (const std::uint32_t p : root_plan_triangles_) {
      plan_of_triangle_.push_back(p);
      turn_.push_back(0);
      Corners corners = coarse_corners_[p];
      for (std::uint32_t& v : corners) v = vertex_of_leaf_[order_[v]];
      root_triangles_.push_back(corners);
    }
  }

  const std::vector<Vec3i>& roots() const { return root_positions_; }
  const std::vector<VertexName>& root_names() const { return root_names_; }
  const std::vector<Corners>& root_triangles() const { return root_triangles_; }

  bool is_split(std::uint32_t v) const { return step_of(v) != kNone; }
  bool goes_to_second(std::uint32_t v, std::uint32_t t) const {
    const Corners& corners = mesh_->triangles[t];
    const std::uint32_t c = corners[0] == v ? 0 : corners[1] == v ? 1 : 2;
    return is_under_second(step_of(v), fine_corner(t, c));
  }

  // Which child is called the first is the coder's choice; it holds until the split is done.
  void name_children(bool swapped) { swapped_ = swapped; }

  void introduced(std::uint32_t v, std::vector<Introduced>& result) {
    const std::uint32_t s = step_of(v);
    result.clear();
    pending_.clear();
    for (std::uint32_t i = first_introduced_[s]; i < first_introduced_[s + 1]; ++i) {
      const std::uint32_t p = introduced_[i];
      const Corners& corners = plan_.fine.triangles[p];
      std::uint32_t first = 3, second = 3;
      for (std::uint32_t c = 0; c < 3; ++c) {
        if (is_under_first(s, corners[c])) first = c;
        if (is_under_second(s, corners[c])) second = c;
      }
      CREASE_ASSERT(first < 3 && second < 3);
      const bool first_leads = (first + 1) % 3 == second;
      const std::uint32_t third = vertex_of_leaf_[order_[corners[3 - first - second]]];
      result.push_back({third, first_leads});
      pending_.push_back({p, first_leads ? first : second, result.back()});
    }
  }

  Vec3i position(std::uint32_t v, bool second) const {
    const std::uint32_t s = step_of(v);
    const bool removed = second != swapped_;
    const std::uint32_t slot = removed ? plan_.steps[s].removed : plan_.steps[s].kept;
    // The present step is on the kept one's slot.
    const std::uint32_t next = removed ? last_step_[slot] : step_before_[s];
    return next != kNone ? plan_.steps[next].position : plan_.fine.positions[slot];
  }

  void did_split(std::uint32_t v, std::uint32_t u, std::span<const Introduced> order) {
    const std::uint32_t s = step_of(v);
    const auto [removed, kept, position] = plan_.steps[s];
    last_step_[kept] = step_before_[s];
    slot_of_vertex_[v] = swapped_ ? removed : kept;
    slot_of_vertex_.push_back(swapped_ ? kept : removed);
    std::fill_n(vertex_of_leaf_.begin() + order_[removed], removed_count_[s], swapped_ ? v : u);
    std::fill_n(vertex_of_leaf_.begin() + order_[kept], kept_count_[s], swapped_ ? u : v);
    swapped_ = false;
    for (const Introduced& introduced : order) {
      const auto found = std::find_if(pending_.begin(), pending_.end(), [&](const Pending& p) {
        return p.introduced.third == introduced.third &&
               p.introduced.first_leads == introduced.first_leads;
      });
      CREASE_ASSERT(found != pending_.end());
      plan_of_triangle_.push_back(found->plan);
      turn_.push_back(found->turn);
      pending_.erase(found);
    }
  }

  std::uint32_t category(std::uint32_t t) const {
    return plan_.fine.category[plan_of_triangle_[t]];
  }
  bool derived(std::uint32_t t) const { return plan_.fine.derived[plan_of_triangle_[t]]; }
  std::uint32_t label(std::uint32_t t) const { return plan_.labels[plan_of_triangle_[t]]; }
  const CodedValue& value(std::size_t layer, std::uint32_t t, std::uint32_t c) const {
    return plan_.fine.values[layer][3 * plan_of_triangle_[t] + turned(t, c)];
  }

  std::vector<std::uint32_t> take_triangles() { return std::move(plan_of_triangle_); }
  std::vector<std::uint32_t> take_vertices() { return std::move(slot_of_vertex_); }

 private:
  struct Pending {
    std::uint32_t plan, turn;
    Introduced introduced;
  };

  // Which step takes each triangle away, and where the others' corners end.
  void follow_steps() {
    const std::size_t slots = plan_.fine.positions.size();
    coarse_corners_ = plan_.fine.triangles;
    last_step_.assign(slots, kNone);
    is_alive_.assign(plan_.fine.triangles.size(), 1);
    TriangleLists around;
    around.fill(slots, coarse_corners_, 0);
    is_removed_.assign(slots, 0);
    for (std::uint32_t s = 0; s < plan_.steps.size(); ++s) {
      const auto [removed, kept, position] = plan_.steps[s];
      is_removed_[removed] = 1;
      step_before_.push_back(std::exchange(last_step_[kept], s));
      first_introduced_.push_back(static_cast<std::uint32_t>(introduced_.size()));
      for (std::size_t i = 0; i < around[removed].size(); ++i) {
        const std::uint32_t t = around[removed][i];
        Corners& corners = coarse_corners_[t];
        if (!is_alive_[t]) continue;
        if (corners[0] == kept || corners[1] == kept || corners[2] == kept) {
          is_alive_[t] = 0;
          introduced_.push_back(t);
        } else {
          corners[corner_of(corners, removed)] = kept;
          around.add(kept, t);
        }
      }
      around.clear(removed);
    }
    first_introduced_.push_back(static_cast<std::uint32_t>(introduced_.size()));
  }

  // Numbers the slots so that those under any node follow each other, the first child's first.
  void order_leaves() {
    const std::size_t slots = plan_.fine.positions.size();
    std::vector<std::uint32_t> next(slots, kNone), last(slots);
    leaf_count_.assign(slots, 1);
    for (std::uint32_t v = 0; v < slots; ++v) last[v] = v;
    for (const auto& [removed, kept, position] : plan_.steps) {
      kept_count_.push_back(leaf_count_[kept]);
      removed_count_.push_back(leaf_count_[removed]);
      next[last[kept]] = removed;
      last[kept] = last[removed];
      leaf_count_[kept] += leaf_count_[removed];
    }
    order_.resize(slots);
    vertex_of_leaf_.assign(slots, kNone);
    std::uint32_t number = 0;
    for (std::uint32_t v = 0; v < slots; ++v) {
      if (is_removed_[v]) continue;
      for (std::uint32_t leaf = v; leaf != kNone; leaf = next[leaf]) order_[leaf] = number++;
    }
  }

  void find_roots(std::span<const std::uint32_t> triangles, std::span<const VertexName> names) {
    std::vector<char> is_given(plan_.fine.positions.size(), 0);
    for (const std::uint32_t slot : slot_of_vertex_) is_given[slot] = 1;
    for (std::uint32_t v = 0; v < is_given.size(); ++v) {
      if (is_given[v] || is_removed_[v]) continue;
      root_slots_.push_back(v);
      root_names_.push_back(names.empty() ? VertexName{kNone, 0} : names[v]);
      root_positions_.push_back(last_step_[v] == kNone ? plan_.fine.positions[v]
                                                       : plan_.steps[last_step_[v]].position);
    }
    std::vector<char> is_there(plan_.fine.triangles.size(), 0);
    for (const std::uint32_t p : triangles) is_there[p] = 1;
    for (std::uint32_t p = 0; p < is_there.size(); ++p) {
      if (is_alive_[p] && !is_there[p]) root_plan_triangles_.push_back(p);
    }
  }

  std::uint32_t step_of(std::uint32_t v) const { return last_step_[slot_of_vertex_[v]]; }
  bool is_under(std::uint32_t node_slot, std::uint32_t count, std::uint32_t slot) const {
    return order_[slot] - order_[node_slot] < count;
  }
  bool is_under_kept(std::uint32_t s, std::uint32_t slot) const {
    return is_under(plan_.steps[s].kept, kept_count_[s], slot);
  }
  bool is_under_removed(std::uint32_t s, std::uint32_t slot) const {
    return is_under(plan_.steps[s].removed, removed_count_[s], slot);
  }
  bool is_under_first(std::uint32_t s, std::uint32_t slot) const {
    return swapped_ ? is_under_removed(s, slot) : is_under_kept(s, slot);
  }
  bool is_under_second(std::uint32_t s, std::uint32_t slot) const {
    return swapped_ ? is_under_kept(s, slot) : is_under_removed(s, slot);
  }
  std::uint32_t fine_corner(std::uint32_t t, std::uint32_t c) const {
    return plan_.fine.triangles[plan_of_triangle_[t]][turned(t, c)];
  }
  std::uint32_t turned(std::uint32_t t, std::uint32_t c) const {
    const std::uint32_t corner = c + turn_[t];
    return corner < 3 ? corner : corner - 3;
  }

  const BlockPlan& plan_;
  const PatchMesh* mesh_ = nullptr;                     // the coder's
  std::vector<std::uint32_t> plan_of_triangle_, turn_;  // per triangle of the coder
  std::vector<std::uint32_t> slot_of_vertex_;           // per vertex of the coder

  std::vector<Corners> coarse_corners_;  // per plan triangle
  std::vector<char> is_alive_;           // per plan triangle, at the coarse end
  std::vector<char> is_removed_;         // per slot
  std::vector<std::uint32_t> introduced_, first_introduced_;  // step after step; where each starts
  std::vector<std::uint32_t> last_step_;    // per slot: of those that are not split yet, or kNone
  std::vector<std::uint32_t> step_before_;  // per step: the one before on the kept one's slot
  std::vector<std::uint32_t> order_, leaf_count_;          // per slot
  std::vector<std::uint32_t> kept_count_, removed_count_;  // per step: leaves under its children
  std::vector<std::uint32_t> vertex_of_leaf_;              // per number in order_
  std::vector<std::uint32_t> root_slots_, root_plan_triangles_;
  std::vector<Vec3i> root_positions_;
  std::vector<VertexName> root_names_;
  std::vector<Corners> root_triangles_;
  std::vector<Pending> pending_;  // of the present split
  bool swapped_ = false;          // likewise: the removed one is the first child
};

}  // namespace

EncodedBlock encode_block(const BlockPlan& plan, std::uint32_t block, const BlockCoding& coding,
                          CoarseEnd start, std::span<const std::uint32_t> triangles,
                          std::span<const std::uint32_t> vertices,
                          std::span<const VertexName> names) {
  PlanGuide guide(plan, triangles, vertices, names);
  RangeEncoder encoder;
  const BlockLimits limits{static_cast<std::uint32_t>(plan.fine.positions.size()),
                           static_cast<std::uint32_t>(plan.fine.triangles.size())};
  BlockCoder coder(encoder, guide, coding, limits, std::move(start.mesh));
  guide.start(coder.mesh());
  const bool coded = coder.run();
  CREASE_ASSERT(coded);
  EncodedBlock result;
  result.bytes = encoder.finish();
  result.decoded = {coder.take_end(block, std::move(start.names)), coder.take_splits()};
  result.plan_of_triangle = guide.take_triangles();
  result.plan_of_vertex = guide.take_vertices();
  return result;
}

}  // namespace crease::codec
