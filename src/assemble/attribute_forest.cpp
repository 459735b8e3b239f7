#include "assemble/attribute_forest.h"

#include "assemble/attribute_rules.h"
#include "assemble/number_attributes.h"
#include "mesh/disjoint_sets.h"

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>

namespace crease {

namespace {

// An attribute as it stands at some node: a set of leaf attributes, described at its smallest one.
// Times and region are those of all of them.
struct Standing {
  AttributeId id{};
  std::uint32_t live_until = 0;
  std::uint32_t shown_until = 0;
  std::uint32_t region = 0, corner = 0;
  std::uint32_t relative = 0;  // its index at the node where it stands now
  std::uint32_t first_wedge = kNone, last_wedge = kNone;  // chained by next_wedge_
  bool is_face_value = false;
  bool all_vary = false;  // of its wedges those that are live
};

class AttributeForest {
 public:
  AttributeForest(const AttributeInput& input, std::size_t layer)
      : in_(input),
        layer_(layer),
        leaves_(input.wedges.layers[layer]),
        values_(input.snapped.layers[layer], input.sequence, layer),
        sets_(leaves_.attributes.size()),
        next_wedge_(leaves_.of_wedge.size(), kNone) {}

  Result<AttributeHierarchy> run() {
    stand_at_leaves();
    for (std::uint32_t contraction : in_.forest.from_left_to_right) contract(contraction);
    for (const Slice& slice : grown_.at_birth) {
      if (slice.count >= kRemoved) {
        return fail(Error::NotSupported, "layer '" + values_.source().name + "': a vertex has " +
                                             std::to_string(slice.count) +
                                             " attributes, 65,534 are possible");
      }
    }
    return number_attributes(in_, layer_, values_, grown_);
  }

 private:
  void stand_at_leaves() {
    grown_.at_birth.resize(in_.forest.node_of_birth.size());
    grown_.parents_at.resize(in_.forest.contraction_count());
    grown_.branches_at.resize(in_.forest.contraction_count());
    grown_.varies_of_wedge.assign(leaves_.of_wedge.size(), false);
    for (std::uint32_t v = 0; v < in_.forest.leaf_count; ++v) {
      const std::uint32_t first = leaves_.first_of_vertex[v];
      grown_.at_birth[v] = {first, leaves_.first_of_vertex[v + 1] - first};
      for (std::uint32_t a = first; a < leaves_.first_of_vertex[v + 1]; ++a) {
        const LeafAttributes::Attribute& leaf = leaves_.attributes[a];
        grown_.at_node.push_back({a, leaf.id});
        standing_.push_back({.id = leaf.id,
                             .region = leaf.region,
                             .corner = leaf.corner,
                             .relative = a - first,
                             .is_face_value = leaf.is_face_value});
      }
    }
    const bool is_normal = values_.source().role == AttributeRole::Normal;
    const std::vector<std::uint32_t>& shown_until =
        is_normal ? in_.times.normal_shown_until : in_.times.wedge_shown_until;
    for (std::uint32_t w = 0; w < leaves_.of_wedge.size(); ++w) {
      Standing& s = standing_[leaves_.of_wedge[w]];
      s.live_until = std::max(s.live_until, in_.times.wedge_live_until[w]);
      s.shown_until = std::max(s.shown_until, shown_until[w]);
      append_wedges(s, w, w);
    }
  }

  void append_wedges(Standing& s, std::uint32_t first, std::uint32_t last) {
    if (first == kNone) return;
    if (s.first_wedge == kNone) {
      s.first_wedge = first;
    } else {
      next_wedge_[s.last_wedge] = first;
    }
    s.last_wedge = last;
  }

  void contract(std::uint32_t time) {
    const auto& [t, u] = in_.forest.children[time];
    const Slice at_t = grown_.at_birth[t], at_u = grown_.at_birth[u];
    gather(time, at_t, at_u);
    const std::span<const AttributeId> results =
        rules_.apply(candidates_, links_, in_.sequence.changes_of(in_.sequence.contractions[time]),
                     layer_, values_);
    order_results(results);
    note_parents(time, at_t, at_u);
    const auto first_branch = static_cast<std::uint32_t>(grown_.branches.size());
    note_branches(time, 0, at_t.count);
    note_branches(time, at_t.count, at_u.count);
    grown_.branches_at[time] = {first_branch,
                                static_cast<std::uint32_t>(grown_.branches.size()) - first_branch};
    stand_at_parent(time);
  }

  // Candidates, those of v_t first, and what the introduced triangles link.
  void gather(std::uint32_t time, Slice at_t, Slice at_u) {
    members_.clear();
    candidates_.clear();
    for (const Slice& slice : {at_t, at_u}) {
      for (std::uint32_t k = 0; k < slice.count; ++k) {
        const std::uint32_t set = sets_.find(grown_.at_node[slice.first + k].set);
        const Standing& s = standing_[set];
        members_.push_back(set);
        candidates_.push_back({s.id, s.live_until > time, s.shown_until > time, s.is_face_value});
      }
    }
    links_.clear();
    const SplitId split = in_.forest.split_of_contraction[time];
    const TriangleRange born = in_.vertices.triangles_of(split);
    for (std::uint32_t n = born.begin; n < born.end; ++n) add_link(n, time, at_t.count);
  }

  void add_link(std::uint32_t triangle, std::uint32_t time, std::uint32_t first_of_u) {
    // The corners at v_t and v_u are those whose wedges stand there: both are found among the
    // members, the third one is not.
    std::uint32_t ends[2] = {kNone, kNone};
    for (WedgeId wedge : in_.vertices.triangles[triangle]) {
      const std::uint32_t set = sets_.find(leaves_.of_wedge[index_of(wedge)]);
      const std::uint32_t relative = standing_[set].relative;
      const bool second = in_.vertices.goes_to_second(in_.forest.split_of_contraction[time], wedge);
      const std::uint32_t member = relative + (second ? first_of_u : 0);
      const std::uint32_t count = second ? static_cast<std::uint32_t>(members_.size()) : first_of_u;
      if (member < count && members_[member] == set) ends[second ? 1 : 0] = member;
    }
    if (ends[0] != kNone && ends[1] != kNone) links_.emplace_back(ends[0], ends[1]);
  }

  // parent_: relative indices at v_s, in the order of their regions.
  void order_results(std::span<const AttributeId> results) {
    groups_.clear();
    for (std::uint32_t m = 0; m < members_.size(); ++m) {
      if (results[m] == kNoAttribute) continue;
      const Standing& s = standing_[members_[m]];
      groups_.push_back({results[m], s.region, s.corner, m});
    }
    std::sort(groups_.begin(), groups_.end(), [](const Group& a, const Group& b) {
      return std::tuple(a.id, a.region, a.corner) < std::tuple(b.id, b.region, b.corner);
    });
    // Each group takes the place of its first member.
    std::uint32_t first = 0;
    for (std::uint32_t g = 0; g < groups_.size(); ++g) {
      if (groups_[g].id != groups_[first].id) first = g;
      groups_[g].region = groups_[first].region;
      groups_[g].corner = groups_[first].corner;
    }
    std::sort(groups_.begin(), groups_.end(), [](const Group& a, const Group& b) {
      return std::tuple(a.region, a.corner, a.id, a.member) <
             std::tuple(b.region, b.corner, b.id, b.member);
    });
    parent_.assign(members_.size(), kRemoved);
    result_count_ = 0;
    for (std::uint32_t g = 0; g < groups_.size(); ++g) {
      if (g == 0 || groups_[g].id != groups_[g - 1].id) ++result_count_;
      parent_[groups_[g].member] = result_count_ - 1;
    }
  }

  void note_parents(std::uint32_t time, Slice at_t, Slice at_u) {
    const bool ordinary = at_t.count <= 1 && at_u.count <= 1 &&
                          std::count(parent_.begin(), parent_.end(), 0u) ==
                              static_cast<std::ptrdiff_t>(parent_.size());
    if (ordinary || result_count_ == 0) return;
    grown_.parents_at[time] = {static_cast<std::uint32_t>(grown_.parents.size()),
                               static_cast<std::uint32_t>(parent_.size())};
    for (std::uint32_t p : parent_) grown_.parents.push_back(static_cast<RelativeAttribute>(p));
  }

  // Where several of one child became one, the wedges tell which is which. Wedges that no cut shows
  // at v_s any more are dropped from their chains for good, so that chains stay as long as a ring.
  void note_branches(std::uint32_t time, std::uint32_t first, std::uint32_t count) {
    if (count < 2) return;
    shared_by_.assign(result_count_, 0);
    for (std::uint32_t k = 0; k < count; ++k) {
      if (parent_[first + k] != kRemoved) ++shared_by_[parent_[first + k]];
    }
    runs_.clear();
    for (std::uint32_t k = 0; k < count; ++k) {
      if (parent_[first + k] == kRemoved || shared_by_[parent_[first + k]] < 2) continue;
      drop_dead_wedges(standing_[members_[first + k]], time);
      std::uint32_t w = standing_[members_[first + k]].first_wedge;
      for (; w != kNone; w = next_wedge_[w]) {
        runs_.push_back({WedgeId{w}, static_cast<RelativeAttribute>(k)});
      }
    }
    std::sort(runs_.begin(), runs_.end(),
              [](const BranchRun& a, const BranchRun& b) { return a.first_wedge < b.first_wedge; });
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      if (r == 0 || runs_[r].at_child != runs_[r - 1].at_child) grown_.branches.push_back(runs_[r]);
    }
  }

  void drop_dead_wedges(Standing& s, std::uint32_t time) {
    std::uint32_t w = s.first_wedge;
    s.first_wedge = s.last_wedge = kNone;
    while (w != kNone) {
      const std::uint32_t next = next_wedge_[w];
      next_wedge_[w] = kNone;
      if (in_.times.wedge_live_until[w] > time) append_wedges(s, w, w);
      w = next;
    }
  }

  void stand_at_parent(std::uint32_t time) {
    const auto first = static_cast<std::uint32_t>(grown_.at_node.size());
    grown_.at_birth[in_.forest.leaf_count + time] = {first, result_count_};
    std::uint32_t previous = kNone;
    for (const Group& group : groups_) {
      const std::uint32_t relative = parent_[group.member];
      const std::uint32_t member = members_[group.member];
      if (standing_[member].id != group.id) note_varying(standing_[member], time);
      if (relative == previous) {
        grown_.at_node.back().set = unite(grown_.at_node.back().set, member);
      } else {
        grown_.at_node.push_back({member, group.id});
      }
      Standing& s = standing_[grown_.at_node.back().set];
      s.id = group.id;
      s.relative = relative;
      previous = relative;
    }
  }

  // Its wedges are about to have another id.
  void note_varying(Standing& s, std::uint32_t time) {
    if (s.all_vary) return;
    s.all_vary = true;
    for (std::uint32_t w = s.first_wedge; w != kNone; w = next_wedge_[w]) {
      if (in_.times.wedge_live_until[w] > time) grown_.varies_of_wedge[w] = true;
    }
  }

  std::uint32_t unite(std::uint32_t a, std::uint32_t b) {
    if (a == b) return a;
    sets_.unite(a, b);
    if (sets_.find(a) != a) std::swap(a, b);
    Standing& all = standing_[a];
    const Standing& other = standing_[b];
    all.live_until = std::max(all.live_until, other.live_until);
    all.shown_until = std::max(all.shown_until, other.shown_until);
    std::tie(all.region, all.corner) =
        std::min(std::tuple(all.region, all.corner), std::tuple(other.region, other.corner));
    all.is_face_value = all.is_face_value || other.is_face_value;
    all.all_vary = all.all_vary && other.all_vary;
    append_wedges(all, other.first_wedge, other.last_wedge);
    return a;
  }

  struct Group {
    AttributeId id;
    std::uint32_t region, corner;
    std::uint32_t member;
  };

  const AttributeInput& in_;
  const std::size_t layer_;
  const LeafAttributes& leaves_;
  RuledValues values_;
  DisjointSets sets_;                      // of leaf attributes
  std::vector<Standing> standing_;         // per leaf attribute, valid at the smallest of a set
  std::vector<std::uint32_t> next_wedge_;  // per wedge
  GrownAttributes grown_;

  // Of one contraction.
  AttributeRules rules_;
  std::vector<std::uint32_t> members_;  // sets
  std::vector<Candidate> candidates_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> links_;
  std::vector<Group> groups_;
  std::vector<std::uint32_t> parent_;  // per member, or kRemoved
  std::uint32_t result_count_ = 0;
  std::vector<std::uint32_t> shared_by_;
  std::vector<BranchRun> runs_;
};

}  // namespace

Result<AttributeHierarchy> grow_attributes(const AttributeInput& input, std::size_t layer) {
  return AttributeForest(input, layer).run();
}

}  // namespace crease
