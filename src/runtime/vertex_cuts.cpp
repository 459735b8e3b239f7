// The updates. Which blocks are by vertex and what they are to each other is in
// vertex_cuts_links.cpp.
#include "runtime/vertex_cuts.h"

#include <algorithm>
#include <limits>
#include <map>

namespace crease {

namespace {

// Blocks whose errors are worked out anew in one update.
constexpr int kNewErrors = 16;
// So many updates after it has last moved a block goes to rest.
constexpr std::uint64_t kUpdatesUntilRest = 30;
constexpr double kFar = 1e15;  // beside which no step counts

// The view of one block among many: budgets are the mesh's.
ViewParameters without_budgets(ViewParameters view) {
  view.max_triangles = std::numeric_limits<std::size_t>::max();
  view.max_seconds = std::numeric_limits<double>::infinity();
  view.clock = nullptr;
  view.clock_context = nullptr;
  return view;
}

}  // namespace

void VertexCuts::insert(BlockHierarchyPtr hierarchy) {
  const std::size_t block = index_of(hierarchy->id());
  if (block >= entries_.size()) entries_.resize(block + 1);
  Entry& entry = entries_[block];
  if (entry.hierarchy) return;
  entry.hierarchy = std::move(hierarchy);
  has_changed_ = true;
  if (entry.hierarchy->data().is_empty) return;
  entry.errors = std::make_unique<BlockErrors>(entry.hierarchy->data());
  mark_stale(static_cast<std::uint32_t>(block));
  for (const std::uint32_t coarser : graph_.dependencies(static_cast<std::uint32_t>(block))) {
    mark_stale(coarser);
  }
}

std::vector<float> VertexCuts::error_of_position(std::uint32_t block) const {
  const Entry& entry = entries_[block];
  const BlockHierarchy::Data& data = entry.cut->data();
  std::vector<RoundedError> of_leaf(data.hierarchy.vertices.node_count());
  for (std::size_t v = 0; v < data.leaf_of_vertex.size(); ++v) {
    of_leaf[index_of(data.leaf_of_vertex[v])] = entry.errors->of_vertices()[v];
  }
  std::vector<float> errors;
  for (const ActiveVertex& v : entry.cut->live()->vertices()) {
    RoundedError error;
    if (v.node != kNoNode) {
      error = v.split == kNoSplit ? of_leaf[index_of(v.node)]
                                  : error_of(entry.cut->bounds()[index_of(v.split)]);
    }
    errors.push_back(worse(error.surface, error.line).value());
  }
  return errors;
}

void VertexCuts::drop(std::uint32_t block) {
  if (block >= entries_.size()) return;
  hide(block);
  Entry dropped = std::exchange(entries_[block], {});
  if (dropped.hierarchy) unused_.push_back(std::move(dropped.hierarchy));
  if (dropped.errors) unused_.push_back(std::move(dropped.errors));
  if (dropped.cut) unused_.push_back(std::move(dropped.cut));
  has_changed_ = true;
}

void VertexCuts::clear() {
  for (Entry& entry : entries_) {
    Entry cleared;
    cleared.hierarchy = std::move(entry.hierarchy);
    cleared.errors = std::move(entry.errors);
    cleared.is_stale = entry.is_stale;
    entry = std::move(cleared);
  }
  waiting_to_rest_.clear();
  has_changed_ = has_arrived_ = true;
}

std::size_t VertexCuts::bytes_of(std::uint32_t block) const {
  if (block >= entries_.size()) return 0;
  const Entry& entry = entries_[block];
  return (entry.hierarchy ? entry.hierarchy->bytes() : 0) +
         (entry.errors ? entry.errors->bytes() : 0) + (entry.cut ? entry.cut->bytes() : 0) +
         sizeof(Source) * entry.sources.capacity();
}

void VertexCuts::mark_stale(std::uint32_t block) {
  if (block >= entries_.size() || !entries_[block].errors || entries_[block].is_stale) return;
  entries_[block].is_stale = true;
  stale_.push_back(block);
  std::push_heap(stale_.begin(), stale_.end());
}

// From fine to coarse.
void VertexCuts::settle_errors(const Blocks& blocks) {
  for (int i = 0; i < kNewErrors && !stale_.empty(); ++i) {
    std::pop_heap(stale_.begin(), stale_.end());
    const std::uint32_t block = stale_.back();
    stale_.pop_back();
    Entry& entry = entries_[block];
    if (!entry.is_stale) continue;
    entry.is_stale = false;
    tighten(block, blocks);
    const BlockErrors::Change change = entry.errors->settle();
    if (change.of_splits && entry.cut) entry.cut->look_anew();
    if (!change.of_roots) continue;
    for (const std::uint32_t coarser : graph_.dependencies(block)) mark_stale(coarser);
  }
}

// By the roots of finer blocks: the triangles of a group are those of its coarse end, in order.
void VertexCuts::tighten(std::uint32_t block, const Blocks& blocks) {
  const ResidentBlock& resident = *blocks.resident[block];
  const BlockHierarchy::Data& data = entries_[block].hierarchy->data();
  const KeptEnd& fine = resident.data().end;
  for (const BlockGroup& group : resident.groups()) {
    const std::uint32_t finer = graph_.next_finer(resident.facts().band, group.patch);
    if (finer >= entries_.size() || !entries_[finer].errors) continue;
    const std::span<const std::uint32_t> needed = graph_.dependencies(finer);
    if (!std::all_of(needed.begin(), needed.end(),
                     [&](std::uint32_t n) { return blocks.resident[n] != nullptr; })) {
      continue;
    }
    const BlockErrors& errors = *entries_[finer].errors;
    const BlockHierarchy::Data& finer_data = entries_[finer].hierarchy->data();
    const std::vector<Source> sources = sources_of(finer, blocks);
    for (std::size_t i = 0; i < sources.size(); ++i) {
      if (sources[i].block != block) continue;
      const std::uint32_t end =
          i + 1 < sources.size() ? sources[i + 1].first : finer_data.coarse_triangles;
      for (std::uint32_t t = sources[i].first; t < end; ++t) {
        const codec::Corners corners =
            fine.triangle(data.triangles_by_patch[sources[i].there + t - sources[i].first]);
        const codec::Corners& roots = finer_data.roots_of_triangle[t];
        for (std::size_t k = 0; k < 3; ++k) {
          entries_[block].errors->tighten(corners[k], errors.of_root(roots[k]));
        }
      }
    }
  }
}

VertexCuts::Report VertexCuts::update(const Blocks& blocks, const ViewParameters& view,
                                      bool cut_has_changed) {
  Report report;
  resized_.clear();
  entries_.resize(std::max(entries_.size(), blocks.resident.size()));
  if (cut_has_changed || has_changed_) {
    has_changed_ = false;
    report.have_changed = link(blocks);
  }
  settle_errors(blocks);
  look(view);
  move(blocks, view, report);
  return report;
}

void VertexCuts::look(const ViewParameters& view) {
  ViewParameters moved = now_.view;
  moved.camera.position = view.camera.position;
  moved.camera.target = view.camera.target;
  moved.camera.up = view.camera.up;
  const ViewError before = now_.error;
  const ViewParameters one = without_budgets(view);
  if (now_.kind != 0 && one == now_.view) return;
  ++now_.number;
  now_.view = one;
  now_.error = ViewError(now_.view, grid_);
  if (now_.kind == 0 || !(moved == now_.view)) ++now_.kind;
  const ViewError::Motion motion = now_.error.motion_from(before);
  now_.travel += motion.travel;
  now_.turn += motion.turn;
  if (now_.travel < kFar) return;
  ++now_.kind;  // what is travelled from here on would be lost in it
  now_.travel = now_.turn = 0;
}

// Blocks that have not seen a view in this round come first: if time is over, the others stay as
// they were seen. What finer blocks want of them is done all the same.
void VertexCuts::begin_round(const Blocks& blocks) {
  const bool is_over = std::none_of(blocks.cut.begin(), blocks.cut.end(), [this](std::uint32_t b) {
    const Entry& entry = entries_[b];
    return entry.cut && entry.cut->is_due(now_) && entry.seen_in_round != round_;
  });
  if (is_over) ++round_;
}

void VertexCuts::move(const Blocks& blocks, const ViewParameters& view, Report& report) {
  const bool has_clock = view.clock != nullptr;
  const double stop_at = has_clock ? view.clock(view.clock_context) + view.max_seconds : 0;
  ++updates_;
  has_arrived_ = !has_changed_ && stale_.empty();
  if (has_clock) begin_round(blocks);
  for (std::size_t i = blocks.cut.size(); i-- > 0;) {
    const std::uint32_t block = blocks.cut[i];
    Entry& entry = entries_[block];
    if (!entry.cut || !entry.cut->must_update(now_)) continue;
    const bool may_look =
        !has_clock || (entry.seen_in_round != round_ && view.clock(view.clock_context) < stop_at);
    if (may_look) entry.seen_in_round = round_;
    const UpdateReport moved = entry.cut->update(now_, may_look);
    report.splits += moved.splits;
    report.merges += moved.merges;
    report.evaluated += moved.evaluated;
    has_arrived_ &= may_look || !entry.cut->is_due(now_);
    tell(entry);
    let_rest(block);
    resized_.push_back(block);
  }
  while (!waiting_to_rest_.empty() &&
         waiting_to_rest_.front().since + kUpdatesUntilRest < updates_) {
    const std::uint32_t block = waiting_to_rest_.front().block;
    waiting_to_rest_.pop_front();
    BlockCut* const cut = entries_[block].cut.get();
    if (cut == nullptr || !cut->is_waiting_to_rest) continue;
    cut->is_waiting_to_rest = false;
    if (cut->could_rest()) cut->rest();
    resized_.push_back(block);
  }
}

// Coarser blocks what has changed in what it wants of them.
void VertexCuts::tell(Entry& entry) {
  if (entry.cut->known_links() == nullptr) return;
  for (const BlockLinks::Change& c : entry.cut->known_links()->root_changes()) {
    want(c.index, entry, c.is_on);
  }
  for (const BlockLinks::Change& c : entry.cut->known_links()->triangle_changes()) {
    take(c.index, entry, c.is_on);
  }
  entry.cut->forget_changes();
}

void VertexCuts::let_rest(std::uint32_t block) {
  BlockCut& cut = *entries_[block].cut;
  if (cut.is_waiting_to_rest || !cut.could_rest()) return;
  cut.is_waiting_to_rest = true;
  waiting_to_rest_.push_back({updates_, block});
}

}  // namespace crease
