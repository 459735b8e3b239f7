#include "runtime/inner_splits.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace crease {

namespace {

using codec::CoarseEnd;
using codec::Corners;
using codec::Split;

class InnerSplits {
 public:
  InnerSplits(const BlockFacts& facts, std::span<const ResidentBlockPtr> needed,
              const CoarseEnd& start)
      : patch_(facts.patch), start_(start), met_(start.names.size(), 0) {
    for (const ResidentBlockPtr& block : needed) {
      if (block->facts().band == facts.band + 1) coarser_.push_back(&block->data());
    }
    result_.band = static_cast<std::uint16_t>(facts.band + 1);
  }

  codec::UnfoldedBlock run() && {
    number_vertices();
    for (std::size_t e = 0; e < coarser_.size(); ++e) take_splits(e);
    if (!result_.splits.empty()) lay_out();
    return std::move(result_);
  }

 private:
  // Of each end, what its vertices are in `start`.
  void number_vertices() {
    for (const ResidentBlock::Data* block : coarser_) {
      number_.emplace_back(block->end.vertex_count(), kNone);
    }
    for (std::size_t t = 0; t < start_.sources.size(); ++t) {
      const codec::TriangleSource& source = start_.sources[t];
      const Corners corners = coarser_[source.end]->end.triangle(source.triangle);
      for (std::size_t c = 0; c < 3; ++c) {
        std::uint32_t& number = number_[source.end][corners[c]];
        if (number != kNone) continue;
        number = start_.mesh.triangles[t][c];
        ++met_[number];
      }
    }
  }

  // Those below whose children no triangle of another patch is.
  void take_splits(std::size_t e) {
    const ResidentBlock::Data& block = *coarser_[e];
    const std::vector<char> is_inner = inner_vertices(e);
    std::vector<char> is_inner_below = is_inner;  // of what the vertex is so far
    const std::vector<Split> splits = block.splits.unpacked();
    const std::size_t roots = block.end.vertex_count() - splits.size();
    std::vector<char> is_taken(splits.size(), 0);
    for (std::size_t s = splits.size(); s-- > 0;) {
      char& first = is_inner_below[splits[s].vertex];
      first = is_taken[s] = first != 0 && is_inner_below[roots + s] != 0;
    }
    bool any = false;
    for (std::size_t s = 0; s < splits.size(); ++s) {
      if (!is_taken[s]) continue;
      any = true;
      result_.splits.push_back({number_[e][splits[s].vertex], 0, 0, splits[s].parent_position});
      second_.push_back(number_[e][roots + s]);
    }
    if (!any) return;
    result_.coarse = larger(result_.coarse, block.entry.facts.coarse);
    result_.fine = larger(result_.fine, block.entry.facts.fine);
  }

  // A vertex without a triangle may be one that other blocks go on with. One that is met twice lies
  // on the rim of a coarser block, and is never split there.
  std::vector<char> inner_vertices(std::size_t e) const {
    const KeptEnd& end = coarser_[e]->end;
    std::vector<char> is_inner(end.vertex_count(), 0);
    for (std::size_t v = 0; v < is_inner.size(); ++v) {
      is_inner[v] = number_[e][v] != kNone && met_[number_[e][v]] == 1;
    }
    for (std::size_t t = 0; t < end.triangle_count(); ++t) {
      if (end.label(t) == patch_) continue;
      for (const std::uint32_t v : end.triangle(t)) is_inner[v] = 0;
    }
    return is_inner;
  }

  // Second children are the last vertices.
  void lay_out() {
    const std::size_t count = start_.names.size();
    std::vector<char> is_second(count, 0);
    for (const std::uint32_t v : second_) is_second[v] = 1;
    for (std::uint32_t v = 0; v < count; ++v) {
      if (!is_second[v]) result_.vertices.push_back(v);
    }
    result_.vertices.insert(result_.vertices.end(), second_.begin(), second_.end());
    std::vector<std::uint32_t> place(count);
    for (std::uint32_t i = 0; i < count; ++i) place[result_.vertices[i]] = i;
    for (Split& split : result_.splits) split.vertex = place[split.vertex];
    result_.end = start_.mesh;
    for (std::size_t v = 0; v < count; ++v) {
      result_.end.positions[place[v]] = start_.mesh.positions[v];
    }
    for (Corners& corners : result_.end.triangles) {
      for (std::uint32_t& v : corners) v = place[v];
    }
    for (std::uint32_t t = 0; t < result_.end.triangles.size(); ++t) result_.triangles.push_back(t);
    result_.coarse_values.resize(result_.end.values.size());
  }

  const std::uint32_t patch_;
  const CoarseEnd& start_;
  std::vector<const ResidentBlock::Data*> coarser_;  // what sources count among
  std::vector<std::vector<std::uint32_t>> number_;   // per vertex of each: in `start`, or kNone
  std::vector<std::uint32_t> met_;                   // per vertex of `start`: how often
  std::vector<std::uint32_t> second_;                // per split that is taken: second child
  codec::UnfoldedBlock result_;
};

}  // namespace

codec::UnfoldedBlock inner_splits_of(const BlockFacts& facts,
                                     std::span<const ResidentBlockPtr> needed,
                                     const CoarseEnd& start) {
  return InnerSplits(facts, needed, start).run();
}

}  // namespace crease
