// Which blocks are by vertex, and whom it concerns what a block wants.
#include "runtime/vertex_cuts.h"

#include <algorithm>

namespace crease {

namespace {

// Of the fine ends of blocks that become by vertex in one update: each starts with its coarse end,
// and is split as far as the view wants.
constexpr std::size_t kNewTriangles = 32'000;

}  // namespace

bool VertexCuts::can_be_by_vertex(std::uint32_t block, std::span<const Way> ways) const {
  if (!has_vertices(block)) return false;
  const std::span<const std::uint32_t> needed = graph_.dependencies(block);
  return std::all_of(needed.begin(), needed.end(),
                     [ways](std::uint32_t n) { return ways[n] == Way::ByVertex; });
}

std::vector<VertexCuts::Way> VertexCuts::choose_ways(const Blocks& blocks) {
  std::vector<Way> ways(entries_.size(), Way::Hidden);
  std::size_t triangles = 0;
  for (const std::uint32_t block : blocks.cut) {
    ways[block] = Way::Whole;
    if (!can_be_by_vertex(block, ways)) continue;
    if (!entries_[block].cut) {
      const std::size_t more = graph_.entry(block).facts.triangles_fine;
      if (!blocks.are_known && triangles > 0 && triangles + more > kNewTriangles) {
        has_changed_ = true;  // the next time
        continue;
      }
      triangles += more;
    }
    ways[block] = Way::ByVertex;
  }
  return ways;
}

// True if some block is by vertex that was not before, or the other way round. At any time each
// block by vertex knows what all those want that are not hidden.
bool VertexCuts::link(const Blocks& blocks) {
  const std::vector<Way> ways = choose_ways(blocks);
  std::vector<std::uint32_t> changed;
  bool any = false;
  for (std::uint32_t block = 0; block < entries_.size(); ++block) {
    const Way before = entries_[block].way;
    if (ways[block] == before) continue;
    changed.push_back(block);
    any |= ways[block] == Way::ByVertex || before == Way::ByVertex;
  }
  for (std::size_t i = changed.size(); i-- > 0;) hide(changed[i]);
  for (const std::uint32_t block : changed) {
    if (ways[block] != Way::Hidden) show(block, ways[block], blocks);
  }
  return any;
}

void VertexCuts::hide(std::uint32_t block) {
  Entry& entry = entries_[block];
  if (entry.cut) tell(entry);
  if (entry.way == Way::Whole) want_all(entry, false, kNone);
  if (entry.way == Way::ByVertex) unwant(entry);
  entry.way = Way::Hidden;
  entry.cut.reset();
  entry.sources = {};
  entry.makers = {};
  entry.block = nullptr;
  resized_.push_back(block);
}

void VertexCuts::show(std::uint32_t block, Way way, const Blocks& blocks) {
  Entry& entry = entries_[block];
  entry.way = way;
  entry.block = blocks.resident[block];
  entry.sources = sources_of(block, blocks);
  entry.makers = makers_of(*entry.block);
  resized_.push_back(block);
  if (way == Way::Whole) return want_all(entry, true, kNone);
  entry.cut = std::make_unique<BlockCut>(entry.block, entry.hierarchy, entry.errors->bounds());
  entry.seen_in_round = round_ - 1;
  // Finer blocks that are there already are whole: they were not by vertex before this one.
  for (const Entry& finer : entries_) {
    const bool is_whole = finer.way == Way::Whole;
    if (is_whole && std::binary_search(finer.makers.begin(), finer.makers.end(), block)) {
      want_all(finer, true, block);
    }
  }
}

// The blocks that made its roots, ascending, those among them that have its triangles.
std::vector<std::uint32_t> VertexCuts::makers_of(const ResidentBlock& block) const {
  const std::span<const std::uint32_t> needed =
      graph_.dependencies(static_cast<std::uint32_t>(index_of(block.id())));
  std::vector<std::uint32_t> makers(needed.begin(), needed.end());
  const KeptNames& names = block.data().root_names;
  for (std::size_t r = 0; r < names.size(); ++r) {
    const codec::VertexName name = names[r];
    if (makers.empty() || makers.back() != name.block) makers.push_back(name.block);
  }
  std::sort(makers.begin(), makers.end());
  makers.erase(std::unique(makers.begin(), makers.end()), makers.end());
  makers.shrink_to_fit();
  return makers;
}

// Where the triangles of its coarse end are at the fine ends of those that it needs.
std::vector<VertexCuts::Source> VertexCuts::sources_of(std::uint32_t block,
                                                       const Blocks& blocks) const {
  const BlockFacts& facts = graph_.entry(block).facts;
  std::vector<Source> sources;
  std::uint32_t first = 0;
  for (const std::uint32_t needed : graph_.dependencies(block)) {
    if (graph_.entry(needed).facts.band != facts.band + 1) continue;
    std::uint32_t there = 0;
    for (const BlockGroup& group : blocks.resident[needed]->groups()) {
      const std::uint32_t count = group.sn.count + group.fn.count + group.nsn.count;
      if (group.patch == facts.patch) {
        const bool goes_on = !sources.empty() && sources.back().block == needed;
        if (!goes_on) sources.push_back({needed, first, there});
        first += count;
      }
      there += count;
    }
  }
  return sources;
}

void VertexCuts::want(std::uint32_t root, const Entry& entry, bool is_wanted) {
  const codec::VertexName name = entry.block->data().root_names[root];
  if (name.block == index_of(entry.block->id()) || !entries_[name.block].cut) return;
  BlockLinks& links = entries_[name.block].cut->links();
  is_wanted ? links.hold(name.vertex) : links.release(name.vertex);
}

void VertexCuts::take(std::uint32_t triangle, const Entry& entry, bool is_taken) {
  const auto after =
      std::upper_bound(entry.sources.begin(), entry.sources.end(), triangle,
                       [](std::uint32_t t, const Source& source) { return t < source.first; });
  const Source& source = *(after - 1);
  const Entry& there = entries_[source.block];
  if (!there.cut) return;
  const std::uint32_t place = source.there + triangle - source.first;
  there.cut->links().take(there.hierarchy->data().triangles_by_patch[place], is_taken);
}

// Of a block that is shown whole, its whole coarse end; `of`: of that block only, or of all.
void VertexCuts::want_all(const Entry& entry, bool is_wanted, std::uint32_t of) {
  const KeptNames& names = entry.block->data().root_names;
  for (std::uint32_t root = 0; root < names.size(); ++root) {
    if (of == kNone || names[root].block == of) want(root, entry, is_wanted);
  }
  for (std::size_t i = 0; i < entry.sources.size(); ++i) {
    if (of != kNone && entry.sources[i].block != of) continue;
    const std::uint32_t end = i + 1 < entry.sources.size() ? entry.sources[i + 1].first
                                                           : entry.block->data().coarse_triangles;
    for (std::uint32_t t = entry.sources[i].first; t < end; ++t) take(t, entry, is_wanted);
  }
}

// All that it wants by vertex.
void VertexCuts::unwant(const Entry& entry) {
  const BlockLinks* const links = entry.cut->known_links();
  if (links == nullptr) return;
  for (std::uint32_t r = 0; r < entry.block->data().root_names.size(); ++r) {
    if (links->needs(r)) want(r, entry, false);
  }
  for (std::uint32_t t = 0; t < entry.block->data().coarse_triangles; ++t) {
    if (links->takes(t)) take(t, entry, false);
  }
}

}  // namespace crease
