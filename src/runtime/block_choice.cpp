#include "runtime/block_choice.h"

#include "runtime/view_error.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace crease {

namespace {

bool is_wrong(const BlockBounds& block, const ViewError& error, const ViewError::Reaches& reaches) {
  const SplitBounds& bounds = block.bounds;
  const float radius = ViewError::decoded(bounds.radius);
  const float reach =
      error.reach(worse(bounds.surface, bounds.line), bounds.degrees, radius, reaches);
  return ViewError::is_near(reach, radius, error.distance2(block.center)) &&
         error.is_in_view(block.center, radius);
}

}  // namespace

std::span<const std::uint32_t> BlockChooser::choose(const ViewParameters& view,
                                                    const Limits& limits) {
  ++round_;
  chosen_at_.resize(graph_.size(), 0);
  seen_.resize(graph_.size());
  chosen_.clear();
  find_wrong(view, limits);
  has_all_ = choose_all(view, limits);
  has_levels_ = false;
  if (has_all_) return chosen_;
  const ViewError error(view, grid_);
  see_wrong(error);
  has_levels_ = view.max_triangles != std::numeric_limits<std::size_t>::max();
  if (!has_levels_) {
    choose_most_visible(limits);
    return chosen_;
  }
  spend_triangles(view, limits, error);
  return budget_.chosen();
}

// What was chosen for a view stays until all of that is there, and is chosen anew by what is known
// then: so that what is shown in the end does not depend on what came first.
void BlockChooser::spend_triangles(const ViewParameters& view, const Limits& limits,
                                   const ViewError& error) {
  const bool has_levels = limits.levels != nullptr;
  const bool is_same = view == spent_view_ && limits.max_bytes == spent_bytes_ &&
                       has_levels == spent_on_levels_ && budget_.levels().size() == graph_.size();
  if (is_same && !is_there(budget_.chosen(), limits) && fits(budget_.chosen(), limits)) return;
  spent_view_ = view;
  spent_bytes_ = limits.max_bytes;
  spent_on_levels_ = has_levels;
  budget_.spend(
      wrong_, {error, view.max_triangles, limits.max_bytes, limits.bytes_of_block, limits.levels});
}

bool BlockChooser::is_there(std::span<const std::uint32_t> blocks, const Limits& limits) const {
  return std::all_of(blocks.begin(), blocks.end(), [&](std::uint32_t block) {
    return limits.resident[block] != nullptr &&
           (limits.levels == nullptr || graph_.is_base(block) || limits.levels->is_settled(block));
  });
}

// What levels take is known when they are there.
bool BlockChooser::fits(std::span<const std::uint32_t> blocks, const Limits& limits) {
  std::size_t bytes = 0;
  for (const std::uint32_t block : blocks) bytes += limits.bytes_of_block[block];
  return bytes <= limits.max_bytes;
}

// False if they are more than the limits, or some are not resident: then their order counts.
bool BlockChooser::choose_all(const ViewParameters& view, const Limits& limits) {
  needed_bits_.assign(graph_.size() / 64 + 1, 0);
  const auto need = [this](std::uint32_t b) { needed_bits_[b / 64] |= std::uint64_t(1) << b % 64; };
  for (const SeenBlock& seen : wrong_) need(seen.block);
  std::size_t bytes = 0, triangles = 0;
  // What a block needs comes before it, so that one pass from the last one finds all.
  for (std::size_t word = needed_bits_.size(); word-- > 0;) {
    for (int bit = 63; bit >= 0; --bit) {
      bit -= std::countl_zero(needed_bits_[word] << (63 - bit));
      if (bit < 0) break;
      const auto block = static_cast<std::uint32_t>(64 * word + unsigned(bit));
      if (!limits.is_refined[block] && !limits.resident[block]) return false;
      bytes += limits.bytes_of_block[block];
      triangles += graph_.more_triangles(block);
      for (const std::uint32_t needed : graph_.dependencies(block)) need(needed);
      chosen_.push_back(block);
    }
    if (bytes > limits.max_bytes || triangles > view.max_triangles) return false;
  }
  std::reverse(chosen_.begin(), chosen_.end());
  return true;
}

void BlockChooser::see_wrong(const ViewError& error) {
  for (SeenBlock& seen : wrong_) {
    const BlockBounds& own = graph_.own(seen.block);
    seen.error = graph_.is_base(seen.block) ? std::numeric_limits<float>::infinity()
                                            : error.of(own.bounds, own.center, kNearestRadii);
  }
}

void BlockChooser::choose_most_visible(const Limits& limits) {
  chosen_.clear();
  // A heap: mostly the budget ends long before the list.
  const auto is_less = [](const SeenBlock& a, const SeenBlock& b) {
    return a.error != b.error ? a.error < b.error : a.block > b.block;
  };
  std::make_heap(wrong_.begin(), wrong_.end(), is_less);
  std::size_t bytes = 0;
  for (auto end = wrong_.end(); end != wrong_.begin(); --end) {
    std::pop_heap(wrong_.begin(), end, is_less);
    const SeenBlock& seen = *(end - 1);
    collect_needed(seen.block);
    std::size_t more_bytes = 0;
    for (const std::uint32_t block : needed_) more_bytes += limits.bytes_of_block[block];
    if (!graph_.is_base(seen.block) && bytes + more_bytes > limits.max_bytes) {
      for (const std::uint32_t block : needed_) chosen_at_[block] = 0;
      break;
    }
    bytes += more_bytes;
    chosen_.insert(chosen_.end(), needed_.begin(), needed_.end());
  }
}

// From the base on; no farther where all that follows is right.
void BlockChooser::find_wrong(const ViewParameters& view, const Limits& limits) {
  const ViewError error(view, grid_);
  const ViewError::Reaches at_all = error.reaches(1);
  const ViewError::Reaches keep =
      error.reaches(static_cast<float>(1 / std::max(view.hysteresis, 1.0)));
  const auto round = static_cast<std::uint32_t>(round_);
  wrong_.clear();
  evaluated_ = 0;
  queue_.assign(graph_.starts().begin(), graph_.starts().end());
  for (std::size_t i = 0; i < queue_.size(); ++i) {
    const std::uint32_t block = queue_[i];
    ++evaluated_;
    const bool is_base = graph_.is_base(block);
    if (!is_base && !is_wrong(graph_.all(block), error, keep)) continue;
    for (const std::uint32_t finer : graph_.dependents(block)) {
      Seen& seen = seen_[finer];
      if (seen.round != round) {
        seen = {round, static_cast<std::uint32_t>(graph_.dependencies(finer).size())};
      }
      if (--seen.open_dependencies == 0) queue_.push_back(finer);
    }
    if (is_base || is_wrong(graph_.own(block), error, limits.is_refined[block] ? keep : at_all)) {
      wrong_.push_back({0, block});
    }
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
