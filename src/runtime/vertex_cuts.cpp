#include "runtime/vertex_cuts.h"

#include <algorithm>
#include <limits>
#include <map>

namespace crease {

namespace {

// Of the fine ends of blocks that become by vertex in one update: each starts with its coarse end,
// and is split as far as the view wants.
constexpr std::size_t kNewTriangles = 32'000;
// Blocks whose errors are worked out anew in one update.
constexpr int kNewErrors = 16;

}  // namespace

void VertexCuts::insert(BlockHierarchyPtr hierarchy) {
  const std::size_t block = index_of(hierarchy->id());
  if (block >= entries_.size()) entries_.resize(block + 1);
  if (entries_[block].hierarchy) return;
  Entry& entry = entries_[block];
  entry.hierarchy = std::move(hierarchy);
  has_changed_ = true;
  if (entry.hierarchy->data().is_empty) return;
  entry.errors = std::make_unique<BlockErrors>(entry.hierarchy->data());
  mark_stale(static_cast<std::uint32_t>(block));
  for (const std::uint32_t coarser : graph_.dependencies(static_cast<std::uint32_t>(block))) {
    mark_stale(coarser);
  }
}

void VertexCuts::mark_stale(std::uint32_t block) {
  if (!entries_[block].errors || entries_[block].is_stale) return;
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
    if (!entry.errors->settle()) continue;
    if (entry.cut) entry.cut->look_anew();
    for (const std::uint32_t coarser : graph_.dependencies(block)) mark_stale(coarser);
  }
}

// By the roots of finer blocks: the triangles of a group are those of its coarse end, in order.
void VertexCuts::tighten(std::uint32_t block, const Blocks& blocks) {
  const ResidentBlock& resident = *blocks.resident[block];
  const codec::FineEnd& end = resident.data().end;
  struct Group {
    const Entry* finer = nullptr;
    std::size_t next = 0;
  };
  std::map<std::uint32_t, Group> groups;
  for (const BlockGroup& group : resident.groups()) {
    const std::uint32_t finer = graph_.next_finer(resident.facts().band, group.patch);
    if (finer >= entries_.size() || !entries_[finer].errors) continue;
    const std::span<const std::uint32_t> needed = graph_.dependencies(finer);
    if (std::find(needed.begin(), needed.end(), block) == needed.end()) continue;
    if (!std::all_of(needed.begin(), needed.end(),
                     [&](std::uint32_t n) { return blocks.resident[n] != nullptr; })) {
      continue;
    }
    groups[group.patch] = {&entries_[finer], first_triangle_in(finer, block, blocks)};
  }
  for (std::size_t t = 0; t < end.labels.size(); ++t) {
    const auto at = groups.find(end.labels[t]);
    if (at == groups.end()) continue;
    const Entry& finer = *at->second.finer;
    const codec::Corners& roots = finer.hierarchy->data().roots_of_triangle[at->second.next++];
    for (std::size_t k = 0; k < 3; ++k) {
      entries_[block].errors->tighten(end.mesh.triangles[t][k], finer.errors->of_root(roots[k]));
    }
  }
}

void VertexCuts::drop(std::uint32_t block) {
  if (block >= entries_.size()) return;
  unlink(block);
  entries_[block] = {};
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
  has_changed_ = has_arrived_ = true;
}

std::size_t VertexCuts::bytes_of(std::uint32_t block) const {
  if (block >= entries_.size()) return 0;
  const Entry& entry = entries_[block];
  return (entry.hierarchy ? entry.hierarchy->bytes() : 0) +
         (entry.errors ? entry.errors->bytes() : 0) + (entry.cut ? entry.cut->bytes() : 0) +
         sizeof(Maker) * entry.makers.capacity() + 4 * entry.named_by.capacity();
}

VertexCuts::Report VertexCuts::update(const Blocks& blocks, const ViewParameters& view,
                                      bool cut_has_changed) {
  Report report;
  entries_.resize(std::max(entries_.size(), blocks.resident.size()));
  if (cut_has_changed || has_changed_) {
    has_changed_ = false;
    report.have_changed = choose_blocks(blocks);
    link(blocks);
  }
  settle_errors(blocks);
  move(blocks, view, report);
  return report;
}

bool VertexCuts::can_be_by_vertex(std::uint32_t block) const {
  const Entry& entry = entries_[block];
  if (!entry.hierarchy || entry.hierarchy->data().is_empty) return false;
  const std::span<const std::uint32_t> needed = graph_.dependencies(block);
  return std::all_of(needed.begin(), needed.end(),
                     [this](std::uint32_t n) { return entries_[n].cut != nullptr; });
}

// True if some block is by vertex that was not before, or the other way round.
bool VertexCuts::choose_blocks(const Blocks& blocks) {
  bool any = false;
  std::size_t triangles = 0;
  for (std::uint32_t block = 0; block < entries_.size(); ++block) {
    Entry& entry = entries_[block];
    const bool is_refined = block < blocks.is_refined.size() && blocks.is_refined[block];
    const bool can_be = is_refined && can_be_by_vertex(block);
    if (can_be == (entry.cut != nullptr)) continue;
    if (can_be) {
      const std::size_t more = graph_.entry(block).facts.triangles_fine;
      if (triangles > 0 && triangles + more > kNewTriangles) {
        has_changed_ = true;  // the next time
        continue;
      }
      triangles += more;
      entry.cut = std::make_unique<BlockCut>(blocks.resident[block], entry.hierarchy,
                                             entry.errors->bounds());
      entry.seen_in_round = round_;
    } else {
      entry.cut.reset();
    }
    any = true;
  }
  return any;
}

// Which refined blocks start from vertices of which others, and whom it concerns that a block is
// shown another way.
void VertexCuts::link(const Blocks& blocks) {
  for (std::uint32_t block = 0; block < entries_.size(); ++block) {
    Entry& entry = entries_[block];
    const bool is_refined = block < blocks.is_refined.size() && blocks.is_refined[block];
    const Way way = !is_refined ? Way::Hidden : entry.cut ? Way::ByVertex : Way::Whole;
    if (way == entry.way) continue;
    if (way == Way::Hidden) {
      unlink(block);
      continue;
    }
    if (entry.way == Way::Hidden) {
      find_makers(*blocks.resident[block], entry);
      for (const std::uint32_t maker : makers_of(entry)) entries_[maker].named_by.push_back(block);
    }
    entry.way = way;
    entry.must_ask = true;
    for (const std::uint32_t maker : makers_of(entry)) entries_[maker].must_ask = true;
    for (const std::uint32_t needed : graph_.dependencies(block)) entries_[needed].must_ask = true;
  }
}

void VertexCuts::unlink(std::uint32_t block) {
  Entry& entry = entries_[block];
  for (const std::uint32_t maker : makers_of(entry)) {
    std::erase(entries_[maker].named_by, block);
    entries_[maker].must_ask = true;
  }
  for (const std::uint32_t needed : graph_.dependencies(block)) entries_[needed].must_ask = true;
  entry.makers = {};
  entry.way = Way::Hidden;
}

// Each once.
std::vector<std::uint32_t> VertexCuts::makers_of(const Entry& entry) {
  std::vector<std::uint32_t> blocks;
  for (const Maker& maker : entry.makers) {
    if (blocks.empty() || blocks.back() != maker.block) blocks.push_back(maker.block);
  }
  return blocks;
}

void VertexCuts::find_makers(const ResidentBlock& block, Entry& entry) const {
  const std::vector<codec::VertexName>& names = block.data().root_names;
  for (std::uint32_t root = 0; root < names.size(); ++root) {
    if (names[root].block == index_of(block.id())) continue;
    entry.makers.push_back({names[root].block, names[root].vertex, root});
  }
  std::sort(entry.makers.begin(), entry.makers.end(), [](const Maker& a, const Maker& b) {
    return a.block != b.block ? a.block < b.block : a.root < b.root;
  });
  entry.makers.shrink_to_fit();
}

// Whether what finer blocks want of it may be another thing than at the last update().
bool VertexCuts::must_ask(std::uint32_t block) const {
  if (entries_[block].must_ask) return true;
  const auto has_changed = [this](std::uint32_t b) { return entries_[b].wants_changed; };
  const std::vector<std::uint32_t>& named_by = entries_[block].named_by;
  const std::span<const std::uint32_t> finer = graph_.dependents(block);
  return std::any_of(named_by.begin(), named_by.end(), has_changed) ||
         std::any_of(finer.begin(), finer.end(), has_changed);
}

// A finer block that is shown whole needs all of its coarse end.
void VertexCuts::ask_finer(std::uint32_t block, const Blocks& blocks) {
  const Entry& entry = entries_[block];
  std::vector<char> held(entry.cut->data().leaf_of_vertex.size(), 0);
  for (const std::uint32_t finer : entry.named_by) {
    const Entry& asked = entries_[finer];
    auto maker = std::lower_bound(asked.makers.begin(), asked.makers.end(), block,
                                  [](const Maker& m, std::uint32_t b) { return m.block < b; });
    for (; maker != asked.makers.end() && maker->block == block; ++maker) {
      if (!asked.cut || asked.cut->needed_roots()[maker->root]) held[maker->vertex] = 1;
    }
  }
  std::vector<char> taken;
  ask_for_triangles(block, blocks, taken);
  entry.cut->set_wants(std::move(held), std::move(taken));
}

// The triangles of a group are those of the finer block's coarse end, in order.
void VertexCuts::ask_for_triangles(std::uint32_t block, const Blocks& blocks,
                                   std::vector<char>& taken) const {
  const ResidentBlock& resident = *blocks.resident[block];
  const std::vector<std::uint32_t>& labels = resident.data().end.labels;
  struct Group {
    std::uint32_t finer = kNone;    // refined
    const BlockCut* cut = nullptr;  // null: shown whole
    std::size_t next = 0;           // triangle of its coarse end
  };
  std::vector<Group> groups;
  for (const BlockGroup& group : resident.groups()) {
    Group& asked = groups.emplace_back();
    const std::uint32_t finer = graph_.next_finer(resident.facts().band, group.patch);
    if (finer >= blocks.is_refined.size() || !blocks.is_refined[finer]) continue;
    const std::span<const std::uint32_t> needed = graph_.dependencies(finer);
    // A file may say of a triangle that a block goes on with it which does not start from it.
    if (std::find(needed.begin(), needed.end(), block) == needed.end()) continue;
    asked.finer = finer;
    asked.cut = entries_[finer].cut.get();
    asked.next = first_triangle_in(finer, block, blocks);
  }
  taken.assign(labels.size(), 0);
  const std::span<const BlockGroup> all = resident.groups();
  Group* asked = nullptr;
  for (std::size_t t = 0; t < labels.size(); ++t) {
    if (t == 0 || labels[t] != labels[t - 1]) {  // mostly it is the same one again
      const auto at = std::lower_bound(
          all.begin(), all.end(), labels[t],
          [](const BlockGroup& group, std::uint32_t label) { return group.patch < label; });
      asked = &groups[std::size_t(at - all.begin())];
    }
    if (asked->finer == kNone) continue;
    taken[t] = asked->cut == nullptr || asked->cut->takes()[asked->next] != 0;
    ++asked->next;
  }
}

// Which triangle of the coarse end of `finer` is the first one that `block` has.
std::size_t VertexCuts::first_triangle_in(std::uint32_t finer, std::uint32_t block,
                                          const Blocks& blocks) const {
  const BlockFacts& facts = graph_.entry(finer).facts;
  std::size_t first = 0;
  for (const std::uint32_t needed : graph_.dependencies(finer)) {
    if (needed == block) return first;
    if (graph_.entry(needed).facts.band != facts.band + 1) continue;
    const std::span<const BlockGroup> groups = blocks.resident[needed]->groups();
    const auto at = std::lower_bound(
        groups.begin(), groups.end(), facts.patch,
        [](const BlockGroup& group, std::uint32_t patch) { return group.patch < patch; });
    if (at == groups.end() || at->patch != facts.patch) continue;
    first += std::size_t(at->sn.count) + at->fn.count + at->nsn.count;
  }
  return first;
}

// Blocks that have not seen a view in this round come first: if time is over, the others stay as
// they were seen. What finer blocks want of them is done all the same.
void VertexCuts::move(const Blocks& blocks, const ViewParameters& view, Report& report) {
  const bool has_clock = view.clock != nullptr;
  const double stop_at = has_clock ? view.clock(view.clock_context) + view.max_seconds : 0;
  has_arrived_ = !has_changed_ && stale_.empty();
  const bool is_over = std::none_of(blocks.cut.begin(), blocks.cut.end(), [this](std::uint32_t b) {
    return entries_[b].cut && entries_[b].seen_in_round != round_;
  });
  if (is_over) ++round_;
  for (std::size_t i = blocks.cut.size(); i-- > 0;) {
    const std::uint32_t block = blocks.cut[i];
    Entry& entry = entries_[block];
    entry.wants_changed = false;
    if (!entry.cut) continue;
    BlockCut& cut = *entry.cut;
    if (must_ask(block)) ask_finer(block, blocks);
    entry.must_ask = false;
    const bool may_see =
        !has_clock || !cut.has_view() ||
        (entry.seen_in_round != round_ && view.clock(view.clock_context) < stop_at);
    const ViewParameters seen = may_see ? view : cut.view();
    if (may_see) entry.seen_in_round = round_;
    if (cut.wants_update(seen)) {
      const UpdateReport moved = cut.update(seen);
      report.splits += moved.splits;
      report.merges += moved.merges;
      report.evaluated += moved.evaluated;
    }
    has_arrived_ &= cut.view() == view;
    entry.wants_changed = cut.finish();
  }
}

}  // namespace crease
