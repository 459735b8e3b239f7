#include "runtime/block_graph.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace crease {

BlockGraph::BlockGraph(const ModelFacts& facts, std::uint32_t block_count)
    : grid_(facts.grid), first_of_band_(facts.bands.size()) {
  // The finest band's blocks are the last ones.
  std::uint32_t end = block_count;
  for (std::size_t b = 0; b < facts.bands.size(); ++b) {
    patches_.push_back(facts.bands[b].patches);
    first_of_band_[b] = end -= std::min(end, facts.bands[b].patches);
  }
}

std::uint32_t BlockGraph::next_finer(std::uint16_t band, std::uint32_t patch) const {
  if (band == 0 || patch >= patches_[band - 1u]) return kNone;
  return first_of_band_[band - 1u] + patch;
}

// Before anything of it is added: a page comes as a whole or not at all.
Status BlockGraph::check(const DirectoryPage& page) const {
  const auto bad = [](BlockId id, const char* what) {
    return fail(Error::BadFormat, "block " + std::to_string(index_of(id)) + ": " + what);
  };
  if (index_of(page.first) != entries_.size()) {
    return bad(page.first, "its page is not the next one");
  }
  const auto band_of = [&](BlockId id) {
    return page.has(id) ? page.block(id).facts.band : entries_[index_of(id)].facts.band;
  };
  std::uint32_t block = size();
  for (const BlockEntry& entry : page.blocks) {
    const BlockFacts& facts = entry.facts;
    const bool is_base = facts.band == patches_.size();
    if (is_base ? block != 0 : next_finer(facts.band + 1, facts.patch) != block) {
      return bad(entry.id, "its band and patch are not those of its place");
    }
    for (const BlockId needed : page.dependencies_of(entry.id)) {
      if (index_of(needed) >= block || band_of(needed) <= facts.band) {
        return bad(entry.id, "it needs a block that is not coarser");
      }
    }
    ++block;
  }
  return Done{};
}

Status BlockGraph::add_page(const DirectoryPage& page) {
  if (Status status = check(page); !status.ok()) return status.failure();
  for (const BlockEntry& entry : page.blocks) {
    const std::uint32_t block = size();
    const BlockFacts& facts = entry.facts;
    const BlockBounds own = bounds_of(facts, grid_);
    for (const BlockId id : page.dependencies_of(entry.id)) {
      dependencies_.blocks.push_back(static_cast<std::uint32_t>(index_of(id)));
    }
    dependencies_.begin.push_back(static_cast<std::uint32_t>(dependencies_.blocks.size()));
    entries_.push_back(entry);
    bounds_.push_back({own, own});
    more_triangles_.push_back(facts.triangles_fine -
                              std::min(facts.triangles_coarse, facts.triangles_fine));
    if (dependencies(block).empty()) starts_.push_back(block);
    if (facts.band == patches_.size()) base_ = block;
  }
  ++pages_;
  find_dependents();
  grow_bounds();
  return Done{};
}

// Of each block in ascending order.
void BlockGraph::find_dependents() {
  dependents_.begin.assign(std::size_t(size()) + 1, 0);
  dependents_.blocks.resize(dependencies_.blocks.size());
  for (const std::uint32_t needed : dependencies_.blocks) ++dependents_.begin[needed + 1];
  std::partial_sum(dependents_.begin.begin(), dependents_.begin.end(), dependents_.begin.begin());
  std::vector<std::uint32_t> end(dependents_.begin.begin(), dependents_.begin.end() - 1);
  for (std::uint32_t block = 0; block < size(); ++block) {
    for (const std::uint32_t needed : dependencies(block)) {
      dependents_.blocks[end[needed]++] = block;
    }
  }
}

namespace {

// The smallest sphere around both, a little larger.
void hold(BlockBounds& outer, const BlockBounds& inner) {
  SplitBounds& bounds = outer.bounds;
  set_error(bounds, worse(error_of(bounds), error_of(inner.bounds)));
  const Vec3d center = to_double(outer.center), way = to_double(inner.center) - center;
  const double away = length(way), own = bounds.radius.value(), other = inner.bounds.radius.value();
  if (away + other <= own) return;
  const double radius = std::max((own + away + other) / 2, other);
  const Vec3d middle = away > 0 ? center + way * ((radius - own) / away) : center;
  outer.center = {static_cast<float>(middle.x), static_cast<float>(middle.y),
                  static_cast<float>(middle.z)};
  const double rounded = 1e-6 * (std::abs(middle.x) + std::abs(middle.y) + std::abs(middle.z));
  bounds.radius = RoundedUp::from(static_cast<float>(radius + rounded));
}

}  // namespace

void BlockGraph::grow_bounds() {
  for (std::uint32_t block = size(); block-- > 0;) {
    for (const std::uint32_t needed : dependencies(block)) {
      hold(bounds_[needed].all, bounds_[block].all);
    }
  }
}

}  // namespace crease
