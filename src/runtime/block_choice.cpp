#include "runtime/block_choice.h"

#include "runtime/view_error.h"

#include <algorithm>
#include <limits>

namespace crease {

namespace {

// To say which of the spheres around the eye are worst, something in them is so near.
constexpr float kNearestRadii = 0.05f;

}  // namespace

std::span<const std::uint32_t> BlockChooser::choose(const ViewParameters& view,
                                                    const Limits& limits) {
  ++round_;
  chosen_at_.resize(graph_.size(), 0);
  seen_at_.resize(graph_.size(), 0);
  open_dependencies_.resize(graph_.size(), 0);
  chosen_.clear();
  find_wrong(view, limits);
  // A heap: mostly the budget ends long before the list.
  const auto is_less = [](const Candidate& a, const Candidate& b) {
    return a.error != b.error ? a.error < b.error : a.block > b.block;
  };
  std::make_heap(wrong_.begin(), wrong_.end(), is_less);
  std::size_t bytes = 0, triangles = 0;
  for (auto end = wrong_.end(); end != wrong_.begin(); --end) {
    std::pop_heap(wrong_.begin(), end, is_less);
    const Candidate& candidate = *(end - 1);
    collect_needed(candidate.block);
    std::size_t more_bytes = 0, more_triangles = 0;
    for (const std::uint32_t block : needed_) {
      const BlockFacts& facts = graph_.entry(block).facts;
      more_bytes += limits.bytes_of_block[block];
      more_triangles +=
          facts.triangles_fine - std::min(facts.triangles_coarse, facts.triangles_fine);
    }
    const bool is_base = candidate.error == std::numeric_limits<float>::infinity();
    if (!is_base && (bytes + more_bytes > limits.max_bytes ||
                     triangles + more_triangles > view.max_triangles)) {
      for (const std::uint32_t block : needed_) chosen_at_[block] = 0;
      break;
    }
    bytes += more_bytes;
    triangles += more_triangles;
    chosen_.insert(chosen_.end(), needed_.begin(), needed_.end());
  }
  return chosen_;
}

// From the base on; no farther where all that follows is right.
void BlockChooser::find_wrong(const ViewParameters& view, const Limits& limits) {
  const ViewError error(view, grid_);
  const float keep = static_cast<float>(1 / std::max(view.hysteresis, 1.0));
  wrong_.clear();
  evaluated_ = 0;
  queue_.assign(graph_.starts().begin(), graph_.starts().end());
  for (std::size_t i = 0; i < queue_.size(); ++i) {
    const std::uint32_t block = queue_[i];
    ++evaluated_;
    const bool is_base = graph_.is_base(block);
    if (!is_base && error.of(graph_.all(block).bounds, graph_.all(block).center) <= keep) continue;
    for (const std::uint32_t finer : graph_.dependents(block)) {
      if (seen_at_[finer] != round_) open_dependencies_[finer] = 0;
      seen_at_[finer] = round_;
      if (++open_dependencies_[finer] == graph_.dependencies(finer).size()) queue_.push_back(finer);
    }
    const float own = is_base ? std::numeric_limits<float>::infinity()
                              : error.of(graph_.own(block).bounds, graph_.own(block).center);
    if (own <= (limits.is_refined[block] ? keep : 1)) continue;
    wrong_.push_back(
        {is_base ? own
                 : error.of(graph_.own(block).bounds, graph_.own(block).center, kNearestRadii),
         block});
  }
}

// What is not chosen yet of the block and all that it needs, what is needed first.
void BlockChooser::collect_needed(std::uint32_t block) {
  needed_.clear();
  const auto take = [this](std::uint32_t b) {
    if (is_chosen(b)) return;
    chosen_at_[b] = round_;
    needed_.push_back(b);
  };
  take(block);
  for (std::size_t i = 0; i < needed_.size(); ++i) {
    for (const std::uint32_t needed : graph_.dependencies(needed_[i])) take(needed);
  }
  std::sort(needed_.begin(), needed_.end());
}

}  // namespace crease
