#include "runtime/triangle_budget.h"

#include <algorithm>
#include <cmath>

namespace crease {

namespace {

// Where there are so many times the triangles, no later step leads back to as many as there may be.
constexpr std::size_t kFarBeyond = 4;
// Of its coarse end a block that is not known shows so much at its first level, and by each further
// one as many times more. Cities have more at each.
constexpr double kFirstLevel = 1.0 / 3;

constexpr auto is_less_visible = [](const auto& a, const auto& b) {
  return a.error != b.error ? a.error < b.error : a.block > b.block;
};

}  // namespace

void TriangleBudget::spend(std::span<const SeenBlock> wrong, const Terms& terms) {
  begin(wrong);
  is_limited_ = false;
  std::size_t steps = 0, steps_that_fit = 0;  // to the last one that brings triangles
  bool do_all_fit = true;
  while (!steps_.empty() && !exceeds(kFarBeyond, terms)) {
    const std::int64_t before = triangles_;
    take_step(terms);
    ++steps;
    const bool fits = !exceeds(1, terms);
    if (fits && triangles_ != before) steps_that_fit = steps;
    do_all_fit &= fits;
  }
  if (do_all_fit) return;
  begin(wrong);
  for (std::size_t i = 0; i < steps_that_fit; ++i) take_step(terms);
  is_limited_ = true;
  while (!steps_.empty()) take_step(terms);
}

void TriangleBudget::begin(std::span<const SeenBlock> wrong) {
  levels_.assign(graph_.size(), 0);
  is_chosen_.assign(graph_.size(), 0);
  seen_error_.assign(graph_.size(), 0);
  met_at_.resize(graph_.size(), 0);
  chosen_.clear();
  steps_.clear();
  triangles_ = 0;
  bytes_ = 0;
  has_bytes_ = true;
  for (const SeenBlock& seen : wrong) push({seen.error, seen.block, kOutside});
}

void TriangleBudget::take_step(const Terms& terms) {
  std::pop_heap(steps_.begin(), steps_.end(), is_less_visible);
  const Step step = steps_.back();
  steps_.pop_back();
  step.level == kOutside ? enter(step, terms) : raise(step, terms);
}

void TriangleBudget::push(const Step& step) {
  steps_.push_back(step);
  std::push_heap(steps_.begin(), steps_.end(), is_less_visible);
}

bool TriangleBudget::exceeds(std::size_t times, const Terms& terms) const {
  return triangles_ > 0 && static_cast<std::size_t>(triangles_) / times > terms.max_triangles;
}

bool TriangleBudget::fits(std::int64_t more, const Terms& terms) const {
  return !is_limited_ || triangles_ + more <= 0 ||
         static_cast<std::size_t>(triangles_ + more) <= terms.max_triangles;
}

// Between its ends it has no level.
bool TriangleBudget::is_whole(std::uint32_t block, const Terms& terms) const {
  return terms.levels == nullptr || graph_.is_base(block) ||
         (terms.levels->is_known(block) && !terms.levels->can_choose(block));
}

// It and what it needs are to be there; what it shows is decided by its next steps. Only where
// there is room for as much as a level of it.
void TriangleBudget::enter(const Step& step, const Terms& terms) {
  const std::uint32_t block = step.block;
  const bool is_base = graph_.is_base(block);
  const std::int64_t least = graph_.more_triangles(block) / (terms.levels ? kFullLevel : 1);
  if (!is_base && !fits(collect_coarse(block, terms) + least, terms)) return;
  collect_needed(block, [this](std::uint32_t b) { return is_chosen_[b] != 0; });
  std::size_t more_bytes = 0;
  for (const std::uint32_t needed : found_) more_bytes += terms.bytes_of_block[needed];
  if (!is_base) has_bytes_ = has_bytes_ && bytes_ + more_bytes <= terms.max_bytes;
  if (!has_bytes_) return;
  bytes_ += more_bytes;
  std::sort(found_.begin(), found_.end());
  for (const std::uint32_t needed : found_) is_chosen_[needed] = 1;
  chosen_.insert(chosen_.end(), found_.begin(), found_.end());
  seen_error_[block] = step.error;
  if (is_base) {
    levels_[block] = kFullLevel;
    triangles_ += graph_.more_triangles(block);
  } else if (const float error = error_at(block, 0, terms); error > 1) {
    push({error, block, 0});
  }
}

// To the next level at which the error is less; or as far there as fits and is no worse, since less
// of the block is wrong by as much then. Where inner splits are undone a level can be worse than
// the coarse end.
void TriangleBudget::raise(const Step& step, const Terms& terms) {
  const std::uint32_t block = step.block;
  if (levels_[block] != step.level) return;  // others have needed it since
  int level = is_whole(block, terms) ? kFullLevel : step.level + 1;
  float error = 0;
  while (level < kFullLevel && (error = error_at(block, level, terms)) >= step.error) ++level;
  const std::int64_t before = more_at(block, step.level, terms);
  const std::int64_t of_needed = step.level == 0 ? collect_coarse(block, terms) : 0;
  const auto more = [&] { return of_needed + more_at(block, level, terms) - before; };
  if (!fits(more(), terms)) {
    const int least = is_whole(block, terms) ? kFullLevel : step.level + 1;
    do {
      if (--level < least) return;
    } while (error_at(block, level, terms) > step.error || !fits(more(), terms));
    error = 0;  // the next one does not fit
  }
  triangles_ += more();
  if (step.level == 0) {
    for (const std::uint32_t needed : found_) levels_[needed] = kFullLevel;
  }
  levels_[block] = static_cast<std::uint8_t>(level);
  if (level < kFullLevel && error > 1) push({error, block, level});
}

float TriangleBudget::error_at(std::uint32_t block, int level, const Terms& terms) const {
  if (level == kFullLevel) return 0;
  if (is_whole(block, terms)) return seen_error_[block];
  if (terms.levels->is_known(block)) return terms.levels->error_at(block, level, terms.error);
  return seen_error_[block] * static_cast<float>(std::pow(kLevelRatio, level));
}

// Than at its coarse end; by less than none where inner splits are undone.
std::int64_t TriangleBudget::more_at(std::uint32_t block, int level, const Terms& terms) const {
  const std::int64_t more = graph_.more_triangles(block);
  if (level == 0 || level == kFullLevel) return level == 0 ? 0 : more;
  const std::int64_t coarse = graph_.entry(block).facts.triangles_coarse;
  if (terms.levels->is_known(block)) return terms.levels->triangles_at(block, level) - coarse;
  const double fine = static_cast<double>(coarse + more);
  const double first = std::max(1.0, kFirstLevel * static_cast<double>(coarse));
  const double share = static_cast<double>(level - 1) / (kFullLevel - 1);
  return static_cast<std::int64_t>(first * std::pow(std::max(fine / first, 1.0), share)) - coarse;
}

// Of the block and all that it needs, what is not there.
template <typename IsThere>
void TriangleBudget::collect_needed(std::uint32_t block, IsThere is_there) {
  found_.clear();
  ++searches_;
  const auto take = [&](std::uint32_t b) {
    if (met_at_[b] == searches_ || is_there(b)) return;
    met_at_[b] = searches_;
    found_.push_back(b);
  };
  take(block);
  for (std::size_t i = 0; i < found_.size(); ++i) {
    for (const std::uint32_t needed : graph_.dependencies(found_[i])) take(needed);
  }
}

// What the block needs and is not at its fine end, and by how much more it would be there. What is
// at its fine end has all that it needs there.
std::int64_t TriangleBudget::collect_coarse(std::uint32_t block, const Terms& terms) {
  collect_needed(block, [&](std::uint32_t b) { return b != block && levels_[b] == kFullLevel; });
  found_.erase(found_.begin());
  std::int64_t more = 0;
  for (const std::uint32_t needed : found_) {
    more += graph_.more_triangles(needed) - more_at(needed, levels_[needed], terms);
  }
  return more;
}

}  // namespace crease
