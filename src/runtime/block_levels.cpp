#include "runtime/block_levels.h"

#include "codec/checksum.h"
#include "runtime/block_errors.h"
#include "runtime/group_by_place.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <unordered_map>
#include <utility>

namespace crease {

namespace {

float largest(const LevelError& error) {
  return std::max(error.surface, error.line);
}

std::uint64_t key_of(const codec::VertexName& name) {
  return std::uint64_t(name.block) << 32 | name.vertex;
}

// Of the vertices of the fine end, what finer blocks know of them.
void tighten(const BlockLevelsJob::Data& job, BlockErrors& errors) {
  if (job.finer.empty()) return;
  const KeptEnd& end = job.block->data().end;
  std::unordered_map<std::uint64_t, std::uint32_t> vertex_of_name;
  for (std::uint32_t v = 0; v < end.vertex_count(); ++v) vertex_of_name[key_of(end.name(v))] = v;
  for (const BlockLevelsJob::Data::Finer& finer : job.finer) {
    const KeptNames& names = finer.block->data().root_names;
    for (std::size_t r = 0; r < finer.facts->of_root.size(); ++r) {
      const auto at = vertex_of_name.find(key_of(names[r]));
      if (at != vertex_of_name.end()) errors.tighten(at->second, finer.facts->of_root[r]);
    }
  }
}

// A split is done from the first level on that leaves less than its error; at the coarse end the
// inner ones are.
class Levels {
 public:
  Levels(const BlockHierarchy::Data& data, std::span<const SplitBounds> bounds)
      : data_(data), bounds_(bounds) {
    for (int k = 0; k < kFullLevel; ++k) {
      limit_[k] = largest(data.coarse) * static_cast<float>(std::pow(kLevelRatio, k));
    }
  }
  bool is_done(std::size_t split, int level) const {
    if (level == 0) return data_.is_inner_split(SplitId{static_cast<std::uint32_t>(split)});
    return largest(bounds_[split].error()) > limit_[level];
  }
  // As LevelList::done.
  std::vector<std::uint64_t> all_done(int level) const {
    std::vector<std::uint64_t> done(bounds_.size() / 64 + 1, 0);
    for (std::size_t s = 0; s < bounds_.size(); ++s) {
      if (is_done(s, level)) done[s / 64] |= std::uint64_t(1) << (s % 64);
    }
    return done;
  }
  // A triangle is there once the split that brings it is done.
  std::uint32_t triangles_at(int level) const {
    const VertexHierarchy& h = data_.hierarchy.vertices;
    std::size_t count = h.coarse_triangles().size();
    for (std::uint32_t s = 0; s < bounds_.size(); ++s) {
      if (is_done(s, level)) count += h.triangles_of(SplitId{s}).size();
    }
    return static_cast<std::uint32_t>(count);
  }
  LevelError left_by(int level) const {
    LevelError left;
    for (std::size_t s = 0; s < bounds_.size(); ++s) {
      if (!is_done(s, level)) left = larger(left, bounds_[s].error());
    }
    return left;
  }

 private:
  const BlockHierarchy::Data& data_;
  std::span<const SplitBounds> bounds_;
  std::array<float, kFullLevel> limit_{};
};

constexpr float kRounding = 1.00001f;  // of lengths

// Halves the block a few times: an error in one corner of it does not matter where only another one
// is near, or in view. Inner splits, which most levels have done, are apart, since their spheres
// are large.
class PieceMaker {
 public:
  PieceMaker(const BlockHierarchy::Data& data, const Grid& grid, const Levels& levels,
             std::span<const SplitBounds> bounds, LevelFacts& facts)
      : h_(data.hierarchy.vertices), levels_(levels), bounds_(bounds), facts_(facts) {
    std::vector<std::uint32_t> inner;
    for (std::size_t s = 0; s < h_.split_count(); ++s) {
      const NodeId node = h_.node_of_split[s];
      const Vec3i& p = h_.position_of(node);
      place_.push_back({static_cast<float>(grid.step * p.x), static_cast<float>(grid.step * p.y),
                        static_cast<float>(grid.step * p.z)});
      const bool is_inner = data.is_inner_split(SplitId{static_cast<std::uint32_t>(s)});
      const bool is_top = is_inner || h_.is_root(node) || data.is_inner_split(h_.split_above(node));
      if (is_top) (is_inner ? inner : order_).push_back(static_cast<std::uint32_t>(s));
      top_of_split_.push_back(is_top ? static_cast<std::uint32_t>(s)
                                     : top_of_split_[index_of(h_.split_above(node))]);
    }
    own_count_ = order_.size();
    order_.insert(order_.end(), inner.begin(), inner.end());
  }
  void run() {
    piece_of_top_.resize(h_.split_count());
    if (own_count_ > 0 && own_count_ < order_.size()) {
      facts_.pieces.push_back(sphere_of(0, order_.size()));
      add_piece(0, own_count_, kMostHalvings);
      facts_.first_inner = static_cast<std::uint32_t>(facts_.pieces.size());
      add_piece(own_count_, order_.size(), kMostHalvings - 1);
      close(0);
    } else if (!order_.empty()) {
      add_piece(0, order_.size(), kMostHalvings);
      facts_.first_inner = own_count_ > 0 ? static_cast<std::uint32_t>(facts_.pieces.size()) : 0;
    }
    facts_.left_in_piece = LevelsLeft(facts_.pieces.size());
    for (int k = 0; k < kFullLevel; ++k) find_left(k);
  }

 private:
  // With its halves, across the longest side.
  void add_piece(std::size_t begin, std::size_t end, int halvings) {
    const auto piece = static_cast<std::uint16_t>(facts_.pieces.size());
    facts_.pieces.push_back(sphere_of(begin, end));
    if (halvings == 0 || end - begin < 2) {
      for (std::size_t i = begin; i < end; ++i) piece_of_top_[order_[i]] = piece;
    } else {
      const std::size_t middle = halve_by_place(order_, begin, end, [this](std::uint32_t s) {
        return std::array{place_[s].x, place_[s].y, place_[s].z};
      });
      add_piece(begin, middle, halvings - 1);
      add_piece(middle, end, halvings - 1);
    }
    close(piece);
  }

  // All since are its parts. Its sphere holds theirs, so that what is wrong in one is so in it.
  void close(std::size_t piece) {
    LevelSphere& whole = facts_.pieces[piece];
    whole.next = static_cast<std::uint16_t>(facts_.pieces.size());
    float radius = whole.radius.value();
    for (std::size_t part = piece + 1; part < whole.next; part = facts_.pieces[part].next) {
      const LevelSphere& own = facts_.pieces[part];
      radius = std::max(radius, length(own.center - whole.center) * kRounding + own.radius.value());
    }
    whole.radius = RoundedUp::from(radius);
  }

  // The spheres of splits hold those below.
  LevelSphere sphere_of(std::size_t begin, std::size_t end) const {
    Vec3f low = place_[order_[begin]], high = low;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f& p = place_[order_[i]];
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const Vec3f center = (low + high) * 0.5f;
    float radius = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const float own = bounds_[order_[i]].radius.value();
      radius = std::max(radius, length(place_[order_[i]] - center) * kRounding + own);
    }
    return {center, RoundedUp::from(radius)};
  }

  void find_left(int level) {
    LevelsLeft& left = facts_.left_in_piece;
    for (std::size_t s = 0; s < bounds_.size(); ++s) {
      if (levels_.is_done(s, level)) continue;
      left.add(piece_of_top_[top_of_split_[s]], level, error_of(bounds_[s]));
    }
    const std::size_t at = static_cast<std::size_t>(level) * left.count;
    for (std::size_t i = left.count; i-- > 0;) {
      const std::size_t first = i + 1, end = facts_.pieces[i].next;
      if (first == end) continue;
      const std::size_t second = facts_.pieces[first].next;
      left.off[at + i] = worse(left.off[at + first], left.off[at + second]);
      left.degrees[at + i] = worse(left.degrees[at + first], left.degrees[at + second]);
    }
  }

  const VertexHierarchy& h_;
  const Levels& levels_;
  std::span<const SplitBounds> bounds_;
  LevelFacts& facts_;
  // What has no other of the block above it, then the inner ones.
  std::vector<std::uint32_t> order_;
  std::size_t own_count_ = 0;                // of the block
  std::vector<Vec3f> place_;                 // per split
  std::vector<std::uint32_t> top_of_split_;  // per split: in order_
  std::vector<std::uint16_t> piece_of_top_;  // per split that is in order_
};

}  // namespace

BlockLevels::BlockLevels(std::unique_ptr<const Data> data) : data_(std::move(data)) {}
BlockLevels::~BlockLevels() = default;

BlockId BlockLevels::id() const {
  return data_->id;
}

BlockLevelsJob::BlockLevelsJob(std::unique_ptr<const Data> data) : data_(std::move(data)) {}
BlockLevelsJob::~BlockLevelsJob() = default;
BlockLevelsJob::BlockLevelsJob(BlockLevelsJob&&) noexcept = default;

BlockId BlockLevelsJob::id() const {
  return data_->block->id();
}

BlockLevelsPtr BlockLevelsJob::run() const {
  const BlockHierarchyPtr hierarchy = make_tall_hierarchy(*data_->block, data_->needed);
  const BlockHierarchy::Data& data = hierarchy->data();
  auto result = std::make_unique<BlockLevels::Data>();
  auto facts = std::make_shared<LevelFacts>();
  result->id = id();
  if (!data.is_empty) {
    BlockErrors errors(data);
    tighten(*data_, errors);
    errors.settle();
    const Levels levels(data, errors.bounds());
    for (int k = 0; k < kFullLevel; ++k) {
      facts->left[k] = levels.left_by(k);
      facts->triangles[k] = levels.triangles_at(k);
    }
    for (std::uint32_t r = 0; r < data.node_of_root.size(); ++r) {
      facts->of_root.push_back(errors.of_root(r));
    }
    const Grid& grid = data_->block->data().schema->facts.grid;
    PieceMaker(data, grid, levels, errors.bounds(), *facts).run();
    if (data_->level > 0 && data_->level < kFullLevel) {
      result->list =
          make_level_list(data_->block->data(), data, data_->level, levels.all_done(data_->level));
    }
  }
  facts->roots = checksum(std::as_bytes(std::span(facts->of_root)));
  for (const BlockLevelsJob::Data::Finer& finer : data_->finer) {
    facts->finer.push_back({finer.block->id(), finer.facts->roots});
  }
  result->facts = std::move(facts);
  return std::make_shared<const BlockLevels>(std::move(result));
}

}  // namespace crease
